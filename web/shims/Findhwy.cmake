# Highway's headers, which Debian has for its own machines: here alone, since beside them lie those of another C library.
find_path(HWY_HEADERS hwy/highway.h PATHS /usr/include /usr/local/include NO_CMAKE_FIND_ROOT_PATH)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(hwy REQUIRED_VARS HWY_HEADERS)
if(hwy_FOUND AND NOT TARGET hwy::hwy)
  set(hwy_alone ${CMAKE_BINARY_DIR}/highway)
  file(MAKE_DIRECTORY ${hwy_alone})
  file(CREATE_LINK ${HWY_HEADERS}/hwy ${hwy_alone}/hwy SYMBOLIC)
  add_library(hwy::hwy INTERFACE IMPORTED)
  # One instruction set a build: there is no dispatch at run time in a browser.
  set_target_properties(hwy::hwy PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${hwy_alone}
                                            INTERFACE_INCLUDE_DIRECTORIES ${hwy_alone}
                                            INTERFACE_COMPILE_DEFINITIONS HWY_COMPILE_ONLY_STATIC)
endif()
