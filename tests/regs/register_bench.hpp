// Accesses to the golden register file with a card at rest around it: a command checker that accepts every word in six
// clocks (or refuses it when told), and a direct loader that accepts every start.
#pragma once

#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/register_file.hpp"

namespace trammel::tests {

struct Answer {
  bool error = false;
  std::uint32_t data = 0;
};

class RegisterBench {
 public:
  explicit RegisterBench(std::uint32_t axes) : RegisterBench(config_of(axes)) {}
  explicit RegisterBench(const model::RegisterFile::Config& config) : axes_(config.axes), file_(config) {
    in.ratio = 1;
  }

  static model::RegisterFile::Config config_of(std::uint32_t axes) {
    model::RegisterFile::Config config;
    config.axes = axes;
    config.geometry_depth = 1024;
    config.feed_depth = 512;
    config.clock_hz = 25'000'000;
    return config;
  }

  std::uint32_t axes() const { return axes_; }
  const model::RegisterFile::Outputs& outputs() const { return file_.outputs(); }
  const model::RegisterFile& file() const { return file_; }

  static constexpr int kCheckerClocks = 6;

  void clock() {
    in.start_done = file_.outputs().start;
    in.checker_refuse = refuse_word && checker_left_ == 1;
    if (checker_left_ != 0) --checker_left_;
    in.checker_ready = checker_left_ == 0;
    if (file_.outputs().stream_write) checker_left_ = kCheckerClocks;
    file_.clock(in);
    if (file_.outputs().setting.set) ++settings;
    in.stop = false;
  }

  Answer read(std::uint32_t address) { return access(false, address, 0, false); }
  Answer write(std::uint32_t address, std::uint32_t data) { return access(true, address, data, false); }

  // Reason of the refusal, None when the access was accepted. REFUSAL is cleared afterwards.
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
  std::uint32_t settings = 0;  // number of times that the setting bus was set
  bool refuse_word = false;    // the checker refuses the next word, with in.checker_reason and in.checker_number

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
    return answer;
  }

  card_map::Reason refusal_of(const Answer& answer, std::uint32_t address) {
    if (!answer.error) return card_map::Reason::None;
    const std::uint32_t refusal = read(card_map::reg::kRefusal).data;
    write(card_map::reg::kRefusal, card_map::field::kRefusalReason);
    const std::uint32_t at = (refusal & card_map::field::kRefusalAddress) >> card_map::field::kRefusalAddressShift;
    // A refusal that names another access does not belong to this one.
    if (at != address || answer.data != 0) return static_cast<card_map::Reason>(0xFF);
    return static_cast<card_map::Reason>(refusal & card_map::field::kRefusalReason);
  }

  std::uint32_t axes_;
  model::RegisterFile file_;
  std::uint64_t latency_ = 0;
  int checker_left_ = 0;
};

}  // namespace trammel::tests
