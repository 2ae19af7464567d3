# LinuxCNC's modules: built if its headers and tools are installed (scripts/setup --linuxcnc), or if they are requested.
find_program(TRAMMEL_HALCOMPILE halcompile)
find_path(TRAMMEL_LINUXCNC_INCLUDE hal.h PATHS /usr/include/linuxcnc NO_DEFAULT_PATH)
set(linuxcnc_found OFF)
if(TRAMMEL_HALCOMPILE AND TRAMMEL_LINUXCNC_INCLUDE AND PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CROSSCOMPILING)
  set(linuxcnc_found ON)
endif()
option(TRAMMEL_LINUXCNC "Build the modules for LinuxCNC (GPL-2.0-only)" ${linuxcnc_found})
if(TRAMMEL_LINUXCNC AND NOT linuxcnc_found)
  message(FATAL_ERROR "TRAMMEL_LINUXCNC needs halcompile and /usr/include/linuxcnc/hal.h: scripts/setup --linuxcnc "
                      "installs them (Debian's linuxcnc-uspace-dev)")
endif()

# trammel_linuxcnc_module(NAME SOURCE [flags ...]): NAME.so in ${CMAKE_BINARY_DIR}/linuxcnc, by LinuxCNC's own make rules.
# Not halcompile --compile, which works in a temporary folder, so that the sources' includes are not found.
function(trammel_linuxcnc_module name source)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${name}")
  set(module "${CMAKE_BINARY_DIR}/linuxcnc/${name}.so")
  execute_process(COMMAND "${TRAMMEL_HALCOMPILE}" --print-modinc OUTPUT_VARIABLE rules OUTPUT_STRIP_TRAILING_WHITESPACE
                  COMMAND_ERROR_IS_FATAL ANY)
  string(JOIN " " flags -I${CMAKE_CURRENT_SOURCE_DIR} -I${PROJECT_SOURCE_DIR}/host/linuxcnc/include -ffp-contract=off ${ARGN})
  file(CONFIGURE OUTPUT "${folder}/Makefile" @ONLY CONTENT
       "obj-m += @name@.o\ninclude @rules@\nEXTRA_CFLAGS += @flags@\nVPATH = @CMAKE_CURRENT_SOURCE_DIR@\n")
  set(preprocess)
  if(source MATCHES "\\.comp$")
    set(preprocess COMMAND "${TRAMMEL_HALCOMPILE}" --preprocess -o "${folder}/${name}.c" "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
  endif()
  file(GLOB headers CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.h")
  add_custom_command(OUTPUT "${module}"
    ${preprocess}
    COMMAND "${CMAKE_COMMAND}" -E rm -f "${folder}/${name}.o"
    COMMAND make --silent -C "${folder}" modules
    COMMAND "${CMAKE_COMMAND}" -E copy "${folder}/${name}.so" "${module}"
    DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${source}" ${headers} "${folder}/Makefile"
            "${PROJECT_SOURCE_DIR}/host/linuxcnc/include/trammel/linuxcnc/shared_region.h"
    COMMENT "LinuxCNC module ${name}.so" VERBATIM)
  add_custom_target(linuxcnc_${name} ALL DEPENDS "${module}")
endfunction()
