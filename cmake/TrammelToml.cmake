# toml11::toml11 in the folder that includes this: headers alone. Debian's package says that it is for 64-bit hosts.
find_package(toml11 QUIET)
if(NOT TARGET toml11::toml11)
  find_path(TRAMMEL_TOML11_INCLUDE_DIR toml.hpp REQUIRED)
  add_library(toml11::toml11 INTERFACE IMPORTED)
  target_include_directories(toml11::toml11 INTERFACE "${TRAMMEL_TOML11_INCLUDE_DIR}")
endif()
