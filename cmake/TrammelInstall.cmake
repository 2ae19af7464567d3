# Install and export rules of the libraries. A consumer needs no Python, RTL or Verilator.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(trammel_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/trammel")

install(TARGETS trammel_card_map trammel_model trammel_methods trammel_driver trammel_machine trammel_gcode
  trammel_planner trammel_run trammel_sim EXPORT trammel-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT trammel_development)
install(DIRECTORY
  "${PROJECT_SOURCE_DIR}/rtl/regs/generated/include/"
  "${PROJECT_SOURCE_DIR}/cpp-model/card/include/"
  "${PROJECT_SOURCE_DIR}/cpp-model/methods/include/"
  "${PROJECT_SOURCE_DIR}/driver/include/"
  "${PROJECT_SOURCE_DIR}/host/machine/include/"
  "${PROJECT_SOURCE_DIR}/host/gcode/include/"
  "${PROJECT_SOURCE_DIR}/host/planner/include/"
  "${PROJECT_SOURCE_DIR}/host/run/include/"
  "${PROJECT_SOURCE_DIR}/sim/include/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT trammel_development FILES_MATCHING PATTERN "*.hpp"
  PATTERN "lockstep.hpp" EXCLUDE)
install(EXPORT trammel-targets NAMESPACE trammel:: DESTINATION "${trammel_package_dir}"
  COMPONENT trammel_development)

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/trammel-config.cmake.in"
  "${PROJECT_BINARY_DIR}/trammel-config.cmake" INSTALL_DESTINATION "${trammel_package_dir}")
# Before 1.0 every minor version may break its users.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/trammel-config-version.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/trammel-config.cmake"
  "${PROJECT_BINARY_DIR}/trammel-config-version.cmake"
  DESTINATION "${trammel_package_dir}" COMPONENT trammel_development)
