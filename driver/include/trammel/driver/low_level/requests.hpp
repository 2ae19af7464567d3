// What other threads ask of the thread that uses a card. Thread-safety: any thread, and any signal handler, may make a
// request at any time; take_...() and serve_requests() are the using thread's.
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
  // `ratio`: 2^-16; one above kFullRatio is left out.
  void ratio(PieceClass piece_class, std::uint32_t ratio) noexcept {
    ratio_[static_cast<std::size_t>(piece_class)].store(ratio);
  }

  // The request made last, once.
  bool take_abort() { return abort_.exchange(false); }
  bool take_stop() { return stop_.exchange(false); }
  std::optional<bool> take_hold();
  std::optional<std::uint32_t> take_ratio(PieceClass piece_class);

 private:
  static constexpr std::uint32_t kNoRatio = ~std::uint32_t{0};
  std::atomic<int> hold_{-1};  // 1 hold, 0 go on, -1 nothing asked
  std::array<std::atomic<std::uint32_t>, kPieceClasses> ratio_{kNoRatio, kNoRatio, kNoRatio};
  std::atomic<bool> abort_{false};
  std::atomic<bool> stop_{false};
};

// Does what other threads have asked of the card, and starts its watchdog anew. For the thread that uses it, in a wait
// of its own: calls of the driver that wait do so themselves. Throws StateError after an abort, StoppedError after a
// stop, also after the one that an InterruptScope asks for; else errors as of Card.
void serve_requests(Card& card);

}  // namespace trammel::driver
