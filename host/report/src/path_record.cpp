#include "path_record.hpp"

namespace trammel::report {
namespace {

enum Kind : unsigned { kLine, kArc, kSpaceArc, kPause };

Kind kind_of(const planner::Block& block) {
  if (!planner::moves(block)) return kPause;
  if (block.geometry == planner::Geometry::kLine) return kLine;
  return block.tilted ? kSpaceArc : kArc;
}

}  // namespace

// After a probe that has ended a motion early, the next one begins elsewhere.
bool PathCoder::goes_on(const planner::Block& block) const { return !end_ || *end_ == block.start; }

void PathCoder::put(const PathRecord& record) {
  const planner::Block& block = record.block;
  const Kind kind = kind_of(block);
  unsigned flags = kind;
  if (block.rapid) flags |= 4U;
  if (block.linear) flags |= 8U;
  if (block.clockwise) flags |= 16U;
  if (record.stop) flags |= 32U;
  flags |= static_cast<unsigned>(record.limit) << 6U;
  constexpr unsigned kElsewhere = 512;
  const bool elsewhere = kind != kPause && !goes_on(block);
  if (elsewhere) flags |= kElsewhere;
  stream_.varint(flags);
  const auto line = static_cast<std::int64_t>(block.line);
  stream_.zigzag(line - line_);
  line_ = line;
  if (kind == kPause) {
    stream_.number(block.geometry == planner::Geometry::kDwell ? block.dwell_seconds : 0.0);
    return;
  }
  for (std::size_t a = 0; elsewhere && a < axes_; ++a) stream_.zigzag(block.start[a] - (*end_)[a]);
  end_ = block.end;
  stream_.varint(record.step_clocks);
  for (std::size_t a = 0; a < axes_; ++a) stream_.zigzag(block.end[a] - block.start[a]);
  stream_.varint(record.ticks);
  stream_.number(block.length);
  stream_.number(static_cast<float>(block.wanted));
  stream_.number(static_cast<float>(record.speed));
  if (kind != kLine) put_arc(block);
}

void PathCoder::put_arc(const planner::Block& block) {
  if (!block.tilted) {
    stream_.varint(block.axis_x);
    stream_.varint(block.axis_y);
    stream_.number(block.exact.centre_x);
    stream_.number(block.exact.centre_y);
    stream_.number(block.exact.sweep);
    return;
  }
  for (const std::uint8_t axis : block.space.axes) stream_.varint(axis);
  for (const double x : block.space.centre) stream_.number(x);
  for (const double x : block.space.first) stream_.number(x);
  for (const double x : block.space.second) stream_.number(x);
  stream_.number(block.space.radius);
  stream_.number(block.exact.sweep);
}

}  // namespace trammel::report
