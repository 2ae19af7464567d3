# Judges of the RTL's mutants: each lockstep again, over one instrumented copy of the RTL that contains all mutants.
# scripts/mutate runs them. Python with pyslang writes the copy, so they are built only with TRAMMEL_MUTATION.
find_program(TRAMMEL_PYTHON NAMES python3 HINTS "${PROJECT_SOURCE_DIR}/.venv/bin" NO_DEFAULT_PATH)
find_program(TRAMMEL_PYTHON NAMES python3 REQUIRED)

# trammel_instrument(RTL folder OUT folder FILES a.sv ...)
# Writes the instrumented copies of the files, which are given relative to RTL, and mutants.json into OUT.
function(trammel_instrument)
  cmake_parse_arguments(A "" "RTL;OUT" "FILES" ${ARGN})
  file(GLOB tool CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/scripts/mutation/*.py")
  set(sources ${A_FILES})
  set(copies ${A_FILES})
  list(TRANSFORM sources PREPEND "${A_RTL}/")
  list(TRANSFORM copies PREPEND "${A_OUT}/")
  add_custom_command(OUTPUT ${copies} "${A_OUT}/mutants.json"
    COMMAND "${CMAKE_COMMAND}" -E env "PYTHONPATH=${PROJECT_SOURCE_DIR}/scripts"
            "${TRAMMEL_PYTHON}" -B -m mutation.instrument --rtl "${A_RTL}" --out "${A_OUT}" ${sources}
    DEPENDS ${sources} ${tool} COMMENT "Instrumenting the RTL in ${A_RTL}" VERBATIM)
endfunction()

# trammel_add_judge(name OUT folder SOUND target PREFIX Vx TOP top SOURCES a.sv ... [ARGS ...] [LEVEL 0|1])
# Verilates the instrumented copies in OUT for mutation_<name>, which is linked with a test that was compiled against
# the Vx.h of SOUND.
function(trammel_add_judge name)
  cmake_parse_arguments(A "" "OUT;SOUND;PREFIX;TOP;LEVEL" "SOURCES;ARGS" ${ARGN})
  set(target mutation_${name})
  set(copies ${A_SOURCES})
  list(TRANSFORM copies PREPEND "${A_OUT}/")
  # No lint warnings here: a mutant may leave a signal unused or compare with an unreachable constant. The sound sources
  # are linted elsewhere.
  if(NOT DEFINED A_LEVEL)
    set(A_LEVEL 1)
  endif()
  trammel_verilate(${target} LEVEL ${A_LEVEL} PREFIX ${A_PREFIX} TOP ${A_TOP} SOURCES ${copies}
                   ARGS -Wno-lint -Wno-style -Wno-fatal ${A_ARGS})
  target_link_libraries(${target} PRIVATE trammel_mutant_number)
  # The header must equal the one that the test was compiled against, except for the includes of calls from
  # SystemVerilog into C.
  get_property(copy_dir GLOBAL PROPERTY TRAMMEL_VERILATED_${target}_${A_PREFIX})
  get_property(sound_dir GLOBAL PROPERTY TRAMMEL_VERILATED_${A_SOUND}_${A_PREFIX})
  add_custom_command(TARGET ${target} PRE_LINK VERBATIM
    COMMAND diff -I svdpi.h "${copy_dir}/${A_PREFIX}.h" "${sound_dir}/${A_PREFIX}.h")
endfunction()

# trammel_judge_entry(out name SOURCES a.sv ... [EXECUTABLE target] [ARGUMENTS ...] [LENGTH factor] [LAST_RESORT])
# Returns the judge's line of judges.json. EXECUTABLE defaults to mutation_<name>; ARGUMENTS go to GoogleTest; LENGTH is
# a factor for the random scenarios. LAST_RESORT: the judge is not tried on mutants listed as equivalent.
function(trammel_judge_entry out name)
  cmake_parse_arguments(A "LAST_RESORT" "EXECUTABLE;LENGTH" "SOURCES;ARGUMENTS" ${ARGN})
  set(last_resort false)
  if(A_LAST_RESORT)
    set(last_resort true)
  endif()
  if(NOT A_EXECUTABLE)
    set(A_EXECUTABLE mutation_${name})
  endif()
  foreach(list IN ITEMS SOURCES ARGUMENTS)
    list(TRANSFORM A_${list} REPLACE "(.+)" "\"\\1\"")
    list(JOIN A_${list} ", " A_${list})
  endforeach()
  string(CONCAT entry "{\"name\": \"${name}\", \"executable\": \"$<TARGET_FILE:${A_EXECUTABLE}>\", \"length\": \"${A_LENGTH}\", "
                      "\"last_resort\": ${last_resort}, "
                      "\"arguments\": [${A_ARGUMENTS}], \"sources\": [${A_SOURCES}]}")
  set(${out} "${entry}" PARENT_SCOPE)
endfunction()
