# FCL once more, from its sources with the flags that snug has, in a namespace of its own: packages are built with other ones.
# Headers that FCL's own build writes, config.h and export.h, are those of the installed package.
set(SNUG_FCL_SOURCE "" CACHE PATH "FCL's sources as `apt-get source fcl` unpacks them: bench_bars measures them, too")
if(NOT SNUG_FCL_SOURCE)
  return()
endif()
foreach(folder math geometry common narrowphase)
  file(GLOB_RECURSE some ${SNUG_FCL_SOURCE}/src/${folder}/*.cpp)
  list(APPEND FCL_SOURCES ${some})
endforeach()
add_library(snug_fcl_rebuilt STATIC ${FCL_SOURCES} peer_fcl_tree.cpp)
target_include_directories(snug_fcl_rebuilt SYSTEM BEFORE PRIVATE ${SNUG_FCL_SOURCE}/include)
target_compile_definitions(snug_fcl_rebuilt PRIVATE fcl=fcl_rebuilt SNUG_FCL_MAKER=make_rebuilt_fcl_tree
                                                   SNUG_BENCH_FCL_REBUILT)
target_link_libraries(snug_fcl_rebuilt PUBLIC snug_private PRIVATE snug_flags fcl)
target_link_libraries(snug_peers PRIVATE snug_fcl_rebuilt ccd octomap)
target_compile_definitions(snug_peers PUBLIC SNUG_BENCH_FCL_REBUILT)
