// Accesses to the golden register file with a card at rest around it: a door that takes every word in two clocks
// and a direct loader that accepts every start.
#pragma once

#include <cstdint>

#include "trammel/model/register_file.hpp"

namespace trammel::tests {

struct Answer {
  bool error = false;
  std::uint32_t data = 0;
};

class RegisterBench {
 public:
  explicit RegisterBench(std::uint32_t axes) : axes_(axes), file_({axes, 1024, 512, 25'000'000}) { in.ratio = 1; }

  std::uint32_t axes() const { return axes_; }
  const model::RegisterFile::Outputs& outputs() const { return file_.outputs(); }
  const model::RegisterFile& file() const { return file_; }

  void clock() {
    in.start_done = file_.outputs().start;
    in.door_ready = !file_.outputs().stream_write;
    file_.clock(in);
  }

  Answer read(std::uint32_t address) { return access(false, address, 0, false); }
  Answer write(std::uint32_t address, std::uint32_t data) { return access(true, address, data, false); }

  // The reason of the refusal, None when the access was taken; REFUSAL is cleared afterwards.
  card_map::Reason refusal_of_read(std::uint32_t address) { return refusal_of(read(address), address); }
  card_map::Reason refusal_of_write(std::uint32_t address, std::uint32_t data) {
    return refusal_of(write(address, data), address);
  }
  card_map::Reason refusal_of_partial_write(std::uint32_t address, std::uint32_t data) {
    return refusal_of(access(true, address, data, true), address);
  }

  // Clocks from the last request to its answer.
  std::uint64_t latency() const { return latency_; }

  model::RegisterFile::Inputs in;

 private:
  Answer access(bool write, std::uint32_t address, std::uint32_t data, bool partial) {
    in.request = true;
    in.write = write;
    in.partial = partial;
    in.address = address;
    in.data = data;
    const std::uint64_t start = file_.time();
    do {
      clock();
      in.request = false;
    } while (!file_.outputs().ack);
    latency_ = file_.time() - start;
    const Answer answer{file_.outputs().error, file_.outputs().data};
    clock();  // a write takes effect in the clock of its answer
    return answer;
  }

  card_map::Reason refusal_of(const Answer& answer, std::uint32_t address) {
    if (!answer.error) return card_map::Reason::None;
    const std::uint32_t refusal = read(card_map::reg::kRefusal).data;
    write(card_map::reg::kRefusal, card_map::field::kRefusalReason);
    const std::uint32_t at = (refusal & card_map::field::kRefusalAddress) >> card_map::field::kRefusalAddressShift;
    // A refusal that names another access is none of this one's.
    if (at != address || answer.data != 0) return static_cast<card_map::Reason>(0xFF);
    return static_cast<card_map::Reason>(refusal & card_map::field::kRefusalReason);
  }

  std::uint32_t axes_;
  model::RegisterFile file_;
  std::uint64_t latency_ = 0;
};

}  // namespace trammel::tests
