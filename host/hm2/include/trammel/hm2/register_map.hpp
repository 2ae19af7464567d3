// The part of hostmot2's register map that this card has, as data: the self-description (IDROM), an I/O port, a
// watchdog, and step generators of version 2. Byte addresses; registers have 32 bits. Source of the facts: LinuxCNC's
// src/hal/drivers/mesa-hostmot2 (hostmot2.h, stepgen.c, watchdog.c, ioport.c, doc/README.regmap). Pure functions and
// plain data, thread-safe.
#pragma once

#include <cstdint>
#include <vector>

namespace trammel::hm2::map {

inline constexpr std::uint32_t kBytes = 0x10000;  // size of the space

// A driver reads these to identify hostmot2 and to find the IDROM.
inline constexpr std::uint16_t kCookie = 0x0100;
inline constexpr std::uint16_t kIdrom = 0x0400;

inline constexpr std::uint16_t kWatchdogTimer = 0x0C00;
inline constexpr std::uint16_t kWatchdogStatus = 0x0D00;
inline constexpr std::uint16_t kWatchdogReset = 0x0E00;

inline constexpr std::uint16_t kPortData = 0x1000;
inline constexpr std::uint16_t kPortInvert = 0x1400;

// Registers of the step generators: one word per axis from each address on, except kMasterRate.
inline constexpr std::uint16_t kStepRate = 0x2000;
inline constexpr std::uint16_t kAccumulator = 0x2100;
inline constexpr std::uint16_t kMode = 0x2200;
inline constexpr std::uint16_t kDirectionSetup = 0x2300;
inline constexpr std::uint16_t kDirectionHold = 0x2400;
inline constexpr std::uint16_t kStepLength = 0x2500;
inline constexpr std::uint16_t kStepSpace = 0x2600;
inline constexpr std::uint16_t kMasterRate = 0x2900;
// Step times have 14 bits: clocks.
inline constexpr std::uint32_t kLongestTime = 0x3FFF;

// Pins of the one I/O port: STEP and DIR of each axis, then inputs.
inline constexpr unsigned kPins = 24;

// Eight characters, in the IDROM. The driver makes its name for the card from the info space, not from this name.
inline constexpr char kBoardName[9] = "trammel ";

// The constant registers of a card with `axes` (1 to 8) and this clock: kBytes / 4 words, 0 at unused addresses.
std::vector<std::uint32_t> constant_words(unsigned axes, std::uint32_t clock_hz);

}  // namespace trammel::hm2::map
