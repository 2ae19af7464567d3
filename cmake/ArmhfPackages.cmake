# Where find_package() finds the libraries in a build for armhf (the preset of that name), without packages of that
# architecture on the host: headers of the host's packages, of those alone by links (all of /usr/include would hide the cross compiler's
# own), GoogleTest from its sources, RapidCheck's library from what scripts/common.sh unpacked.
set(armhf_headers "${CMAKE_BINARY_DIR}/host-headers")
set(armhf_rapidcheck "${CMAKE_SOURCE_DIR}/build/armhf-packages/usr/lib/arm-linux-gnueabihf/librapidcheck.a")

# armhf_headers_of(target name ...): an interface library with these entries of the host's include folder.
function(armhf_headers_of target)
  file(MAKE_DIRECTORY "${armhf_headers}/${target}")
  foreach(name IN LISTS ARGN)
    find_path(folder "${name}" PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
    file(CREATE_LINK "${folder}/${name}" "${armhf_headers}/${target}/${name}" SYMBOLIC)
    unset(folder)
  endforeach()
  add_library(armhf_${target} INTERFACE)
  target_include_directories(armhf_${target} SYSTEM INTERFACE "${armhf_headers}/${target}")
endfunction()

function(armhf_find_fmt)
  armhf_headers_of(fmt fmt)
  target_compile_definitions(armhf_fmt INTERFACE FMT_HEADER_ONLY)
  add_library(fmt::fmt ALIAS armhf_fmt)
endfunction()

function(armhf_find_toml11)
  armhf_headers_of(toml11 toml.hpp toml)
  add_library(toml11::toml11 ALIAS armhf_toml11)
endfunction()

function(armhf_find_nlohmann_json)
  armhf_headers_of(nlohmann_json nlohmann)
  add_library(nlohmann_json::nlohmann_json ALIAS armhf_nlohmann_json)
endfunction()

function(armhf_find_Boost)
  armhf_headers_of(boost boost)
  add_library(Boost::headers ALIAS armhf_boost)
endfunction()

function(armhf_find_GTest)
  add_subdirectory(/usr/src/googletest "${CMAKE_BINARY_DIR}/googletest" EXCLUDE_FROM_ALL)
endfunction()

function(armhf_find_rapidcheck)
  armhf_headers_of(rapidcheck rapidcheck rapidcheck.h)
  target_link_libraries(armhf_rapidcheck INTERFACE "${armhf_rapidcheck}")
  add_library(rapidcheck ALIAS armhf_rapidcheck)
  add_library(rapidcheck_gtest INTERFACE)
endfunction()

# find_package() comes here first; what is not named here is searched as ever.
macro(armhf_find method package)
  if(COMMAND armhf_find_${package})
    if(NOT TARGET armhf_found_${package})
      cmake_language(CALL armhf_find_${package})
      add_library(armhf_found_${package} INTERFACE)
    endif()
    set(${package}_FOUND TRUE)
  endif()
endmacro()
cmake_language(SET_DEPENDENCY_PROVIDER armhf_find SUPPORTED_METHODS FIND_PACKAGE)
