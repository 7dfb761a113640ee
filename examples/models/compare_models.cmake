# Runs GENERATOR into FRESH and compares each file with its twin in COMMITTED; fails on the first difference, on a
# missing file and on a file too many.

file(REMOVE_RECURSE ${FRESH})
execute_process(COMMAND ${GENERATOR} ${FRESH} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "the generator failed: ${failed}")
endif()

file(GLOB fresh_names RELATIVE ${FRESH} ${FRESH}/*.obj)
file(GLOB committed_names RELATIVE ${COMMITTED} ${COMMITTED}/*.obj)
if(fresh_names STREQUAL "" OR NOT fresh_names STREQUAL committed_names)
  message(FATAL_ERROR "written: ${fresh_names}\ncommitted: ${committed_names}")
endif()

foreach(name IN LISTS fresh_names)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${FRESH}/${name} ${COMMITTED}/${name}
    RESULT_VARIABLE different)
  if(different)
    message(FATAL_ERROR "${name} differs from the committed file")
  endif()
endforeach()
