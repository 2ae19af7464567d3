#include "trammel/skip/card_inputs.hpp"

namespace trammel::skip {

namespace {

using model::InputFilter;
using model::RoleScan;

// Clocks from clock `clock` of the scan to the one before the next look at the input, 0 to 63.
std::uint64_t until_look(unsigned clock, unsigned input) {
  return (2 * input + 2 + 2 * InputFilter::kScanClocks - clock) % InputFilter::kScanClocks;
}

// Clocks after which an input that keeps its level has passed, or is quiet.
std::uint64_t until_pass(const InputFilter& block, unsigned input, bool differs) {
  const InputFilter::State& s = block.state();
  const bool steady = ((differs ? s.differed : s.agreed) >> input & 1) != 0;
  const unsigned next = steady ? s.counts[input] + 1U : 0;  // the count of the next look
  // An input that agrees with its output must have agreed at a look before.
  const unsigned length = differs || steady ? s.lengths[input] : std::max<unsigned>(s.lengths[input], 1);
  const std::uint64_t looks = next >= length ? 0 : length - next;
  return until_look(s.clock, input) + looks * InputFilter::kScanClocks + 1;
}

}  // namespace

std::uint64_t horizon(const InputFilter& block, const InputFilter::Inputs& in) {
  const InputFilter::State& s = block.state();
  if (in.set || s.clearing) return 0;
  const std::uint32_t differs = in.levels ^ s.levels;
  if ((differs & s.quiet) != 0) return 0;
  const std::uint32_t waits = differs | (block.tells_quiet() ? ~s.quiet : 0);
  if (waits == 0) return kForever;
  // A new length takes effect from the second clock on.
  const unsigned next = s.clock / 2;
  if (s.length_read[1] != s.lengths[(next + InputFilter::kInputs - 1) % InputFilter::kInputs]) return 0;
  if (s.clock % 2 != 0 && s.length_read[0] != s.lengths[next]) return 0;
  std::uint64_t clocks = kForever;
  for (unsigned input = 0; input < InputFilter::kInputs; ++input) {
    if ((waits >> input & 1) != 0) clocks = std::min(clocks, until_pass(block, input, (differs >> input & 1) != 0) - 1);
  }
  return clocks;
}

void advance(InputFilter& block, const InputFilter::Inputs& in, std::uint64_t clocks) {
  if (clocks == 0) return;
  InputFilter::State& s = block.state();
  const std::uint32_t differs = in.levels ^ s.levels;
  // Each look increments the count of an input that differs, or is not quiet yet, and clears the counts of the
  // others.
  for (unsigned input = 0; input < InputFilter::kInputs; ++input) {
    const std::uint64_t first = until_look(s.clock, input);
    if (first >= clocks) continue;
    const std::uint64_t looks = (clocks - first - 1) / InputFilter::kScanClocks + 1;
    const std::uint32_t bit = std::uint32_t{1} << input;
    const bool counts = block.tells_quiet() || (differs & bit) != 0;
    if ((s.quiet & bit) != 0) continue;
    std::uint32_t& steady = (differs & bit) != 0 ? s.differed : s.agreed;
    const bool was_steady = (steady & bit) != 0;
    s.counts[input] = static_cast<std::uint16_t>(!counts ? 0 : was_steady ? s.counts[input] + looks : looks - 1);
    if (counts) steady |= bit;
  }
  s.differed &= differs;
  s.agreed &= ~differs;
  const auto read = [&s](std::uint64_t clock) { return s.lengths[clock % InputFilter::kScanClocks / 2]; };
  const std::uint64_t last = s.clock + clocks - 1;
  s.length_read = {read(last), clocks == 1 ? s.length_read[0] : read(last - 1)};
  s.clock = static_cast<unsigned>((s.clock + clocks) % InputFilter::kScanClocks);
}

void advance(RoleScan& block, const RoleScan::Inputs&, std::uint64_t clocks) {
  RoleScan::State& s = block.state();
  if (clocks == 0) return;
  const auto read = [&s](std::uint64_t clock) { return s.masks[clock % RoleScan::kRoles]; };
  const std::uint64_t last = s.clock + clocks - 1;
  s.mask_read = {read(last), clocks == 1 ? s.mask_read[0] : read(last - 1)};
  s.clock = static_cast<unsigned>((s.clock + clocks) % RoleScan::kRoles);
}

std::uint64_t horizon(const model::CardInputs& block, const model::CardInputs::Inputs& in) {
  const std::uint64_t pins = horizon(block.state().pins, in);
  if (pins == 0 || !block.has_machine_inputs()) return pins;
  return std::min(horizon(block.state().filter, block.filter_inputs(in.setting)),
                  horizon(block.state().roles, block.role_inputs(in.setting)));
}

void advance(model::CardInputs& block, const model::CardInputs::Inputs& in, std::uint64_t clocks) {
  if (!block.has_machine_inputs()) return;
  const RoleScan::Inputs roles = block.role_inputs(in.setting);
  advance(block.state().filter, block.filter_inputs(in.setting), clocks);
  advance(block.state().roles, roles, clocks);
}

}  // namespace trammel::skip
