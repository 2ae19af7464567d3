# What all tests share.
include(GoogleTest)
find_package(fmt REQUIRED)

# GoogleTest's headers, compiled once for all tests.
add_library(trammel_test_headers OBJECT "${PROJECT_SOURCE_DIR}/tests/headers.cpp")
trammel_target(trammel_test_headers)
target_link_libraries(trammel_test_headers PRIVATE fmt::fmt GTest::gmock)
target_precompile_headers(trammel_test_headers PRIVATE <gmock/gmock.h> <gtest/gtest.h> <fmt/format.h> <fstream> <sstream>)

# trammel_test_headers(target): for targets of the project's usual compile options that link GTest and fmt.
function(trammel_test_headers target)
  target_precompile_headers(${target} REUSE_FROM trammel_test_headers)
endfunction()
