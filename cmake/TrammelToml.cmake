# toml11::toml11, header-only, for the folder that includes this. Debian's package claims to be for 64-bit hosts only.
find_package(toml11 QUIET)
if(NOT TARGET toml11::toml11)
  find_path(TRAMMEL_TOML11_INCLUDE_DIR toml.hpp REQUIRED)
  add_library(toml11::toml11 INTERFACE IMPORTED)
  target_include_directories(toml11::toml11 INTERFACE "${TRAMMEL_TOML11_INCLUDE_DIR}")
endif()
