#include "trammel/run/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "trammel/card_map.hpp"
#include "trammel/driver/feed_time.hpp"
#include "trammel/driver/wide.hpp"

namespace trammel::run {
namespace {

using driver::FeedCommand;
using driver::Int128;
using driver::Uint128;

constexpr std::uint64_t kUpdateClocks = card_map::constant::kUpdateClocks;
constexpr std::uint64_t kEveryClock = std::numeric_limits<std::uint64_t>::max();  // rate, 2^-64 ticks per clock

// Simulates the feed generator from a piece's first enabled clock on, one update per step. Rates in 2^-64 ticks per
// clock.
class Generator {
 public:
  explicit Generator(const FeedCommand& piece)
      : floor_(std::uint64_t{piece.floor} << 32),
        rate_(Uint128(piece.rate)),
        acceleration_(piece.acceleration),
        jerk_(piece.jerk),
        in_use_(piece.rate) {}

  // Advances to the update in which the total reaches `ticks`, which is less than the ticks of the piece.
  void go_to(std::uint64_t ticks) {
    const Uint128 wanted(ticks, 0);
    while (given_ < wanted) {
      const Uint128 update = Uint128::product(in_use_, kUpdateClocks);
      if (given_ + update >= wanted || constant()) return;
      given_ = given_ + update;
      step();
    }
  }
  // Ticks of the current update after the first `ticks` of the piece.
  std::uint64_t more_than(std::uint64_t ticks) const {
    return (given_ + Uint128::product(in_use_, kUpdateClocks)).high() - ticks;
  }
  bool constant() const { return away_ || (acceleration_ == Int128(0) && jerk_ == Int128(0)); }
  void step() {
    rate_ = rate_ + acceleration_;
    acceleration_ = acceleration_ + jerk_;
    away_ = rate_.high() < -2 || rate_.high() >= 2;
    in_use_ = at_floor() ? floor_ : rate_.high() > 0 ? kEveryClock : rate_.low();
  }
  bool at_floor() const { return rate_.high() < 0 || (rate_.high() == 0 && rate_.low() < floor_); }
  std::uint64_t in_use() const { return in_use_; }
  Int128 acceleration() const { return acceleration_; }

 private:
  std::uint64_t floor_;
  Int128 rate_;
  Int128 acceleration_;
  Int128 jerk_;
  std::uint64_t in_use_;
  Uint128 given_;  // 2^-64 ticks
  bool away_ = false;
};

// Clamps the value to the width of its field; larger values occur only if the rate will be clamped anyway.
std::int64_t fitted(Int128 value) {
  if (value.high() != (static_cast<std::int64_t>(value.low()) < 0 ? -1 : 0)) {
    return value.high() < 0 ? std::numeric_limits<std::int64_t>::min() : std::numeric_limits<std::int64_t>::max();
  }
  return static_cast<std::int64_t>(value);
}

// Corrects a rest that would reverse before its end, as the rest of a rounded stop may.
void make_end(FeedCommand& rest, bool at_floor) {
  const bool falls = rest.acceleration <= 0 && rest.jerk <= 0;
  if (at_floor && falls) {
    rest.acceleration = rest.jerk = 0;
  } else if (driver::ticks_to_reversal(rest)) {
    // From v to 0 over n ticks: v^2 / 2n per clock.
    const double rate = static_cast<double>(rest.rate) * 0x1p-64;
    const double slope = kUpdateClocks * rate * rate / 2 / static_cast<double>(rest.ticks);
    rest.acceleration = -static_cast<std::int64_t>(slope * 0x1p64);
    rest.jerk = 0;
  }
}

std::uint64_t ticks_of(const driver::Command& command) {
  if (const auto* line = std::get_if<driver::LineCommand>(&command)) return line->ticks;
  if (const auto* arc = std::get_if<driver::ArcCommand>(&command)) return arc->ticks;
  if (const auto* arc = std::get_if<driver::ArcChordCommand>(&command)) return arc->ticks;
  return 0;
}

}  // namespace

std::vector<FeedCommand> rest_of(const FeedCommand& piece, std::uint64_t gone) {
  if (gone == 0) return {piece};
  Generator generator(piece);
  generator.go_to(gone);
  FeedCommand rest = piece;
  rest.ticks -= gone;
  if (generator.constant()) {
    rest.rate = generator.in_use();
    rest.acceleration = rest.jerk = 0;
    return {rest};
  }
  FeedCommand update = rest;
  update.ticks = std::min(generator.more_than(gone), rest.ticks);
  update.rate = generator.in_use();
  update.acceleration = update.jerk = 0;
  rest.ticks -= update.ticks;
  if (rest.ticks == 0) return {update};
  generator.step();
  rest.rate = generator.in_use();
  rest.acceleration = fitted(generator.acceleration());
  make_end(rest, generator.at_floor());
  if (update.ticks == 0) return {rest};
  return {update, rest};
}

void Replay::here() {
  if (!place_) place_ = PathPlace{geometry_};
}

void Replay::put(const driver::Command& command) {
  if (begun_) return next_.put(command);
  if (std::holds_alternative<driver::ProbeCommand>(command)) {
    throw ReplayError("a probe comes before the place: where it ended is not known");
  }
  if (const auto* feed = std::get_if<FeedCommand>(&command)) {
    pieces_.push_back({piece_ticks_, *feed});
    piece_ticks_ += feed->ticks;
  } else if (const auto* outputs = std::get_if<driver::OutputCommand>(&command)) {
    outputs_.clear = static_cast<std::uint16_t>((outputs_.clear & ~outputs->set) | (outputs->clear & ~outputs->set));
    outputs_.set = static_cast<std::uint16_t>((outputs_.set & ~outputs_.clear) | outputs->set);
  } else if (const auto* pulses = std::get_if<driver::PwmCommand>(&command)) {
    pulses_ = *pulses;
  } else if (driver::counts_as_begun(command)) {
    geometry(command);
  }
}

void Replay::geometry(const driver::Command& command) {
  const std::uint64_t ticks = ticks_of(command);
  if (place_ && place_->command == geometry_) {
    const std::uint64_t left = place_->ticks_left;
    if (left == PathPlace::kAllTicks || ticks == 0) return begin(command);
    if (left > ticks) {
      throw ReplayError(fmt::format("command {} of the path has {} ticks, but {} are left", geometry_, ticks, left));
    }
    done_ = ticks - left;
    if (left != 0) return begin(command);
    done_ = 0;
    place_ = PathPlace{geometry_ + 1};
  }
  ++geometry_;
  path_ticks_ += ticks;
  while (!pieces_.empty() && pieces_.front().begin + pieces_.front().feed.ticks <= path_ticks_) pieces_.pop_front();
}

void Replay::begin(const driver::Command& command) {
  begun_ = true;
  if ((outputs_.set | outputs_.clear) != 0) next_.put(outputs_);
  if (pulses_) next_.put(*pulses_);
  put_pieces(path_ticks_ + done_);
  next_.put(command);
}

void Replay::put_pieces(std::uint64_t from) {
  while (!pieces_.empty() && pieces_.front().begin + pieces_.front().feed.ticks <= from) pieces_.pop_front();
  if (done_ != 0) {
    FeedCommand silence;
    silence.ticks = done_;
    silence.rate = kEveryClock;
    silence.silent = true;
    next_.put(silence);
  }
  for (const Piece& piece : pieces_) {
    const std::uint64_t gone = piece.begin < from ? from - piece.begin : 0;
    for (const FeedCommand& rest : rest_of(piece.feed, gone)) next_.put(rest);
  }
  pieces_.clear();
}

}  // namespace trammel::run
