# What others link, snug::snug, and the headers that go with it. find_package(snug) finds it after `cmake --install`; a
# project that adds this folder as a sub-directory links the same name. The command installs itself, in apps/snug.

option(SNUG_INSTALL "Generate the install rules" ${PROJECT_IS_TOP_LEVEL})
if(NOT SNUG_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
set(snug_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/snug)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/snug DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING
        PATTERN "*.h")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/adapters DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/snug
        FILES_MATCHING PATTERN "*.h")
install(TARGETS snug EXPORT snug-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT snug-targets NAMESPACE snug:: DESTINATION ${snug_package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/snug-config.cmake.in
                              ${PROJECT_BINARY_DIR}/snug-config.cmake INSTALL_DESTINATION ${snug_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/snug-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/snug-config.cmake ${PROJECT_BINARY_DIR}/snug-config-version.cmake
        DESTINATION ${snug_package_dir})
# The prefix is found from where snug.pc lies: what is installed may be moved.
file(RELATIVE_PATH SNUG_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
cmake_path(APPEND SNUG_PC_INCLUDEDIR "\${prefix}" ${CMAKE_INSTALL_INCLUDEDIR})
cmake_path(APPEND SNUG_PC_LIBDIR "\${prefix}" ${CMAKE_INSTALL_LIBDIR})
configure_file(cmake/snug.pc.in ${PROJECT_BINARY_DIR}/snug.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/snug.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
