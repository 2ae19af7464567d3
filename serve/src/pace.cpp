#include "pace.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
using std::chrono::duration;

constexpr std::uint64_t kPiece = 5000;  // clocks; they take the Verilated card some ms
constexpr double kMaxBehind = 0.5;      // s, largest delay that is made up
constexpr double kLeast = 0.0005;       // s of card time, smallest piece to run; below it the server sleeps
constexpr auto kTellAgain = 10s;

}  // namespace

void CardServer::Pace::anchor() {
  anchor_time_ = Clock::now();
  anchor_cycle_ = engine_.cycles();
}

// A card that is far behind does not run faster afterwards to catch up: the lost time is reported and not made up.
std::uint64_t CardServer::Pace::due(std::uint64_t wanted) {
  if (!settings_.real_time) return wanted;
  const double life = duration<double>(Clock::now() - anchor_time_).count();
  const double card = static_cast<double>(engine_.cycles() - anchor_cycle_) / settings_.clock_hz;
  if (life - card > kMaxBehind) {
    if (told_ == Clock::time_point{} || Clock::now() - told_ > kTellAgain) {
      told_ = Clock::now();
      settings_.note(fmt::format("not in real time: the card made {:.2f} s of the last {:.2f} s", card, life));
    }
    anchor();
    return wanted;
  }
  const double clocks = (life - card) * settings_.clock_hz;
  if (clocks < std::min(static_cast<double>(wanted), kLeast * settings_.clock_hz)) return 0;
  return std::min(wanted, static_cast<std::uint64_t>(clocks));
}

void CardServer::Pace::run(std::uint64_t clocks) {
  if (clocks != 0) engine_.wait(std::min(clocks, kPiece));
}

}  // namespace trammel::serve
