#   snug_test(NAME SOURCES a_test.cpp ... [LINK target ...] [LABEL fast|release|slow|threads] [TIMEOUT seconds] [FILTER glob])
#
# One executable, bin/tests/NAME; each TEST in it is a line of ctest, "<folder>.<suite>.<claim>". The library with its
# private headers is linked without being named. The label chooses where a test runs besides `make test`:
#
#   fast      under address sanitizer too; the default
#   release   on the release build only: programs and libraries of research, which read no files of strangers
#   slow      on the release build only, and optimized
#   threads   under thread sanitizer only
#
# Sources are compiled several in a unit, so each has a namespace of its own: namespace snug::a_test { namespace { ... }}.
# GTEST_SKIP shows in ctest as Skipped.

include(GoogleTest)
find_package(GTest REQUIRED)

add_custom_target(tests_fast)

function(snug_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT;LABEL;FILTER" "SOURCES;LINK" ${ARGN})
  if(ARG_UNPARSED_ARGUMENTS OR NOT ARG_SOURCES)
    message(FATAL_ERROR "snug_test(${name}): needs SOURCES, and does not know '${ARG_UNPARSED_ARGUMENTS}'")
  endif()
  if(NOT ARG_LABEL)
    set(ARG_LABEL fast)
  endif()
  if(NOT ARG_LABEL MATCHES "^(fast|release|slow|threads)$")
    message(FATAL_ERROR "snug_test(${name}): unknown label ${ARG_LABEL}")
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(ARG_FILTER)
    set(ARG_FILTER TEST_FILTER ${ARG_FILTER})
  endif()

  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  add_executable(${name} ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin/tests
                                           UNITY_BUILD ${snug_unity} UNITY_BUILD_BATCH_SIZE 5)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_precompile_headers(${name} REUSE_FROM snug_tests_standard)
  if(NOT ARG_LABEL STREQUAL "slow")  # compiled once, run briefly
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_compile_options(${name} PRIVATE ${snug_quickly_compiled})
  target_link_libraries(${name} PRIVATE ${ARG_LINK})
  if(NOT folder STREQUAL "oracle")
    target_link_libraries(${name} PRIVATE snug_testing)
  endif()
  target_link_libraries(${name} PRIVATE snug_flags snug_warnings GTest::gtest_main)
  if(ARG_LABEL STREQUAL "fast")
    add_dependencies(tests_fast ${name})
  endif()

  set(properties TIMEOUT ${ARG_TIMEOUT} COST ${ARG_TIMEOUT} LABELS ${ARG_LABEL})  # what may take longest begins first
  if(ARG_LABEL STREQUAL "threads")
    list(APPEND properties ENVIRONMENT "TSAN_OPTIONS=halt_on_error=1")
  endif()
  gtest_discover_tests(${name} TEST_PREFIX "${folder}." ${ARG_FILTER} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES ${properties})
endfunction()
