# Verilation of the card, of single blocks, and of copies of a block with one seeded bug.
find_package(verilator REQUIRED HINTS $ENV{VERILATOR_ROOT})
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)

set(TRAMMEL_RTL_DIR "${PROJECT_SOURCE_DIR}/rtl")
# The card's sources without the package, which trammel_verilate() always puts first.
file(STRINGS "${TRAMMEL_RTL_DIR}/trammel.f" TRAMMEL_CARD_SOURCES REGEX "^[^/].*\\.sv$")
list(FILTER TRAMMEL_CARD_SOURCES EXCLUDE REGEX "_pkg\\.sv$")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${TRAMMEL_RTL_DIR}/trammel.f")
set(TRAMMEL_VERILATOR_ARGS -Wall "${PROJECT_SOURCE_DIR}/rtl/lint/waivers.vlt" -O3 --x-assign fast --x-initial fast
    --noassert)

# Verilator's run time, once for all models.
add_library(trammel_verilated STATIC "${VERILATOR_ROOT}/include/verilated.cpp"
  "${VERILATOR_ROOT}/include/verilated_threads.cpp" "${VERILATOR_ROOT}/include/verilated_fst_c.cpp")
target_compile_features(trammel_verilated PUBLIC cxx_std_17)
target_compile_definitions(trammel_verilated PUBLIC VM_COVERAGE=0 VM_SC=0 VM_TRACE=1 VM_TRACE_VCD=0 VM_TRACE_FST=1)
target_compile_options(trammel_verilated PRIVATE -w)
target_include_directories(trammel_verilated SYSTEM PUBLIC "${VERILATOR_ROOT}/include" "${VERILATOR_ROOT}/include/vltstd")
target_link_libraries(trammel_verilated PUBLIC Threads::Threads ZLIB::ZLIB)

# trammel_verilate(target PREFIX Vx TOP top SOURCES a.sv b.sv [ARGS ...] [TRACE])
# Sources are relative to rtl/ unless absolute. The package of the card map always comes first.
# Verilator runs as a step of the build (its own verilate() runs it while configuring, and again when building), and all
# that it writes is compiled as two files: the code that runs each clock, and the rest.
function(trammel_verilate target)
  cmake_parse_arguments(A "TRACE" "PREFIX;TOP" "SOURCES;ARGS" ${ARGN})
  set(files "${TRAMMEL_RTL_DIR}/regs/generated/card_map_pkg.sv")
  foreach(file IN LISTS A_SOURCES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${TRAMMEL_RTL_DIR}" NORMALIZE)
    list(APPEND files "${file}")
  endforeach()
  set(dir "${CMAKE_CURRENT_BINARY_DIR}/${target}_${A_PREFIX}")
  set(fast "${dir}/${A_PREFIX}__fast.cc")
  set(slow "${dir}/${A_PREFIX}__slow.cc")
  set(join "${PROJECT_SOURCE_DIR}/cmake/JoinVerilated.cmake")
  add_custom_command(OUTPUT "${fast}" "${slow}" "${dir}/${A_PREFIX}.h"
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${dir}"
    COMMAND "${VERILATOR_BIN}" --cc --compiler gcc --prefix ${A_PREFIX} --top-module ${A_TOP} --Mdir "${dir}"
            $<$<BOOL:${A_TRACE}>:--trace-fst> ${TRAMMEL_VERILATOR_ARGS} ${A_ARGS} ${files}
    COMMAND "${CMAKE_COMMAND}" -D DIR=${dir} -D PREFIX=${A_PREFIX} -P "${join}"
    DEPENDS ${files} "${PROJECT_SOURCE_DIR}/rtl/lint/waivers.vlt" "${join}"
    COMMENT "Verilating ${A_TOP} for ${target}" VERBATIM COMMAND_EXPAND_LISTS)
  target_sources(${target} PRIVATE "${fast}" "${slow}" "${dir}/${A_PREFIX}.h")
  # What Verilator writes is not the project's: no warnings from it.
  set_property(SOURCE "${fast}" PROPERTY COMPILE_OPTIONS -w -O3)
  set_property(SOURCE "${slow}" PROPERTY COMPILE_OPTIONS -w -O1)
  set_property(SOURCE "${fast}" "${slow}" PROPERTY SKIP_PRECOMPILE_HEADERS ON)
  target_include_directories(${target} SYSTEM PRIVATE "${dir}")
  target_link_libraries(${target} PRIVATE trammel_verilated)
endfunction()

# trammel_add_lockstep(name TOP top SOURCES ... TEST test.cpp [ARGS ...])
# Builds lockstep_<name>: the test clocks Vdut (the block) beside its golden model.
function(trammel_add_lockstep name)
  cmake_parse_arguments(A "" "TOP;TEST" "SOURCES;ARGS" ${ARGN})
  add_executable(lockstep_${name} ${A_TEST})
  trammel_lockstep_target(lockstep_${name})
  trammel_verilate(lockstep_${name} PREFIX Vdut TOP ${A_TOP} SOURCES ${A_SOURCES} ARGS ${A_ARGS})
  gtest_discover_tests(lockstep_${name} TEST_PREFIX "lockstep.${name}." PROPERTIES LABELS lockstep DISCOVERY_TIMEOUT 60)
  foreach(var TOP TEST SOURCES ARGS)
    set_property(GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_${var} "${A_${var}}")
  endforeach()
endfunction()

# trammel_add_seeded_bug(name bug FILE f.sv FROM "text" TO "text")
# The same lockstep over a copy of the block in which the text FROM (exactly once in FILE) reads TO.
# The executable is compiled with TRAMMEL_SEEDED_BUG: its tests pass only when the lockstep reports a mismatch.
function(trammel_add_seeded_bug name bug)
  cmake_parse_arguments(PARSE_ARGV 2 A "" "FILE;FROM;TO" "")
  foreach(var TOP TEST SOURCES ARGS)
    get_property(L_${var} GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_${var})
  endforeach()
  set(target lockstep_${name}_bug_${bug})
  set(dir "${CMAKE_CURRENT_BINARY_DIR}/seeded/${name}_${bug}")
  file(READ "${TRAMMEL_RTL_DIR}/${A_FILE}" text)
  string(FIND "${text}" "${A_FROM}" first)
  string(FIND "${text}" "${A_FROM}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "seeded bug ${name}/${bug}: \"${A_FROM}\" must stand exactly once in rtl/${A_FILE}")
  endif()
  string(REPLACE "${A_FROM}" "${A_TO}" text "${text}")
  cmake_path(GET A_FILE FILENAME file_name)
  file(CONFIGURE OUTPUT "${dir}/${file_name}" CONTENT "${text}" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${TRAMMEL_RTL_DIR}/${A_FILE}")
  set(sources ${L_SOURCES})
  list(TRANSFORM sources REPLACE "^${A_FILE}$" "${dir}/${file_name}")
  add_executable(${target} ${L_TEST})
  trammel_lockstep_target(${target})
  target_compile_definitions(${target} PRIVATE TRAMMEL_SEEDED_BUG)
  # A seeded bug may leave a signal unused: that warning must not keep the lockstep from judging it. The sources proper are
  # linted by the block's own lockstep, with every warning an error.
  trammel_verilate(${target} PREFIX Vdut TOP ${L_TOP} SOURCES ${sources} ARGS -Wno-lint ${L_ARGS})
  add_test(NAME seeded_bug.${name}.${bug} COMMAND ${target})
  set_tests_properties(seeded_bug.${name}.${bug} PROPERTIES LABELS seeded_bug)
endfunction()

function(trammel_lockstep_target target)
  trammel_target(${target})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/verif/lockstep")
  target_link_libraries(${target} PRIVATE trammel_lockstep trammel::model GTest::gtest_main)
  trammel_test_headers(${target})
endfunction()
