# What every file of the browser's build is compiled with: exceptions of WebAssembly itself, and what Emscripten's library lacks.
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
add_compile_options(-fwasm-exceptions "SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/standard_library.h")
add_link_options(-fwasm-exceptions)
