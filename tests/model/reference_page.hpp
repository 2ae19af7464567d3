// Shared by the tests of the reference pages: includes and short names.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "page_host.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::reference_page {

namespace reg = card_map::reg;
namespace field = card_map::field;
using card_map::Area;
using card_map::Reason;
using trammel::testing::feed;
using trammel::testing::kOnePulse;
using trammel::testing::line;
using trammel::testing::PathStep;
using Host = trammel::testing::PageHost;

}  // namespace trammel::reference_page
