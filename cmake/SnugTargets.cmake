# One static target a layer. Flags that the proofs rest on are set here, once.
#
#   snug_layer(NAME SOURCES a.cpp ... [USES layer ...] [LINK target ...])
#
# USES names the layers whose headers this one may include; scripts/check_layers.py reads the same order.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

add_library(snug_flags INTERFACE)
# No contraction, no fast-math: every error term counts roundings one by one.
target_compile_options(snug_flags INTERFACE -ffp-contract=off -fno-fast-math)
add_library(snug_warnings INTERFACE)
target_compile_options(snug_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                       -Wold-style-cast -Wnon-virtual-dtor)

function(snug_layer name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;LINK" ${ARGN})
  set(target snug_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(snug::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:snug_flags> $<BUILD_INTERFACE:snug_warnings>)
  foreach(layer IN LISTS ARG_USES)
    target_link_libraries(${target} PUBLIC snug_${layer})
  endforeach()
  target_link_libraries(${target} PUBLIC ${ARG_LINK})
endfunction()
