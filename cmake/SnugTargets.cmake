# Targets of the library. Flags that the proofs rest on are set here, once.
#
#   snug          libsnug, static or shared by BUILD_SHARED_LIBS; others see include/snug alone
#   snug_private  the same code with its private headers, <snug/room/file.h>: for the command, tests, experiments, measurements

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

add_library(snug_flags INTERFACE)
# No contraction, no fast-math: every error term counts roundings one by one.
target_compile_options(snug_flags INTERFACE -ffp-contract=off -fno-fast-math)
# Where no build type is set, as in many a project that has snug as a sub-directory, compilers would not optimize.
target_compile_options(snug_flags INTERFACE $<$<CONFIG:>:-O2>)
add_library(snug_warnings INTERFACE)
target_compile_options(snug_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                       -Wold-style-cast -Wnon-virtual-dtor)
# GCC collects no garbage below half a GB: a twentieth less time for large units, for 120 MB more.
target_compile_options(snug_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=524288>)

# Headers of the standard library, and others named <...>, are parsed once and serve every target of the same flags, which
# halves what most files take to compile. ccache keeps objects made with them only if it may overlook what they define and
# when they were made, so it is told here. The preset web compiles without, so that files include what they use.
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache$")
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_INODECACHE=true
      ${CMAKE_CXX_COMPILER_LAUNCHER})
endif()
set(snug_standard_headers <algorithm> <array> <cmath> <functional> <memory> <mutex> <optional> <span> <string> <unordered_map>
                          <vector>)

# The library and the tests compile several files in a unit, which takes much less than these do apart. Debug builds, and the
# preset web, compile each file by itself.
set(snug_unity ON)
if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR CMAKE_DISABLE_PRECOMPILE_HEADERS)
  set(snug_unity OFF)
endif()

#   snug_units(TARGET)   what TARGET compiles together: up to six files of a room, which see each other's private names, of those that have
#                        no options of their own
function(snug_units target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${snug_unity} UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      continue()
    endif()
    cmake_path(GET source PARENT_PATH room)
    string(MAKE_C_IDENTIFIER "unit_${room}" name)
    if(NOT DEFINED files_of_${name})
      set(files_of_${name} 0)
    endif()
    math(EXPR unit "${files_of_${name}} / 6")
    math(EXPR files_of_${name} "${files_of_${name}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${name}_${unit})
  endforeach()
endfunction()

#   snug_vector_unit(NAME <room/file.cpp>...)   vector code of snug_objects that is compiled together. Each instruction set reads
#   Highway's headers again, a second and a half in all: so once for several files, which see each other's private names.
function(snug_vector_unit name)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O3 SKIP_PRECOMPILE_HEADERS ON)
  if(NOT snug_unity)
    return()
  endif()
  list(TRANSFORM ARGN REPLACE "(.+)" "#include <snug/\\1>" OUTPUT_VARIABLE includes)
  list(JOIN includes "\n" includes)
  # Files name themselves; what is read again is the unit.
  set(names_unit "#undef HWY_TARGET_INCLUDE\n#define HWY_TARGET_INCLUDE \"vector_units/${name}.cpp\"\n")
  set(unit ${CMAKE_CURRENT_BINARY_DIR}/vector_units/${name}.cpp)
  file(CONFIGURE OUTPUT ${unit} CONTENT "${names_unit}#include <snug/geometry/vector_code-inl.h>\n${includes}\n${names_unit}" @ONLY)
  set_source_files_properties(${unit} PROPERTIES COMPILE_OPTIONS -O3 SKIP_PRECOMPILE_HEADERS ON)
  set_source_files_properties(${ARGN} PROPERTIES HEADER_FILE_ONLY ON)
  target_sources(snug_objects PRIVATE ${unit})
  target_include_directories(snug_objects PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# With clang and sanitizers optimizing is most of what a file takes to compile. Of what runs briefly:
set(snug_quickly_compiled "")
if(CMAKE_CXX_FLAGS MATCHES "-DSNUG_SANITIZED")
  set(snug_quickly_compiled -O0)
endif()

#   snug_precompile(TARGET <header>...)   what TARGET compiles
function(snug_precompile target)
  target_precompile_headers(${target} PRIVATE ${snug_standard_headers} ${ARGN})
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  endif()
endfunction()

#   snug_precompiled(NAME <header>...)    a target with headers, and nothing else, for others: REUSE_FROM NAME
function(snug_precompiled name)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE snug_flags snug_warnings)
  snug_precompile(${name} ${ARGN})
endfunction()

# For compressed 3MF files: without it these are refused, and written uncompressed.
if(NOT EMSCRIPTEN)
  find_package(ZLIB QUIET)
endif()
set(snug_zlib "")
if(ZLIB_FOUND)
  set(snug_zlib ZLIB::ZLIB)
endif()

# For COLLADA, FBX and a few more: without it these are refused.
option(SNUG_ASSIMP "Read COLLADA, FBX and others by Assimp" OFF)
set(snug_assimp "")
if(SNUG_ASSIMP)
  find_package(assimp REQUIRED)
  set(snug_assimp assimp::assimp)
endif()

#   snug_library(room/a.cpp ...)
function(snug_library)
  find_package(hwy REQUIRED)
  find_package(Threads REQUIRED)
  find_package(nlohmann_json REQUIRED)  # headers only: users of the library do not need it
  add_library(snug_objects OBJECT ${ARGN})
  set_target_properties(snug_objects PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                                VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(snug_objects PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(snug_objects PRIVATE snug_flags snug_warnings hwy::hwy nlohmann_json::nlohmann_json
                                             Threads::Threads ${snug_zlib} ${snug_assimp})
  # On ARM NEON, as all processors have it: vectors without a fixed length cannot be members; and where Highway chooses at run time it
  # asks for instructions that implicit constructors, which GCC makes without them, cannot call.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_definitions(snug_objects PRIVATE HWY_COMPILE_ONLY_STATIC TOOLCHAIN_MISS_SYS_AUXV_H)
  endif()
  set_source_files_properties(../support/system_files_windows.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # <windows.h> names much
  set_source_files_properties(io/zip.cpp PROPERTIES COMPILE_DEFINITIONS SNUG_HAS_ZLIB=$<BOOL:${ZLIB_FOUND}>
                              SKIP_UNITY_BUILD_INCLUSION ON)
  set_source_files_properties(io/assimp.cpp PROPERTIES COMPILE_DEFINITIONS SNUG_HAS_ASSIMP=$<BOOL:${SNUG_ASSIMP}>
                              SKIP_UNITY_BUILD_INCLUSION ON)
  snug_precompile(snug_objects)

  add_library(snug $<TARGET_OBJECTS:snug_objects>)
  add_library(snug::snug ALIAS snug)
  set_target_properties(snug PROPERTIES VERSION ${PROJECT_VERSION}
                                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_compile_features(snug PUBLIC cxx_std_20)
  target_include_directories(snug PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(snug PRIVATE hwy::hwy Threads::Threads ${snug_zlib} ${snug_assimp})

  if(BUILD_SHARED_LIBS)  # whose private symbols cannot be linked
    add_library(snug_private STATIC $<TARGET_OBJECTS:snug_objects>)
    target_link_libraries(snug_private PRIVATE hwy::hwy Threads::Threads ${snug_zlib} ${snug_assimp})  # as snug does: the same flags, the same objects
  else()
    add_library(snug_private INTERFACE)
    target_link_libraries(snug_private INTERFACE snug)
  endif()
  target_include_directories(snug_private INTERFACE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(snug_private INTERFACE cxx_std_20)
  target_link_libraries(snug_private INTERFACE snug_flags)
endfunction()
