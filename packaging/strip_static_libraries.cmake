# What Debian leaves out of static libraries; CPack strips programs itself.
file(GLOB_RECURSE libraries "${CPACK_TEMPORARY_DIRECTORY}/*.a")
foreach(library IN LISTS libraries)
  execute_process(COMMAND strip --strip-debug --remove-section=.comment --remove-section=.note
                          --enable-deterministic-archives ${library} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
