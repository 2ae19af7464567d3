#include "trammel/hm2/register_map.hpp"

#include <cstring>

namespace trammel::hm2::map {
namespace {

constexpr std::uint32_t kCookieValue = 0x55AACAFE;
constexpr char kConfigName[9] = "HOSTMOT2";
constexpr std::uint32_t kIdromType = 3;
constexpr std::uint32_t kModules = 0x40;  // offset in the IDROM
constexpr std::uint32_t kPinTable = 0x200;

// A module descriptor: three words.
struct Module {
  std::uint8_t tag;
  std::uint8_t version;
  std::uint8_t instances;  // 0: one for each axis
  std::uint16_t base;
  std::uint8_t registers;
  std::uint32_t of_each;  // bit n: register n exists for each instance
};

constexpr std::uint8_t kStepgenTag = 5;
constexpr std::uint8_t kPortTag = 3;
constexpr std::uint8_t kLowClock = 1;
constexpr Module kModuleTable[] = {
    {2, 0, 1, kWatchdogTimer, 3, 0},
    {kPortTag, 0, 1, kPortData, 5, 0x1F},
    {kStepgenTag, 2, 0, kStepRate, 10, 0x1FF},
};

// A pin's second use: bit 7 marks an output.
constexpr std::uint8_t kStepPin = 0x81;
constexpr std::uint8_t kDirectionPin = 0x82;

std::uint32_t word_of(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  return a | b << 8 | c << 16 | d << 24;
}

void put_text(std::uint32_t* words, const char* text) { std::memcpy(words, text, 8); }

}  // namespace

std::vector<std::uint32_t> constant_words(unsigned axes, std::uint32_t clock_hz) {
  std::vector<std::uint32_t> words(kBytes / 4, 0);
  words[kCookie / 4] = kCookieValue;
  put_text(&words[kCookie / 4 + 1], kConfigName);
  words[kCookie / 4 + 3] = kIdrom;
  std::uint32_t* idrom = &words[kIdrom / 4];
  const std::uint32_t head[] = {kIdromType, kModules, kPinTable};
  std::memcpy(idrom, head, sizeof(head));
  put_text(idrom + 3, kBoardName);
  // FPGA size and pins (unused), ports, pins, pins per port, both clocks, strides of instances and registers.
  const std::uint32_t tail[] = {0, 0, 1, kPins, kPins, clock_hz, clock_hz, 4, 64, 0x100, 4};
  std::memcpy(idrom + 5, tail, sizeof(tail));
  std::uint32_t* entry = idrom + kModules / 4;
  for (const Module& module : kModuleTable) {
    *entry++ = word_of(module.tag, module.version, kLowClock, module.instances == 0 ? axes : module.instances);
    *entry++ = module.base | std::uint32_t{module.registers} << 16;
    *entry++ = module.of_each;
  }
  for (unsigned pin = 0; pin < kPins; ++pin) {
    const bool steps = pin < 2 * axes;
    const std::uint8_t use = pin % 2 == 0 ? kStepPin : kDirectionPin;
    idrom[kPinTable / 4 + pin] = steps ? word_of(use, kStepgenTag, pin / 2, kPortTag) : word_of(0, 0, 0, kPortTag);
  }
  return words;
}

}  // namespace trammel::hm2::map
