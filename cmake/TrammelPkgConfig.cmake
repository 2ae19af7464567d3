# pkg-config files for the installed libraries: `trammel` for C, `trammel-<library>` for each C++ library. They are
# generated from the CMake targets and derive their prefix from their own location.
#
# The C++ libraries are only static, so Libs and Requires list everything that a program must link. Only `pkg-config
# --static` would show Libs.private and Requires.private.
file(RELATIVE_PATH up "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" /prefix)
string(REGEX REPLACE "/$" "" up "${up}")

function(trammel_write_pkg_config name description libs requires)
  string(REPLACE ";" " " libs "${libs}")
  string(REPLACE ";" ", " requires "${requires}")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/trammel.pc.in" "${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
    COMPONENT trammel_development)
endfunction()

# trammel_pkg_config(target): for a C++ library. Header-only libraries that it uses internally need no flags.
function(trammel_pkg_config target)
  get_target_property(name ${target} EXPORT_NAME)
  get_target_property(type ${target} TYPE)
  get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
  if(NOT links)
    set(links "")
  endif()
  set(libs "")
  if(NOT type STREQUAL "INTERFACE_LIBRARY")
    set(libs "-L\${libdir}" "-l${target}")
  endif()
  set(requires "")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^.*[<:]([A-Za-z0-9_]+::[A-Za-z0-9_]+)>*$" "\\1" link "${link}")
    if(link MATCHES "^trammel::(.*)$")
      list(APPEND requires "trammel-${CMAKE_MATCH_1}")
    elseif(link STREQUAL "fmt::fmt")
      list(APPEND requires fmt)
    elseif(link STREQUAL "Threads::Threads")
      list(APPEND libs -pthread)
    elseif(NOT link MATCHES "^(Boost::headers|toml11::toml11)$")
      message(FATAL_ERROR "${target} links ${link}: cmake/TrammelPkgConfig.cmake does not know its flags")
    endif()
  endforeach()
  trammel_write_pkg_config("trammel-${name}" "Trammel stepper-motion card: C++ library ${name}" "${libs}" "${requires}")
endfunction()
