// A storm (tests/support/frame_storm.hpp) through a Verilated port with its frame engine.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

#include "byte_ports.hpp"
#include "frame_storm.hpp"
#include "rtl_buses.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::lockstep {

// An error of the storm is reported as a mismatch.
inline void run_storm(test::FrameStorm& storm, std::uint64_t frames) {
  try {
    storm.run(frames);
    std::printf("%s\n", storm.text().c_str());
  } catch (const std::logic_error& error) {
    throw Mismatch(error.what());
  }
}

// The engine's inner port: the storm judges each access, and the answer comes a number of clocks later. Returns
// whether there was an access.
template <class Dut, class Clocks>
bool serve_access(Dut& dut, InnerPort& inner, test::FrameStorm& storm, Clocks clocks) {
  using namespace bus::register_access;
  const auto access = [&dut](const bus::Field& field) { return get(dut.access_o, field); };
  const bool request = access(kRequest) != 0;
  if (request) {
    const test::FrameStorm::Answer answer =
        storm.access(access(kWrite) != 0, static_cast<std::uint32_t>(access(kAddress)),
                     static_cast<std::uint32_t>(access(bus::register_access::kData)));
    inner.ask(clocks(), answer.refused, answer.data);
  }
  const InnerPort::Answer answer = inner.now();
  dut.answer_i = in_place(bus::register_answer::kAck, answer.ack) |
                 in_place(bus::register_answer::kError, answer.error) |
                 in_place(bus::register_answer::kData, answer.data);
  return request;
}

// 10^4 frames at a port's pins, 10^5 in the long run; more than one in `connected` of them makes a new connection.
template <class Bench>
void storm_at_pins(std::uint64_t seed, std::uint64_t connected) {
  const std::uint64_t frames = std::min<std::uint64_t>(scaled(10'000), 100'000);
  Bench bench(seed_from_environment(seed));
  run_storm(bench.storm(), frames);
  const test::FrameStorm::Counts& counts = bench.storm().counts();
  EXPECT_GE(counts.frames, frames);
  EXPECT_GT(counts.requests, frames / 4);
  EXPECT_GT(counts.damaged, frames / 4);
  EXPECT_GT(counts.connections, frames / connected);
}

}  // namespace trammel::lockstep
