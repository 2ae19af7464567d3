# The components of the installation, each usable without the others:
#   trammel_development  libraries, headers, CMake package, pkg-config files; a consumer needs no Python, RTL or Verilator
#   trammel_command      the trammel command
#   trammel_rtl          the card's sources, with their file list, FuseSoC core and lint waivers
#   trammel_python       Python's package, if it is built (bindings/python)
#   trammel_machine      the default machine file and the default world, as templates
#   trammel_licence
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(trammel_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/trammel")

set(trammel_cpp_libraries trammel_card_map trammel_frames trammel_model trammel_skip trammel_methods trammel_driver
  trammel_transport trammel_machine trammel_kinematics trammel_gcode trammel_planner trammel_chart trammel_run trammel_sim
  trammel_world)
install(TARGETS ${trammel_cpp_libraries} trammel_c EXPORT trammel-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT trammel_development
  LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT trammel_development)
install(FILES "${PROJECT_SOURCE_DIR}/bindings/c/include/trammel.h"
  "${PROJECT_SOURCE_DIR}/bindings/c/include/trammel_machine.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT trammel_development)
install(DIRECTORY
  "${PROJECT_SOURCE_DIR}/rtl/regs/generated/include/"
  "${PROJECT_SOURCE_DIR}/frames/include/"
  "${PROJECT_SOURCE_DIR}/cpp-model/card/include/"
  "${PROJECT_SOURCE_DIR}/cpp-model/skip/include/"
  "${PROJECT_SOURCE_DIR}/cpp-model/methods/include/"
  "${PROJECT_SOURCE_DIR}/driver/include/"
  "${PROJECT_SOURCE_DIR}/transport/include/"
  "${PROJECT_SOURCE_DIR}/host/machine/include/"
  "${PROJECT_SOURCE_DIR}/host/kinematics/include/"
  "${PROJECT_SOURCE_DIR}/host/gcode/include/"
  "${PROJECT_SOURCE_DIR}/host/planner/include/"
  "${PROJECT_SOURCE_DIR}/host/chart/include/"
  "${PROJECT_SOURCE_DIR}/host/run/include/"
  "${PROJECT_SOURCE_DIR}/sim/include/"
  "${PROJECT_SOURCE_DIR}/world/include/"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT trammel_development FILES_MATCHING PATTERN "*.hpp"
  PATTERN "lockstep.hpp" EXCLUDE PATTERN "engines.hpp" EXCLUDE)  # need the Verilated card
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

include(TrammelPkgConfig)
foreach(library IN LISTS trammel_cpp_libraries)
  trammel_pkg_config(${library})
endforeach()
trammel_write_pkg_config(trammel "Trammel stepper-motion card: driver and simulated card for C"
  "-L\${libdir};-ltrammel" "")

set(trammel_data_dir "${CMAKE_INSTALL_DATADIR}/trammel")

# The files keep the folders that the file list has.
file(STRINGS "${PROJECT_SOURCE_DIR}/rtl/trammel.f" sources REGEX "^[^/].*\\.sv$")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/rtl/trammel.f")
foreach(file IN ITEMS trammel.f trammel.core lint/waivers.vlt LISTS sources)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES "${PROJECT_SOURCE_DIR}/rtl/${file}" DESTINATION "${trammel_data_dir}/rtl/${folder}"
    COMPONENT trammel_rtl)
endforeach()

install(FILES "${PROJECT_SOURCE_DIR}/examples/machine.toml" "${PROJECT_SOURCE_DIR}/examples/world.toml" DESTINATION "${trammel_data_dir}"
  COMPONENT trammel_machine)
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT trammel_licence)
