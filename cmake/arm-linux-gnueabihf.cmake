# 32-bit ARM with Debian's cross compiler; the programs run under qemu-user (the preset armhf). scripts/setup installs
# both, and unpacks libraries of that architecture into build/armhf-packages.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR armv7)
set(CMAKE_C_COMPILER arm-linux-gnueabihf-gcc)
set(CMAKE_CXX_COMPILER arm-linux-gnueabihf-g++)
# VFPv4 has fused multiply-add, so the planner's numbers would change here if the compiler contracted a * b + c. (g++
# does so with -fexpensive-optimizations, which the preset adds to -O1.) -Wno-psabi: g++ notes that it passes some
# arguments differently from g++ 6. -Wno-maybe-uninitialized: at -O1 it warns about std::optional.
set(CMAKE_C_FLAGS_INIT "-mfpu=neon-vfpv4")
set(CMAKE_CXX_FLAGS_INIT "-mfpu=neon-vfpv4 -Wno-psabi -Wno-maybe-uninitialized")
set(CMAKE_FIND_ROOT_PATH /usr/arm-linux-gnueabihf "${CMAKE_CURRENT_LIST_DIR}/../build/armhf-packages")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# cpp-model/methods asks for Boost; it needs a 128-bit type and is not built here.
set(Boost_INCLUDE_DIR /usr/include)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-arm-static -L /usr/arm-linux-gnueabihf)
