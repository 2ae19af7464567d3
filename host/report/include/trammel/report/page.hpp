// The page around a report's data. The project's build makes it from web/ if Node and its packages are installed.
#pragma once

#include <string_view>

namespace trammel::report {

// Both are empty in a build without the page. The data elements are written between them.
std::string_view page_head();
std::string_view page_tail();

inline bool page_is_built() { return !page_head().empty(); }
// Instructions for a build without the page.
inline constexpr const char* kHowToBuildPage =
    "this build is without the report's page: scripts/setup installs what it needs (Node 18 or newer, and `npm ci` in "
    "web/); then configure and build again";

}  // namespace trammel::report
