#include "trammel/sim/lockstep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <climits>
#include <cmath>
#include <cstdlib>

namespace trammel::lockstep {

namespace {

bool seeded_bug_expected = false;
std::string seeded_bug_report;
std::atomic<std::uint64_t> compared_cycles{0};

}  // namespace

void count_compared(std::uint64_t cycles) { compared_cycles += cycles; }
std::uint64_t compared() { return compared_cycles; }

std::vector<EventLog::Event>::const_iterator EventLog::end_of(std::uint64_t cycle) const {
  auto end = events_.end();
  while (end != events_.begin() && std::prev(end)->cycle > cycle) --end;
  return end;
}

void EventLog::settle(std::uint64_t cycle) {
  const auto end = end_of(cycle);
  events_.erase(events_.begin(), end - std::min<std::ptrdiff_t>(end - events_.begin(), kKept));
}

std::string EventLog::text(std::uint64_t cycle) const {
  const auto end = end_of(cycle);
  const auto kept = std::min<std::ptrdiff_t>(end - events_.begin(), kKept);
  std::string text = fmt::format("last {} events:\n", kept);
  for (auto e = end - kept; e != end; ++e) text += fmt::format("  cycle {}: {} {:#x}\n", e->cycle, e->what, e->value);
  return text;
}

void fail(std::string_view block, std::uint64_t cycle, std::uint64_t seed, const std::vector<Difference>& differences,
          const std::string& events) {
  if (differences.empty())
    throw std::logic_error(fmt::format("{}: cycle {}: a difference without a name", block, cycle));
  std::string text;
  for (const Difference& d : differences) {
    text += fmt::format("{}: cycle {}: {} is {:#x} ({}) in RTL, {:#x} ({}) in the model\n", block, cycle, d.signal,
                        d.rtl, d.rtl, d.model, d.model);
  }
  text += fmt::format("repeat with TRAMMEL_SEED={} TRAMMEL_STATE_SEED={}\n", seed, state_seed());
  throw Mismatch(text + events);
}

void Checker::differ(const char* signal, std::uint64_t rtl, std::uint64_t model) const {
  fail(block_, cycles_, seed_, {{signal, rtl, model}}, events_.text(cycles_));
}

namespace {

std::uint64_t number_from_environment(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 0) : fallback;
}

}  // namespace

std::uint64_t seed_from_environment(std::uint64_t fallback) {
  return number_from_environment("TRAMMEL_SEED", fallback);
}

int state_seed() {
  const std::uint64_t seed = number_from_environment("TRAMMEL_STATE_SEED", seed_from_environment(1));
  return seed == 0 || seed > INT_MAX ? static_cast<int>(seed % INT_MAX) + 1 : static_cast<int>(seed);
}

std::uint64_t scaled(std::uint64_t length) {
  const char* text = std::getenv("TRAMMEL_LONG");
  if (text == nullptr) return length;
  char* end = nullptr;
  const double factor = std::strtod(text, &end);
  // A factor up to a million keeps every length well below 2^64.
  if (end == text || *end != '\0' || !(factor > 0 && factor <= 1e6)) {
    throw std::invalid_argument(fmt::format("TRAMMEL_LONG is no factor: {}", text));
  }
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(length) * factor));
}

std::string judge(const std::function<void()>& scenario) {
  if (!seeded_bug_report.empty()) return {};
  try {
    scenario();
  } catch (const Mismatch& mismatch) {
    if (!seeded_bug_expected) return mismatch.what();
    seeded_bug_report = mismatch.what();
  }
  return {};
}

void expect_seeded_bug() { seeded_bug_expected = true; }
const std::string& caught() { return seeded_bug_report; }

}  // namespace trammel::lockstep
