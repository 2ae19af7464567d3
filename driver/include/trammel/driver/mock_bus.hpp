// A strict mock of the bus: the exact sequence of accesses is what a test expects. Header only; needs GoogleMock.
#pragma once

#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trammel/driver/bus.hpp"

namespace trammel::driver {

// Use as ::testing::StrictMock<MockBus> within ::testing::InSequence. A block arrives as one call of `block`.
class MockBus : public Bus {
 public:
  MOCK_METHOD(std::uint32_t, read, (std::uint32_t address), (override));
  MOCK_METHOD(void, write, (std::uint32_t address, std::uint32_t value), (override));
  MOCK_METHOD(void, wait, (std::uint64_t card_clocks), (override));
  MOCK_METHOD(void, block, (std::uint32_t address, std::vector<std::uint32_t> words, Addressing addressing));

  void write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                   Addressing addressing) override {
    block(address, std::vector<std::uint32_t>(words, words + count), addressing);
  }
};

}  // namespace trammel::driver
