// Drilling cycles: G73, G81 to G83, G85 and G89. Internal to the reader. Levels are along the axis that stands on the
// plane, positions in it; both in machine coordinates, mm.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "problem.hpp"

namespace trammel::gcode {

constexpr bool is_cycle(std::optional<int> code) {
  return code && (*code == 730 || *code == 810 || *code == 820 || *code == 830 || *code == 850 || *code == 890);
}
// What a cycle needs beside R and the level of its bottom.
constexpr bool pecks(int code) { return code == 730 || code == 830; }         // Q
constexpr bool dwells_below(int code) { return code == 820 || code == 890; }  // P

// One line's holes.
struct CycleHoles {
  int code = 810;
  double start = 0;    // level where the tool stands
  double retract = 0;  // R
  double bottom = 0;
  double clear = 0;               // where each hole ends, retract or above
  double peck = 0;                // G73, G83
  double seconds = 0;             // G82, G89
  std::array<double, 2> first{};  // position of the first hole
  std::array<double, 2> next{};   // from each to the next
  std::uint32_t count = 1;
};

enum class CycleStep : std::uint8_t { kRapid, kFeed, kDwell };

// Takes the motions of a cycle in their order.
class CycleSink {
 public:
  virtual ~CycleSink() = default;
  virtual void position(const std::array<double, 2>& to) = 0;  // a rapid in the plane
  virtual void level(CycleStep how, double to) = 0;            // kDwell: stays
};

// The motions that drill() makes at most; more than it counts: all the same too many.
inline constexpr std::size_t kMaxCycleMotions = 65'536;
std::size_t motions_of(const CycleHoles& holes);

void drill(const CycleHoles& holes, CycleSink& sink);

}  // namespace trammel::gcode
