#include "quantiser.hpp"

#include <algorithm>
#include <limits>

#include "s_curve_pieces.hpp"
#include "trapezoid_pieces.hpp"

namespace trammel::planner {
namespace {

constexpr double kShortest = 4 * kUpdate;  // clocks; shorter phases are joined with the next ones

std::unique_ptr<PieceShaper> shaper_of(bool smooth, double clock_hz) {
  if (smooth) return std::make_unique<SCurvePieces>();
  return std::make_unique<TrapezoidPieces>(clock_hz);
}

}  // namespace

Quantiser::Quantiser(PathRing& path, double clock_hz, double stop_clocks, const QueueLimits& queues, bool smooth,
                     const CardLimits& card)
    : path_(path),
      smooth_(smooth),
      classes_(card.classes),
      slew_shifts_(card.slew_shifts),
      full_hz_(card.clock_hz),
      scale_{clock_hz, 0},
      shaper_(shaper_of(smooth, clock_hz)),
      times_(path, clock_hz),
      stops_(path, stop_clocks, queues) {}

void Quantiser::add(const Phase& phase) {
  bool waits = at_.block == 0;
  for (; !moves(path_[at_.block].block); ++at_.block) waits = true;
  if (!at_.moving) {
    begin_run(waits);
  } else if (phase.speed == 0) {
    at_.turns = true;
  }
  const double begin = at_.mm;
  at_.mm += phase.length;
  short_sight_ = phase.short_sight;
  for (; !path_[at_.block].stop && (phase.stop || path_[at_.block].end <= at_.mm); ++at_.block) {
    const PathEntry& block = path_[at_.block];
    if (!block.cut && ++at_.spanned < kMaxBlocks) continue;
    portion(phase, {begin, block.end, block.end_ticks, true, false});
    at_.spanned = 0;
    if (!block.cut) continue;
    at_.base_mm = block.end;
    at_.base_tick = block.end_ticks;
    change_density(path_[at_.block + 1].density);
  }
  const PathEntry& block = path_[at_.block];
  if (phase.stop) {
    portion(phase, {begin, at_.mm, block.end_ticks, true, true});
    at_.moving = false;
    ++at_.block;
  } else {
    portion(phase, {begin, at_.mm, end_tick(phase, block), false, false});
  }
  stops_.complete();
}

// Begins a run, from a stop. The origin of the scale is arbitrary: lengths may continue from any place.
void Quantiser::begin_run(bool waits) {
  const PathEntry& block = path_[at_.block];
  at_.moving = true;
  at_.turns = !waits;
  at_.spanned = 0;
  at_.mm = at_.base_mm = block.begin;
  at_.base_tick = sent_.tick = pending_.end = block.begin_ticks;
  sent_.lead.ticks = 0;
  scale_.ticks_per_clock_at_1_mm_s = block.density / scale_.clock_hz;
  shaper_->start(scale_);
}

// If ticks become longer, those that pass at the old rate put the motion ahead of its speed profile. Its speed still
// follows the profile: the ticks by which the motion is ahead count as done.
void Quantiser::change_density(double density) {
  const double before = scale_.ticks_per_clock_at_1_mm_s;
  scale_.ticks_per_clock_at_1_mm_s = density / scale_.clock_hz;
  const double change = scale_.ticks_per_clock_at_1_mm_s / before;
  sent_.lead.ahead = change < 1 ? std::max(0.0, sent_.lead.ticks - kFeedSwapDelay * sent_.end_rate * change) : 0;
  shaper_->change_density(scale_, sent_.lead.ahead);
}

// The end tick of a phase that ends at at_.mm, in the block or at its beginning.
std::uint64_t Quantiser::end_tick(const Phase& phase, const PathEntry& block) const {
  // A phase that ends with a block ends at the block's tick. The next phase may be for the next block's limits only,
  // and the remainder that rounding leaves after a cut is not a piece.
  constexpr double kSame = 1e-9;  // mm
  const bool corner = shaper_->ends_at_corner(phase);
  std::uint64_t tick = 0;
  if ((corner || block.cut) && block.end - at_.mm < kSame) {
    tick = block.end_ticks;
  } else if ((corner || block.begin == at_.base_mm) && at_.mm - block.begin < kSame) {
    tick = block.begin_ticks;
  } else {
    const double exact = (at_.mm - at_.base_mm) * scale_.ticks_per_clock_at_1_mm_s * scale_.clock_hz;
    tick = at_.base_tick + static_cast<std::uint64_t>(std::max(0.0, shaper_->end_tick(phase, exact)));
  }
  // The tick must be neither before the end of the last piece nor after the block: a block may have more ticks than its
  // length.
  return std::clamp(tick, pending_.end, std::max(pending_.end, block.end_ticks));
}

// Place of a tick, on the present scale.
double Quantiser::millimetres(std::uint64_t tick) const {
  const double ticks =
      tick < at_.base_tick ? -static_cast<double>(at_.base_tick - tick) : static_cast<double>(tick - at_.base_tick);
  return at_.base_mm + ticks / (scale_.ticks_per_clock_at_1_mm_s * scale_.clock_hz);
}

void Quantiser::portion(const Phase& phase, const Portion& portion) {
  if (portion.end_tick > pending_.end && shaper_->drops(pending_)) pending_.end = sent_.tick;
  const PhasePart part = part_of(portion);
  const double late = (part.to - part.end) * scale_.ticks_per_clock_at_1_mm_s * scale_.clock_hz;
  shaper_->advance(phase, part, late);
  if (part.ticks != 0 && shape(phase, portion, part)) return;
  if (pending_.end != sent_.tick) {
    if (portion.last || pending_.motion.clocks >= kShortest) put_pending(portion.stop);
  } else if (portion.stop) {
    stops_.end_at_stop();
  }
}

PhasePart Quantiser::part_of(const Portion& portion) const {
  PhasePart part;
  part.from = millimetres(pending_.end) - portion.phase_begin;
  part.to = millimetres(portion.end_tick) - portion.phase_begin;
  part.end = portion.end - portion.phase_begin;
  part.ticks = portion.end_tick > pending_.end ? portion.end_tick - pending_.end : 0;
  part.stop = portion.stop;
  part.turns = at_.turns;
  part.through = at_.mm - portion.end > 1e-9;  // mm
  return part;
}

// Makes a piece of the part and returns true, or adds the part to the pending phases and returns false.
bool Quantiser::shape(const Phase& phase, const Portion& portion, const PhasePart& part) {
  const auto behind = [&](bool all) {
    const double lead = all ? sent_.lead.within(static_cast<double>(part.ticks)) : 0;
    return shaper_->motion(phase, part, lead, sent_.lead.ahead);
  };
  bool empty = pending_.end == sent_.tick;
  FeedMotion motion = behind(empty);
  const bool whole = motion.clocks >= kShortest || (empty && portion.last);
  if (!empty && (whole || shaper_->keeps_apart(pending_, phase))) {
    put_pending(false);
    empty = true;
    motion = behind(true);
  }
  if (whole) {
    put(motion, portion.end_tick, portion.stop);
    return true;
  }
  pending_.acceleration = phase.acceleration;
  if (empty) pending_.motion.rate = shaper_->pending_rate(phase, part, motion);
  pending_.motion.end_rate = motion.end_rate;
  pending_.motion.clocks = motion.clocks + (empty ? 0 : pending_.motion.clocks);
  pending_.end = portion.end_tick;
  return false;
}

void Quantiser::put_pending(bool stop) {
  const double ticks = static_cast<double>(pending_.end - sent_.tick);
  put(shaper_->joined(pending_, ticks, sent_.lead), pending_.end, stop);
}

void Quantiser::put(const FeedMotion& motion, std::uint64_t end_tick, bool stop) {
  const std::uint64_t ticks = end_tick - sent_.tick;
  const double lead = sent_.lead.within(static_cast<double>(ticks));
  FeedPiece piece = feed_piece(motion, ticks, lead, smooth_);
  piece.block = times_.next_moving();
  piece.begin = sent_.tick;
  piece.stop = stop;
  if (classes_ && path_[piece.block].block.rapid) piece.command.piece_class = driver::PieceClass::kRapid;
  piece.command.slew_shift = slew_shift(piece, end_tick);
  stops_.put(piece);
  times_.add(motion, lead, {sent_.tick, end_tick}, stop, short_sight_);
  sent_ = {end_tick, motion.end_rate, {overshoot(piece.command, motion, lead), 0}};
  pending_.end = end_tick;
}

// The largest slew shift with which a hold from the piece's highest speed takes no more of an axis's acceleration than
// a hold by SLEW takes at hold_speed, in all blocks that the piece runs through.
std::uint8_t Quantiser::slew_shift(const FeedPiece& piece, std::uint64_t end_tick) const {
  if (!slew_shifts_) return 0;
  double most = std::numeric_limits<double>::infinity();
  for (std::uint64_t i = piece.block; i != path_.end() && path_[i].begin_ticks < end_tick; ++i) {
    if (moves(path_[i].block)) most = std::min(most, path_[i].hold_speed * path_[i].density / full_hz_);
  }
  std::uint8_t shift = 0;
  while (shift < driver::kMaxSlewShift && 2 * (piece.highest_rate * (1 << shift)) <= most) ++shift;
  return shift;
}

}  // namespace trammel::planner
