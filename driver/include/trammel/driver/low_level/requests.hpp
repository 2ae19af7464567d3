// Requests from other threads to the thread that uses a card. Thread-safety: any thread, and any signal handler, may
// make a request at any time. Only the thread that uses the card calls take_...() and serve_requests().
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

class Card;

class Requests {
 public:
  void hold(bool hold) noexcept { hold_.store(hold ? 1 : 0); }
  void abort() noexcept { abort_.store(true); }
  void stop() noexcept { stop_.store(true); }
  // `ratio`: 2^-16; a value above kFullRatio is ignored.
  void ratio(PieceClass piece_class, std::uint32_t ratio) noexcept {
    ratio_[static_cast<std::size_t>(piece_class)].store(ratio);
  }

  // Each returns the last request, once.
  bool take_abort() { return abort_.exchange(false); }
  bool take_stop() { return stop_.exchange(false); }
  std::optional<bool> take_hold();
  std::optional<std::uint32_t> take_ratio(PieceClass piece_class);

 private:
  static constexpr std::uint32_t kNoRatio = ~std::uint32_t{0};
  std::atomic<int> hold_{-1};  // 1 hold, 0 resume, -1 no request
  std::array<std::atomic<std::uint32_t>, kPieceClasses> ratio_{kNoRatio, kNoRatio, kNoRatio};
  std::atomic<bool> abort_{false};
  std::atomic<bool> stop_{false};
};

// Executes the requests of other threads, and restarts the card's watchdog. For the thread that uses the card, in its
// own wait loop; waiting calls of the driver do it themselves. Throws StateError after an abort; StoppedError after a
// stop, also after one that an InterruptScope caused; else errors as of Card.
void serve_requests(Card& card);

}  // namespace trammel::driver
