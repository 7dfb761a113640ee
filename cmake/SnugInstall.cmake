# What others link, snug::snug, and the headers that go with it. find_package(snug) finds it after `cmake --install`; a
# project that adds this folder as a sub-directory links the same name. The command installs itself, in apps/snug, and its manual
# in packaging. Components: command, development, and python for the module.

option(SNUG_INSTALL "Generate the install rules" ${PROJECT_IS_TOP_LEVEL})
option(SNUG_BUILD_DEB "Lay everything out as Debian's packages do, and make these with CPack; see the preset deb" OFF)
if(NOT SNUG_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
set(snug_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/snug)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/snug DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development FILES_MATCHING PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/adapters DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/snug
        COMPONENT development FILES_MATCHING PATTERN "*.h")
install(TARGETS snug EXPORT snug-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT snug-targets NAMESPACE snug:: DESTINATION ${snug_package_dir} COMPONENT development)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/snug-config.cmake.in
                              ${PROJECT_BINARY_DIR}/snug-config.cmake INSTALL_DESTINATION ${snug_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/snug-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/snug-config.cmake ${PROJECT_BINARY_DIR}/snug-config-version.cmake
        DESTINATION ${snug_package_dir} COMPONENT development)
# The prefix is found from where snug.pc lies: what is installed may be moved.
file(RELATIVE_PATH SNUG_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
set(SNUG_PC_ZLIB "")
if(ZLIB_FOUND)
  set(SNUG_PC_ZLIB ", zlib")
endif()
set(SNUG_PC_ASSIMP "")
if(SNUG_ASSIMP)
  set(SNUG_PC_ASSIMP ", assimp")
endif()
cmake_path(APPEND SNUG_PC_INCLUDEDIR "\${prefix}" ${CMAKE_INSTALL_INCLUDEDIR})
cmake_path(APPEND SNUG_PC_LIBDIR "\${prefix}" ${CMAKE_INSTALL_LIBDIR})
configure_file(cmake/snug.pc.in ${PROJECT_BINARY_DIR}/snug.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/snug.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)
if(NOT SNUG_BUILD_DEB)  # whose file `copyright` says it
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT development)
endif()
add_subdirectory(packaging)
