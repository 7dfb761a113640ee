# What others link, snug::snug: the layers base to io, and the headers of adapters. find_package(snug) finds it after
# `cmake --install`; a project that adds this folder as a sub-directory links the same name. The command installs
# itself, in apps/snug.

set(snug_installed_layers base mesh scheme patch basis enclose tree surface query io)

add_library(snug_umbrella INTERFACE)
add_library(snug::snug ALIAS snug_umbrella)
set_target_properties(snug_umbrella PROPERTIES EXPORT_NAME snug)
# Functions in headers are compiled by the user: there, too, every rounding is counted one by one.
target_compile_options(snug_umbrella INTERFACE $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
target_link_libraries(snug_umbrella INTERFACE $<BUILD_INTERFACE:snug_adapters>)

option(SNUG_INSTALL "Generate the install rules" ${PROJECT_IS_TOP_LEVEL})
include(CMakePackageConfigHelpers)
set(snug_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/snug)

set(snug_installed_targets snug_umbrella)
foreach(layer IN LISTS snug_installed_layers)
  if(TARGET snug_${layer})
    target_link_libraries(snug_umbrella INTERFACE snug_${layer})
    list(APPEND snug_installed_targets snug_${layer})
    if(SNUG_INSTALL)
      install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/snug/${layer} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/snug
              FILES_MATCHING PATTERN "*.h")
    endif()
  endif()
endforeach()

if(SNUG_INSTALL)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/adapters DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/snug
          FILES_MATCHING PATTERN "*.h")
  install(TARGETS ${snug_installed_targets} EXPORT snug-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT snug-targets NAMESPACE snug:: DESTINATION ${snug_package_dir})

  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/snug-config.cmake.in
                                ${PROJECT_BINARY_DIR}/snug-config.cmake INSTALL_DESTINATION ${snug_package_dir})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/snug-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/snug-config.cmake ${PROJECT_BINARY_DIR}/snug-config-version.cmake
          DESTINATION ${snug_package_dir})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()
