#   snug_test(NAME SOURCES a_test.cpp ... [LINK target ...] [LABELS fast|slow [threads]] [TIMEOUT seconds])
#
# One executable, bin/tests/NAME; each TEST in it is a line of ctest, "<folder>.<suite>.<claim>". The library with its
# private headers is linked without being named. Labels choose where a test runs besides `make test`:
#
#   fast      under address sanitizer too; the default
#   slow      on the release build only
#   threads   under thread sanitizer too
#
# A test reads its inputs below SNUG_MODELS_DIR and SNUG_CORPUS_DIR. GTEST_SKIP shows in ctest as Skipped.

include(GoogleTest)
find_package(GTest REQUIRED)

# All executables with tests for the thread sanitizer.
add_custom_target(tests_threads)
add_custom_target(tests_fast)

function(snug_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_SOURCES)
    message(FATAL_ERROR "snug_test(${name}): needs SOURCES, and does not know '${ARG_UNPARSED_ARGUMENTS}'")
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS fast)
  endif()
  foreach(label IN LISTS ARG_LABELS)
    if(NOT label MATCHES "^(fast|slow|threads)$")
      message(FATAL_ERROR "snug_test(${name}): unknown label ${label}")
    endif()
  endforeach()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
    if("slow" IN_LIST ARG_LABELS)
      set(ARG_TIMEOUT 900)
    endif()
  endif()

  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  add_executable(${name} ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin/tests)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE SNUG_MODELS_DIR="${PROJECT_SOURCE_DIR}/examples/models"
                                             SNUG_CORPUS_DIR="${PROJECT_SOURCE_DIR}/tests/corpus")
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  if(NOT folder MATCHES "^(oracle|command)$")
    target_link_libraries(${name} PRIVATE snug_private)
  endif()
  target_link_libraries(${name} PRIVATE snug_flags snug_warnings GTest::gtest_main)
  foreach(label IN ITEMS threads fast)
    if(label IN_LIST ARG_LABELS)
      add_dependencies(tests_${label} ${name})
    endif()
  endforeach()

  set(properties TIMEOUT ${ARG_TIMEOUT} COST ${ARG_TIMEOUT})  # what may take longest begins first
  if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=thread")
    list(APPEND properties ENVIRONMENT "TSAN_OPTIONS=halt_on_error=1")
  endif()
  gtest_discover_tests(${name} TEST_PREFIX "${folder}." TEST_LIST ${name}_claims DISCOVERY_MODE PRE_TEST
                       DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
  # gtest_discover_tests takes one label at most, so labels are set once the names are known.
  set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
  file(CONFIGURE OUTPUT ${labels_file} @ONLY CONTENT [[
foreach(claim IN LISTS @name@_claims)
  set_tests_properties("${claim}" PROPERTIES LABELS "@ARG_LABELS@")
endforeach()
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})
endfunction()
