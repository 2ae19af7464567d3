// A card's inputs and outputs. The functions are documented in Card. Errors and thread-safety as of Registers.
#pragma once

#include <cstdint>

#include "trammel/driver/identification.hpp"
#include "trammel/driver/low_level/registers.hpp"

namespace trammel::driver {

class Ports {
 public:
  // Both must outlive the object.
  Ports(Registers& registers, const Identification& card) : registers_(registers), card_(card) {}

  std::uint32_t inputs();
  std::uint16_t outputs();
  unsigned inputs_present();
  unsigned outputs_present();
  void set_input_polarity(std::uint32_t inverted);
  void set_output_safe(std::uint16_t levels, std::uint16_t change);
  void set_output_safe_cause(std::uint16_t levels, std::uint16_t change);

 private:
  // `most`: number of bits of INPUTS or OUTPUTS.
  unsigned pins_present(std::uint32_t mask, std::uint32_t shift, std::uint32_t most, const char* pins);

  Registers& registers_;
  const Identification& card_;
};

}  // namespace trammel::driver
