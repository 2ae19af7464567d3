// Drilling cycles: G73, G81 to G83, G85 and G89. Internal to the reader. Levels are along the normal of the plane,
// positions are in the plane; both in mm, machine coordinates.
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
// The words that a cycle needs in addition to R and the level of its bottom.
constexpr bool pecks(int code) { return code == 730 || code == 830; }         // Q
constexpr bool dwells_below(int code) { return code == 820 || code == 890; }  // P

// The holes of one line.
struct CycleHoles {
  int code = 810;
  double start = 0;               // level of the tool before the first hole
  double retract = 0;             // level R
  double bottom = 0;              // level
  double clear = 0;               // level at which each hole ends: `retract` or above
  double peck = 0;                // depth of a peck, mm: G73, G83
  double seconds = 0;             // dwell at the bottom: G82, G89
  std::array<double, 2> first{};  // position of the first hole
  std::array<double, 2> next{};   // from each hole to the next
  std::uint32_t count = 1;
};

enum class CycleStep : std::uint8_t { kRapid, kFeed, kDwell };

// Receives the motions of a cycle in their order.
class CycleSink {
 public:
  virtual ~CycleSink() = default;
  virtual void position(const std::array<double, 2>& to) = 0;  // a rapid in the plane
  virtual void level(CycleStep how, double to) = 0;            // kDwell: stays at the level
};

// An upper bound of the motions that drill() makes. The count is not exact above kMaxCycleMotions, which is too many
// anyway.
inline constexpr std::size_t kMaxCycleMotions = 65'536;
std::size_t motions_of(const CycleHoles& holes);

void drill(const CycleHoles& holes, CycleSink& sink);

}  // namespace trammel::gcode
