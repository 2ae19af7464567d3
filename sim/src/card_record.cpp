#include "card_record.hpp"

#include <cstring>

namespace trammel::sim {

std::vector<lockstep::Difference> differences(const CardRecord& rtl, const CardRecord& model) {
  std::vector<lockstep::Difference> result;
  const auto word = [](const CardRecord& record, std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, reinterpret_cast<const char*>(&record) + offset, sizeof value);
    return value;
  };
  for (const CardSignal& signal : kCardSignals) {
    for (std::size_t n = 0; n < signal.words; ++n) {
      const std::size_t offset = signal.offset + n * sizeof(std::uint32_t);
      const std::uint32_t a = word(rtl, offset);
      const std::uint32_t b = word(model, offset);
      if (a != b) result.push_back({signal.name, a, b});
    }
  }
  return result;
}

}  // namespace trammel::sim
