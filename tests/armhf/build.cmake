# cmake -D SOURCE=... -D BUILD=... -D LAUNCHER=... -D "TARGETS=a;b" -P: configures the preset armhf in BUILD and builds the targets.
execute_process(COMMAND "${CMAKE_COMMAND}" --preset armhf -B "${BUILD}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}"
  WORKING_DIRECTORY "${SOURCE}" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND "${CMAKE_COMMAND}" --build "${BUILD}" --parallel 2 --target ${TARGETS}
  COMMAND_ERROR_IS_FATAL ANY)
