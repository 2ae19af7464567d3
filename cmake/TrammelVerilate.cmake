# Verilation of the card, of single blocks, and of copies of a block with one seeded bug.
find_package(verilator REQUIRED HINTS $ENV{VERILATOR_ROOT})
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)

set(TRAMMEL_RTL_DIR "${PROJECT_SOURCE_DIR}/rtl")
# The card's sources, and the packages, which trammel_verilate() always puts first.
file(STRINGS "${TRAMMEL_RTL_DIR}/trammel.f" TRAMMEL_CARD_SOURCES REGEX "^[^/].*\\.sv$")
set(TRAMMEL_RTL_PACKAGES "${TRAMMEL_CARD_SOURCES}")
list(FILTER TRAMMEL_RTL_PACKAGES INCLUDE REGEX "_pkg\\.sv$")
list(FILTER TRAMMEL_CARD_SOURCES EXCLUDE REGEX "_pkg\\.sv$")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${TRAMMEL_RTL_DIR}/trammel.f")
# Every bit without a reset value starts at random (class Simulated gives the seed), because zeros would hide a missing
# reset.
set(TRAMMEL_VERILATOR_ARGS -Wall "${PROJECT_SOURCE_DIR}/rtl/lint/waivers.vlt" -O3 --x-assign unique --x-initial unique
    --noassert)

# Points that Verilator counts in the RTL (docs/developer/coverage.md). A run writes them to the folder that the
# environment variable TRAMMEL_RTL_COVERAGE names: sim/include/trammel/sim/lockstep.hpp.
set(TRAMMEL_RTL_COVERAGE "" CACHE STRING "RTL coverage that Verilator counts: a list of line (with branches) and toggle; empty: none")
set(TRAMMEL_VM_COVERAGE 0)
set(coverage_run_time "")
foreach(kind IN LISTS TRAMMEL_RTL_COVERAGE)
  if(NOT kind MATCHES "^(line|toggle)$")
    message(FATAL_ERROR "TRAMMEL_RTL_COVERAGE: ${kind} is neither line nor toggle")
  endif()
  # Verilator 5.006 separates an if in clocked code from its counter. If the condition calls a function, the counter
  # then comes before it: the branch would never be covered, and its else always.
  list(APPEND TRAMMEL_VERILATOR_ARGS --coverage-${kind} -fno-split)
  set(TRAMMEL_VM_COVERAGE 1)
  set(coverage_run_time "${VERILATOR_ROOT}/include/verilated_cov.cpp")
endforeach()

# Code that Verilator generates is not the project's, so it has no warnings. It has no sanitizers and no debug lines
# either, because with these each card takes minutes to compile. The same holds for Verilator's run time: its writer of
# FST files stores words at odd addresses, which ends a traced run under UBSan.
set(TRAMMEL_VERILATED_OPTIONS -w)
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  list(APPEND TRAMMEL_VERILATED_OPTIONS -fno-sanitize=all -g0)
endif()

# Verilator's run time, once for all models.
add_library(trammel_verilated STATIC "${VERILATOR_ROOT}/include/verilated.cpp" ${coverage_run_time}
  "${VERILATOR_ROOT}/include/verilated_threads.cpp" "${VERILATOR_ROOT}/include/verilated_fst_c.cpp")
target_compile_features(trammel_verilated PUBLIC cxx_std_17)
target_compile_definitions(trammel_verilated PUBLIC VM_COVERAGE=${TRAMMEL_VM_COVERAGE} VM_SC=0 VM_TRACE=1 VM_TRACE_VCD=0 VM_TRACE_FST=1)
target_compile_options(trammel_verilated PRIVATE ${TRAMMEL_VERILATED_OPTIONS})
target_include_directories(trammel_verilated SYSTEM PUBLIC "${VERILATOR_ROOT}/include" "${VERILATOR_ROOT}/include/vltstd")
target_link_libraries(trammel_verilated PUBLIC Threads::Threads ZLIB::ZLIB)

# Verilator's headers, precompiled once for each optimisation level of generated code: they take half the compile time
# of a block.
set(TRAMMEL_VERILATED_LEVELS 0 1 3)
file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/verilated_headers.cpp" CONTENT "// Headers alone.\n")
foreach(level IN LISTS TRAMMEL_VERILATED_LEVELS)
  add_library(trammel_verilated_headers_${level} OBJECT "${CMAKE_CURRENT_BINARY_DIR}/verilated_headers.cpp")
  target_compile_options(trammel_verilated_headers_${level} PRIVATE ${TRAMMEL_VERILATED_OPTIONS} -O${level})
  target_link_libraries(trammel_verilated_headers_${level} PRIVATE trammel_verilated)
  target_precompile_headers(trammel_verilated_headers_${level} PRIVATE <verilated.h>)
endforeach()

# trammel_verilate(target PREFIX Vx TOP top SOURCES a.sv b.sv [ARGS ...] [TRACE] [ANY_EVENT] [LEVEL 0|1|3]) ANY_EVENT:
# the block also triggers on edges other than the clock's, so eval() evaluates both edges. Sources are relative to rtl/
# unless absolute. The package of the card map always comes first. Verilator runs as a step of the build (its own
# verilate() runs it while configuring, and again when building). All files that it writes are compiled as one file of
# the object library <target>_<Vx>, whose objects belong to the target. LEVEL is the compiler's -O: 3, the default, is
# fast to run; 1 or 0 is fast to compile. The global property TRAMMEL_VERILATED_<target>_<Vx> has the folder of Vx.h.
function(trammel_verilate target)
  cmake_parse_arguments(A "TRACE;ANY_EVENT" "PREFIX;TOP;LEVEL" "SOURCES;ARGS" ${ARGN})
  if(NOT DEFINED A_LEVEL)
    set(A_LEVEL 3)
  endif()
  if(TRAMMEL_RTL_COVERAGE AND A_LEVEL EQUAL 3)  # counters make the code twice as long, and the runs are short
    set(A_LEVEL 1)
  endif()
  set(files "")
  foreach(file IN LISTS TRAMMEL_RTL_PACKAGES A_SOURCES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${TRAMMEL_RTL_DIR}" NORMALIZE)
    list(APPEND files "${file}")
  endforeach()
  # A harness is read after the packages.
  set(harness ${A_ARGS})
  list(FILTER harness INCLUDE REGEX "\\.sv$")
  list(FILTER A_ARGS EXCLUDE REGEX "\\.sv$")
  set(model "${target}_${A_PREFIX}")
  set(dir "${CMAKE_CURRENT_BINARY_DIR}/${model}")
  set(code "${dir}/${A_PREFIX}__joined.cc")
  set(join "${PROJECT_SOURCE_DIR}/cmake/JoinVerilated.cmake")
  add_custom_command(OUTPUT "${code}" "${dir}/${A_PREFIX}.h"
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${dir}"
    COMMAND "${VERILATOR_BIN}" --cc --compiler gcc --prefix ${A_PREFIX} --top-module ${A_TOP} --Mdir "${dir}"
            $<$<BOOL:${A_TRACE}>:--trace-fst> ${TRAMMEL_VERILATOR_ARGS} ${A_ARGS} ${files} ${harness}
    COMMAND "${CMAKE_COMMAND}" -D DIR=${dir} -D PREFIX=${A_PREFIX} -D ANY_EVENT=${A_ANY_EVENT} -P "${join}"
    DEPENDS ${files} ${harness} "${PROJECT_SOURCE_DIR}/rtl/lint/waivers.vlt" "${join}"
    COMMENT "Verilating ${A_TOP} for ${target}" VERBATIM COMMAND_EXPAND_LISTS)
  add_library(${model} OBJECT EXCLUDE_FROM_ALL "${code}")
  target_compile_options(${model} PRIVATE ${TRAMMEL_VERILATED_OPTIONS} -O${A_LEVEL})
  target_include_directories(${model} PRIVATE "${PROJECT_SOURCE_DIR}/verif/lockstep" "${dir}")
  target_link_libraries(${model} PRIVATE trammel_verilated)
  target_precompile_headers(${model} REUSE_FROM trammel_verilated_headers_${A_LEVEL})
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${model}> "${dir}/${A_PREFIX}.h")
  target_include_directories(${target} SYSTEM PRIVATE "${dir}")
  target_link_libraries(${target} PRIVATE trammel_verilated)
  set_property(GLOBAL PROPERTY TRAMMEL_VERILATED_${model} "${dir}")
endfunction()

# trammel_add_lockstep(name TOP top SOURCES ... TEST test.cpp [HARNESS top.sv] [ARGS ...] [DEFINITIONS ...]
#                      [INCLUDES ...] [INSIDE inside.cpp] [ANY_EVENT] [LEVEL 0|1|3])
# Builds lockstep_<name>: the test runs Vdut (the block) in lockstep with its golden model. The test is compiled once
# (lockstep_<name>_test) and linked with the block and with each of its copies with a seeded bug, so it may use Vdut.h
# but no other file that Verilator writes. A source that uses one is given as INSIDE and is compiled for each copy.
# LEVEL is 1 by default, because few tests run long enough for more. DEFINITIONS and INCLUDES apply to the test. HARNESS
# is a top, in the test's folder, that connects several blocks only for their lockstep.
function(trammel_add_lockstep name)
  cmake_parse_arguments(A "ANY_EVENT" "TOP;TEST;INSIDE;HARNESS;LEVEL" "SOURCES;ARGS;DEFINITIONS;INCLUDES" ${ARGN})
  set(target lockstep_${name})
  set(how "")
  if(A_ANY_EVENT)
    set(how ANY_EVENT)
  endif()
  set_property(GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_HOW "${how}")
  if(NOT DEFINED A_LEVEL)
    set(A_LEVEL 1)
  endif()
  list(APPEND how LEVEL ${A_LEVEL})
  if(A_HARNESS)
    list(APPEND A_ARGS "${CMAKE_CURRENT_SOURCE_DIR}/${A_HARNESS}")
  endif()
  add_executable(${target} ${A_INSIDE})
  trammel_verilate(${target} ${how} PREFIX Vdut TOP ${A_TOP} SOURCES ${A_SOURCES} ARGS ${A_ARGS})
  trammel_lockstep_test(${target} TEST ${A_TEST} HEADERS_OF ${target} PREFIX Vdut)
  target_compile_definitions(${target}_test PRIVATE ${A_DEFINITIONS})
  target_include_directories(${target}_test PRIVATE ${A_INCLUDES})
  target_link_libraries(${target} PRIVATE ${target}_test)
  gtest_discover_tests(${target} TEST_PREFIX "lockstep.${name}." PROPERTIES LABELS lockstep DISCOVERY_TIMEOUT 60)
  set(A_PREFIX Vdut)
  foreach(var TOP PREFIX SOURCES ARGS INSIDE)
    set_property(GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_${var} "${A_${var}}")
  endforeach()
  set_property(GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_SOUND ${target})
  trammel_record_lockstep(${name})
endfunction()

# For the table of judges (scripts/rtl/judges): the sources that a lockstep clocks.
function(trammel_record_lockstep name)
  get_property(top GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_TOP)
  get_property(sources GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_SOURCES)
  list(JOIN sources "\", \"" sources)
  set_property(GLOBAL APPEND_STRING PROPERTY TRAMMEL_LOCKSTEPS_JSON
    "\n    {\"name\": \"${name}\", \"top\": \"${top}\", \"sources\": [\"${sources}\"]},")
endfunction()

# Writes the recorded data about locksteps and seeded bugs, after all of them are declared.
function(trammel_write_judges file)
  get_property(locksteps GLOBAL PROPERTY TRAMMEL_LOCKSTEPS_JSON)
  get_property(bugs GLOBAL PROPERTY TRAMMEL_SEEDED_BUGS_JSON)
  string(REGEX REPLACE ",$" "" locksteps "${locksteps}")
  string(REGEX REPLACE ",$" "" bugs "${bugs}")
  file(CONFIGURE OUTPUT "${file}" CONTENT "{\n  \"locksteps\": [${locksteps}\n  ],\n  \"seeded_bugs\": [${bugs}\n  ]\n}\n" @ONLY)
endfunction()

# trammel_lockstep_test(executable TEST test.cpp ... HEADERS_OF target PREFIX Vx)
# The test as <executable>_test, compiled against the Vx.h of a target that was given to trammel_verilate.
function(trammel_lockstep_test executable)
  cmake_parse_arguments(A "" "HEADERS_OF;PREFIX" "TEST" ${ARGN})
  get_property(dir GLOBAL PROPERTY TRAMMEL_VERILATED_${A_HEADERS_OF}_${A_PREFIX})
  add_library(${executable}_test OBJECT ${A_TEST})
  trammel_lockstep_target(${executable}_test)
  target_include_directories(${executable}_test SYSTEM PRIVATE "${dir}")
  # The target's rule makes the header. If that target is in another folder, the test depends on the target.
  get_target_property(folder ${A_HEADERS_OF} SOURCE_DIR)
  if(folder STREQUAL CMAKE_CURRENT_SOURCE_DIR)
    add_custom_target(${executable}_header DEPENDS "${dir}/${A_PREFIX}.h")
    add_dependencies(${executable}_test ${executable}_header)
    add_dependencies(${A_HEADERS_OF} ${executable}_header)
  else()
    add_dependencies(${executable}_test ${A_HEADERS_OF})
  endif()
endfunction()

# trammel_add_seeded_bug(name bug FILE f.sv FROM "text" TO "text" [FROM "text" TO "text" ...] [FILE g.sv FROM ...])
# The same lockstep over a copy of the block in which each text FROM (exactly once in its FILE) reads TO: the test
# seeded_bug.<name>.<bug>, which passes only when the lockstep reports a mismatch. ONLY "filter", last, names the lockstep's
# tests that run, if a few show the bug and the others take long.
function(trammel_add_seeded_bug name bug)
  foreach(var TOP PREFIX SOURCES ARGS INSIDE SOUND HOW)
    get_property(L_${var} GLOBAL PROPERTY TRAMMEL_LOCKSTEP_${name}_${var})
  endforeach()
  set(target lockstep_${name}_bug_${bug})
  set(dir "${CMAKE_CURRENT_BINARY_DIR}/seeded/${name}_${bug}")
  set(file "")
  set(only "")
  # The loop counts indices in steps of two, because the texts may contain semicolons, which separate CMake's list
  # elements.
  foreach(i RANGE 2 ${ARGC} 2)
    math(EXPR next "${i} + 1")
    if(i EQUAL ARGC OR "${ARGV${i}}" MATCHES "^(FILE|ONLY)$")
      if(file)
        cmake_path(GET file FILENAME file_name)
        file(CONFIGURE OUTPUT "${dir}/${file_name}" CONTENT "${text}" @ONLY)
        list(TRANSFORM L_SOURCES REPLACE "^${file}$" "${dir}/${file_name}")
        list(TRANSFORM TRAMMEL_RTL_PACKAGES REPLACE "^${file}$" "${dir}/${file_name}")
      endif()
      if("${ARGV${i}}" STREQUAL "ONLY")
        set(only "--gtest_filter=${ARGV${next}}")
        set(file "")
      elseif(i LESS ARGC)
        set(file "${ARGV${next}}")
        set_property(GLOBAL APPEND PROPERTY TRAMMEL_RTL_WITH_SEEDED_BUG "${file}")
        set_property(GLOBAL APPEND_STRING PROPERTY TRAMMEL_SEEDED_BUGS_JSON
          "\n    {\"name\": \"${name}.${bug}\", \"file\": \"${file}\"},")
        if(NOT file IN_LIST L_SOURCES AND NOT file IN_LIST TRAMMEL_RTL_PACKAGES)
          message(FATAL_ERROR "seeded bug ${name}/${bug}: ${file} is no source of ${name}, or named twice")
        endif()
        file(READ "${TRAMMEL_RTL_DIR}/${file}" text)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${TRAMMEL_RTL_DIR}/${file}")
      endif()
    elseif("${ARGV${i}}" STREQUAL "FROM")
      set(from "${ARGV${next}}")
      string(FIND "${text}" "${from}" first)
      string(FIND "${text}" "${from}" last REVERSE)
      if(first EQUAL -1 OR NOT first EQUAL last)
        message(FATAL_ERROR "seeded bug ${name}/${bug}: \"${from}\" must stand exactly once in rtl/${file}")
      endif()
    elseif("${ARGV${i}}" STREQUAL "TO")
      string(REPLACE "${from}" "${ARGV${next}}" text "${text}")
    else()
      message(FATAL_ERROR "seeded bug ${name}/${bug}: unknown argument ${ARGV${i}}")
    endif()
  endforeach()
  if(NOT TRAMMEL_SEEDED_BUGS)
    return()
  endif()
  add_executable(${target} ${L_INSIDE})
  # A seeded bug may leave a signal unused, and that warning must not stop the lockstep from judging it. The block's own
  # lockstep lints the unchanged sources, with every warning an error. -O0 compiles in a quarter of the time of -O1, and
  # most bugs show within milliseconds.
  trammel_verilate(${target} ${L_HOW} LEVEL 0 PREFIX ${L_PREFIX} TOP ${L_TOP} SOURCES ${L_SOURCES} ARGS -Wno-lint ${L_ARGS})
  trammel_same_header(${target} ${L_SOUND} ${L_PREFIX})
  # Objects precede libraries in linking. So this copy takes precedence over a sound copy in a library, such as the
  # card's.
  target_link_libraries(${target} PRIVATE lockstep_${name}_test)
  add_test(NAME seeded_bug.${name}.${bug} COMMAND ${target} --seeded-bug ${only})
  set_tests_properties(seeded_bug.${name}.${bug} PROPERTIES LABELS seeded_bug)
endfunction()

# The test was compiled against the sound copy's header, so the bug's must be the same.
function(trammel_same_header target sound prefix)
  get_property(bug_dir GLOBAL PROPERTY TRAMMEL_VERILATED_${target}_${prefix})
  get_property(sound_dir GLOBAL PROPERTY TRAMMEL_VERILATED_${sound}_${prefix})
  add_custom_command(TARGET ${target} PRE_LINK VERBATIM
    COMMAND "${CMAKE_COMMAND}" -E compare_files "${bug_dir}/${prefix}.h" "${sound_dir}/${prefix}.h")
endfunction()

function(trammel_lockstep_target target)
  trammel_target(${target})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/verif/lockstep" "${PROJECT_SOURCE_DIR}/sim/src")
  target_link_libraries(${target} PUBLIC trammel_lockstep_main trammel_lockstep trammel::model GTest::gtest)
  trammel_test_headers(${target})
endfunction()
