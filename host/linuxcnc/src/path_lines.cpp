#include "path_lines.hpp"

#include <chrono>
#include <cstdint>
#include <utility>

#include "path_progress.hpp"
#include "trammel/driver/low_level/requests.hpp"

namespace trammel::linuxcnc {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kPeriod = 1ms;  // time in which LinuxCNC passes on one operation
// Waiting for operations ends after this time (s) and this number of periods of the planner module without one;
// LinuxCNC's task may be late by some. Before the first motion, a module that is itself stalled extends the wait up to
// one second.
constexpr double kBetweenOperations = 0.03;
constexpr std::uint64_t kBetweenPeriods = 30;
constexpr double kLongestStall = 1;
constexpr std::size_t kAhead = 100;  // operations beyond the planner's window before a run begins
// Motion left in the card (s) when the run ends for lack of operations; the rest is planned in this time. The duration
// of a stop, which the card's under-run hold keeps in reserve, is added.
constexpr double kReserve = 0.1;

}  // namespace

bool PathLines::next(std::string_view& line) {
  while (pending_.empty()) {
    if (ended_ || !wait_for_operation()) return false;
    const trammel_operation operation = *server_.queue_.front();
    server_.queue_.pop();
    take(operation);
  }
  given_ = std::move(pending_.front());
  pending_.pop_front();
  ++lines_;
  line = given_;
  return true;
}

// The planner holds back as many blocks as its window has, so a run begins when there are more.
bool PathLines::wait_for_operation() {
  const auto enough = static_cast<std::size_t>(server_.machine_.motion.window) + kAhead;
  while (server_.queue_.size() < (lines_ == 0 ? enough : 1)) {
    if (!may_wait()) break;
    // During this wait, only this call serves the card's watchdog and pending requests.
    driver::serve_requests(server_.card_);
    server_.bus_.sleep(kPeriod);
  }
  return server_.queue_.front() != nullptr;
}

bool PathLines::may_wait() const {
  if (server_.ending_ || server_.queue_.barrier()) return false;
  if (still_come()) return true;
  if (!server_.progress_->any_sent()) return false;
  return server_.progress_->seconds_left() > kReserve + machine::hold_seconds(server_.machine_);
}

// Whether more operations are to be expected. Before anything is sent, a stalled module does not mean that there are
// none.
bool PathLines::still_come() const {
  const double clocks = static_cast<double>(server_.now_.time - server_.last_came_);
  const double since = clocks / server_.card_.identification().clock_hz;
  const bool stalled = server_.beat_ != 0 && server_.beat_ - server_.last_beat_ < kBetweenPeriods;
  return since < (stalled && !server_.progress_->any_sent() ? kLongestStall : kBetweenOperations);
}

// A refused operation ends the run after the operations before it. A probe ends the run too, because LinuxCNC waits for
// its end.
void PathLines::take(const trammel_operation& operation) {
  std::string motion;
  try {
    motion = path_line(operation, from_, server_.machine_);
  } catch (const PathRefusal& refusal) {
    server_.refuse(operation.id, refusal.what());
    ended_ = true;
    return;
  }
  for (std::string& line : output_lines(operation, server_.machine_)) pending_.push_back(std::move(line));
  if (operation.kind == TRAMMEL_SWITCH) return;
  const std::string modes = path_modes(operation, server_.units_);
  if (modes != modes_) pending_.push_back(modes);
  modes_ = modes;
  if (!motion.empty()) pending_.push_back(std::move(motion));
  from_ = end_of(operation);
  server_.under_way_.push_back({lines_ + pending_.size(), operation.segment, operation.id, from_});
  if (is_probe(operation)) {
    server_.probing_ = true;
    ended_ = true;
  }
}

}  // namespace trammel::linuxcnc
