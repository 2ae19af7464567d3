# Functions that all tests share.
include(GoogleTest)
find_package(fmt REQUIRED)

# GoogleTest's headers, compiled once for all tests. Tests are not worth -O3: optimising takes half the compile time,
# and most of the tested code is in libraries.
set(trammel_test_level "$<$<NOT:$<CONFIG:Debug>>:-O1>")
add_library(trammel_test_headers OBJECT "${PROJECT_SOURCE_DIR}/tests/headers.cpp")
trammel_target(trammel_test_headers)
target_compile_options(trammel_test_headers PRIVATE "${trammel_test_level}")
target_link_libraries(trammel_test_headers PRIVATE fmt::fmt GTest::gmock)
target_precompile_headers(trammel_test_headers PRIVATE <gmock/gmock.h> <gtest/gtest.h> <fmt/format.h> <fstream> <sstream>)

# trammel_test_headers(target): for targets of the project's usual compile options that link GTest and fmt.
function(trammel_test_headers target)
  target_compile_options(${target} PRIVATE "${trammel_test_level}")
  target_precompile_headers(${target} REUSE_FROM trammel_test_headers)
endfunction()

# Third-party G-code programs beside the checkout: TRAMMEL_SHARED_GCODE is their folder, or empty if it is missing.
set(TRAMMEL_SHARED_GCODE "${PROJECT_SOURCE_DIR}/../shared/gcode")
if(NOT EXISTS "${TRAMMEL_SHARED_GCODE}")
  set(TRAMMEL_SHARED_GCODE "")
  message(STATUS "no ../shared/gcode: its programs are not tested, those of examples/ are")
endif()

# trammel_shared_gcode(target): defines TRAMMEL_SHARED_GCODE_DIR for its sources if the programs exist.
function(trammel_shared_gcode target)
  if(TRAMMEL_SHARED_GCODE)
    target_compile_definitions(${target} PRIVATE TRAMMEL_SHARED_GCODE_DIR="${TRAMMEL_SHARED_GCODE}")
  endif()
endfunction()

# trammel_discover_tests(target prefix [LABEL label] [FILTER filter] [properties ...]): makes a ctest test for each
# GoogleTest test that the filter selects, with the label `unit` unless another is given.
function(trammel_discover_tests target prefix)
  cmake_parse_arguments(PARSE_ARGV 2 A "" "LABEL;FILTER" "")
  if(NOT A_LABEL)
    set(A_LABEL unit)
  endif()
  gtest_discover_tests(${target} TEST_PREFIX "${prefix}." DISCOVERY_TIMEOUT 60 TEST_FILTER "${A_FILTER}"
                       PROPERTIES LABELS ${A_LABEL} ${A_UNPARSED_ARGUMENTS})
endfunction()

# trammel_library_tests(name LIBRARIES library ... [SOURCES further.cpp ...]): test_<name> from the folder's *_test.cpp,
# with RapidCheck for properties over random values, the code that tests share, and definitions of the folders of
# examples and third-party programs.
function(trammel_library_tests name)
  cmake_parse_arguments(PARSE_ARGV 1 A "" "" "LIBRARIES;SOURCES")
  find_package(rapidcheck REQUIRED)
  file(GLOB sources CONFIGURE_DEPENDS *_test.cpp)
  add_executable(test_${name} ${sources} ${A_SOURCES})
  trammel_target(test_${name})
  target_link_libraries(test_${name} PRIVATE ${A_LIBRARIES} fmt::fmt GTest::gmock_main rapidcheck rapidcheck_gtest)
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/support")
  target_compile_definitions(test_${name} PRIVATE TRAMMEL_EXAMPLES_DIR="${PROJECT_SOURCE_DIR}/examples")
  trammel_shared_gcode(test_${name})
  trammel_test_headers(test_${name})
  trammel_discover_tests(test_${name} ${name})
endfunction()
