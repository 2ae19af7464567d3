#include "lockstep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace trammel::lockstep {

void Checker::fail(const char* signal, std::uint64_t rtl, std::uint64_t model) const {
  std::string text = fmt::format("{}: cycle {}: {} is {:#x} ({}) in RTL, {:#x} ({}) in the model\n", block_, cycles_,
                                 signal, rtl, rtl, model, model);
  text += fmt::format("repeat with TRAMMEL_SEED={}\n", seed_);
  const std::uint64_t kept = std::min<std::uint64_t>(event_count_, events_.size());
  text += fmt::format("last {} events:\n", kept);
  for (std::uint64_t i = event_count_ - kept; i < event_count_; ++i) {
    const Event& e = events_[i % events_.size()];
    text += fmt::format("  cycle {}: {} {:#x}\n", e.cycle, e.what, e.value);
  }
  throw Mismatch(text);
}

std::uint64_t seed_from_environment(std::uint64_t fallback) {
  const char* text = std::getenv("TRAMMEL_SEED");
  return text ? std::strtoull(text, nullptr, 0) : fallback;
}

}  // namespace trammel::lockstep
