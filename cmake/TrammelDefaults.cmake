# Options that belong to the project as the top level only; a consumer keeps its own.
if(PROJECT_IS_TOP_LEVEL)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    # A Verilated model at -O0 is 12 times slower.
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  endif()
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
  # g++ looks for memory to give back from 512 MB on only, not 128 MB: 5 % of its time.
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:--param=ggc-min-heapsize=524288>)
  # There are 360 programs to link: gold, which comes with g++ on Debian, takes half of the time of the default linker.
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=gold TRAMMEL_LINKS_WITH_GOLD)
  if(TRAMMEL_LINKS_WITH_GOLD)
    add_link_options($<$<CONFIG:Release>:-fuse-ld=gold>)
  endif()
endif()

option(TRAMMEL_WERROR "Warnings are errors" OFF)

# Every target of the project goes through this: C++17 (Debian's SystemC links only so), the warnings, and no contraction of
# a * b + c into one rounding: commands shall be the same on CPUs with and without fused multiply-add.
function(trammel_target target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                                           $<$<BOOL:${TRAMMEL_WERROR}>:-Werror>)
endfunction()
