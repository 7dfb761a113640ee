# Highway's headers, which Debian has for its own machines, without its library: one instruction set a build, no dispatch at run time.
find_path(HWY_HEADERS hwy/highway.h PATHS /usr/include NO_CMAKE_FIND_ROOT_PATH)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(hwy REQUIRED_VARS HWY_HEADERS)
if(hwy_FOUND AND NOT TARGET hwy::hwy)
  # In a folder of their own, since beside them lie those of another C library.
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
  file(CREATE_LINK ${HWY_HEADERS}/hwy ${CMAKE_BINARY_DIR}/headers/hwy SYMBOLIC)
  add_library(hwy::hwy INTERFACE IMPORTED)
  set_target_properties(hwy::hwy PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${CMAKE_BINARY_DIR}/headers
                                            INTERFACE_COMPILE_DEFINITIONS HWY_COMPILE_ONLY_STATIC)
endif()
