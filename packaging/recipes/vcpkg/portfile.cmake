# The archive's address and hash are the maintainer's to fill in; SNUG_SOURCE may name a file:// one.
vcpkg_download_distfile(ARCHIVE URLS "$ENV{SNUG_SOURCE}" FILENAME snug-${VERSION}.tar.gz SKIP_SHA512)
vcpkg_extract_source_archive(SOURCE_PATH ARCHIVE "${ARCHIVE}")
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DSNUG_BUILD_COMMAND=OFF -DSNUG_BUILD_TESTS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/snug)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
