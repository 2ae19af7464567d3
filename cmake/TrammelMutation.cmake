# Judges over the RTL's mutants: each lockstep once more, over one instrumented copy of the RTL that holds all mutants.
# scripts/mutate runs them. Python with pyslang writes the copy, so this is built only where TRAMMEL_MUTATION asks for it.
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

# trammel_add_judge(name OUT folder TOP top SOURCES a.sv ... [PREFIX Vdut] [ARGS ...])
# Builds mutation_<name> over the instrumented copies in OUT. Its test is added by the caller, or is lockstep_<name>'s.
function(trammel_add_judge name)
  cmake_parse_arguments(A "" "OUT;TOP" "SOURCES;ARGS;PREFIX" ${ARGN})
  set(target mutation_${name})
  set(copies ${A_SOURCES})
  list(TRANSFORM copies PREPEND "${A_OUT}/")
  # A mutant may leave a signal unused or compare with a constant that is out of reach: the sound sources are linted.
  trammel_verilate(${target} PREFIX ${A_PREFIX} TOP ${A_TOP} SOURCES ${copies} ARGS -Wno-lint -Wno-style -Wno-fatal ${A_ARGS})
  target_link_libraries(${target} PRIVATE trammel_mutant_number)
  # Most runs end early, so that compiling is what takes long.
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "__fast.cc$")
  set_property(SOURCE ${sources} PROPERTY COMPILE_OPTIONS -w -O1)
endfunction()

# trammel_judge_entry(out name SOURCES a.sv ...): the judge's line of judges.json.
function(trammel_judge_entry out name)
  cmake_parse_arguments(A "" "" "SOURCES" ${ARGN})
  list(JOIN A_SOURCES "\", \"" sources)
  set(${out} "{\"name\": \"${name}\", \"executable\": \"$<TARGET_FILE:mutation_${name}>\", \"sources\": [\"${sources}\"]}"
      PARENT_SCOPE)
endfunction()
