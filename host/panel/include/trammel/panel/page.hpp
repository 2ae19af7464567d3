// The panel's page. The project's build makes it from web/ if Node and its packages are installed.
#pragma once

#include <string_view>

namespace trammel::panel {

// Empty in a build without the page.
std::string_view page();

inline constexpr const char* kHowToBuildPage =
    "this build is without the panel's page: scripts/setup installs what it needs (Node 18 or newer, and `npm ci` in "
    "web/); then configure and build again";

}  // namespace trammel::panel
