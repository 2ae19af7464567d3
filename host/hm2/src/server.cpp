#include "trammel/hm2/server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace trammel::hm2 {
namespace {

using namespace std::chrono_literals;

// The longest sleep, and so the longest delay until a signal is noticed.
constexpr auto kSleep = 50ms;
// A driver that is silent for this time is considered gone, and another one may connect. Far longer than the time of
// any watchdog.
constexpr auto kSilence = 1s;
// After a bite nothing moves, and a restarted driver should be accepted soon.
constexpr auto kSilenceBitten = 100ms;
// A longer delay is not made up for by running faster than real time.
constexpr double kMaxBehind = 0.5;  // s

}  // namespace

Server::Server(Hostmot2& hostmot2, Board& board, UdpPort& port, Settings settings)
    : hostmot2_(hostmot2),
      board_(board),
      port_(port),
      settings_(std::move(settings)),
      random_(settings_.seed),
      anchor_time_(Clock::now()),
      anchor_clock_(hostmot2.now()) {}

// The card's clock at `time`. Time that the card cannot make up for is left out.
std::uint64_t Server::clock_at(Clock::time_point time) {
  const double life = std::chrono::duration<double>(time - anchor_time_).count();
  const double behind = life - static_cast<double>(hostmot2_.now() - anchor_clock_) / settings_.clock_hz;
  if (behind > kMaxBehind) {
    settings_.note(fmt::format("not in real time: the card is {:.2f} s late, which is left out", behind));
    counts_.lost_seconds += behind;
    anchor_time_ = time;
    anchor_clock_ = hostmot2_.now();
    return anchor_clock_;
  }
  return anchor_clock_ + static_cast<std::uint64_t>(std::max(life, 0.0) * settings_.clock_hz);
}

Server::Clock::time_point Server::time_of(std::uint64_t clock) const {
  const std::chrono::duration<double> life(static_cast<double>(clock - anchor_clock_) / settings_.clock_hz);
  return anchor_time_ + std::chrono::ceil<Clock::duration>(life);
}

void Server::run_to(Clock::time_point time) { hostmot2_.run_to(clock_at(time)); }

void Server::turn() {
  auto until = Clock::now() + kSleep;
  const std::uint64_t due = hostmot2_.next_due();
  if (due != StepGenerators::kNever) until = std::min(until, time_of(std::max(due, anchor_clock_)));
  port_.wait(until);
  static thread_local Datagram datagram;
  while (port_.receive(datagram)) serve(datagram);
  const auto now = Clock::now();
  run_to(now);
  look_for_silence(now);
}

void Server::serve(const Datagram& datagram) {
  run_to(datagram.came);
  // The gap is the driver's own: kernel time stamps do not depend on delays of this process.
  if (last_driver_ == datagram.from) {
    counts_.longest_gap = std::max<std::chrono::nanoseconds>(counts_.longest_gap, datagram.came - heard_);
  }
  look_for_silence(datagram.came);
  if (!admit(datagram) || loses()) return;
  heard_ = std::max(heard_, datagram.came);
  const Bytes& answer = board_.answer(datagram.bytes.data(), datagram.size);
  if (answer.empty() || loses()) return;
  port_.send(answer, datagram.from);
  counts_.longest_answer = std::max<std::chrono::nanoseconds>(counts_.longest_answer, Clock::now() - datagram.came);
}

// The first sender is the driver, until it falls silent.
bool Server::admit(const Datagram& datagram) {
  if (driver_ && !(*driver_ == datagram.from)) {
    if (counts_.strangers++ == 0) {
      settings_.note(fmt::format("{} is not heard: {} drives", datagram.from.text(), driver_->text()));
    }
    return false;
  }
  if (!driver_) {
    driver_ = last_driver_ = datagram.from;
    heard_ = datagram.came;
    ++counts_.drivers;
    settings_.note(fmt::format("driver {} has come", driver_->text()));
  }
  return true;
}

// Datagrams are lost only after the first motion: a driver that is being loaded does not repeat its requests.
bool Server::loses() {
  if (settings_.lose_percent == 0 || hostmot2_.steps().counts().streams == 0) return false;
  const bool lost = std::uniform_real_distribution<double>(0, 100)(random_) < settings_.lose_percent;
  if (lost) ++counts_.lost;
  return lost;
}

// Ends the motion of a silent driver even if the watchdog is off.
void Server::look_for_silence(Clock::time_point now) {
  if (!driver_ || now - heard_ < (hostmot2_.bitten() ? kSilenceBitten : kSilence)) return;
  if (hostmot2_.moves()) hostmot2_.bite("the driver has fallen silent");
  settings_.note(fmt::format("driver {} has gone", driver_->text()));
  driver_.reset();
}

}  // namespace trammel::hm2
