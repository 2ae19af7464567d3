// A hash of a list of commands. Internal to the runner.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>

#include "trammel/driver/command_sink.hpp"
#include "trammel/driver/commands.hpp"

namespace trammel::run {

// Equal lists have equal hashes; two different lists have the same hash with a probability of 2^-64.
class PlanIdentity final : public driver::CommandSink {
 public:
  void put(const driver::Command& command) override {
    std::array<std::uint32_t, driver::kMaxCommandWords> words{};
    const std::size_t count = driver::encode(command, 0, words.data());
    for (std::size_t i = 0; i < count; ++i) {
      hash_ = (hash_ ^ words[i]) * 0x9E3779B97F4A7C15U;
      hash_ ^= hash_ >> 32;
    }
  }
  std::string text() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_ = 0x6A09E667F3BCC908U;
};

}  // namespace trammel::run
