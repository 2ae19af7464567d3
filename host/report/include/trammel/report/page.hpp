// The page around a report's data: made from web/ when the project is built, where Node and its packages are there.
#pragma once

#include <string_view>

namespace trammel::report {

// Both empty in a build without the page. Between them stand the data, as elements of their own.
std::string_view page_head();
std::string_view page_tail();

inline bool page_is_built() { return !page_head().empty(); }
// What to do where it is not.
inline constexpr const char* kHowToBuildPage =
    "this build is without the report's page: scripts/setup installs what it needs (Node 18 or newer, and `npm ci` in "
    "web/); then configure and build again";

}  // namespace trammel::report
