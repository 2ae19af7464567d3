// Adaptors of the blocks between the host and the motion core: host port, registers, checker, queues, loader. See
// horizon.hpp.
#pragma once

#include "trammel/model/axi4_lite_port.hpp"
#include "trammel/model/command_checker.hpp"
#include "trammel/model/command_fetch.hpp"
#include "trammel/model/direct_loader.hpp"
#include "trammel/model/halfword_queue.hpp"
#include "trammel/model/queue_watermarks.hpp"
#include "trammel/model/register_file.hpp"
#include "trammel/skip/horizon.hpp"

namespace trammel::skip {

inline std::uint64_t horizon(const model::Axi4LitePort& port, const model::Axi4LitePort::Inputs& in) {
  const model::Axi4LitePort::Outputs& out = port.outputs();
  const bool handshakes = out.request || out.awready || out.arready;
  const bool waits = (in.awvalid && in.wvalid) || in.arvalid;
  const bool leaves = (out.bvalid && in.bready) || (out.rvalid && in.rready);
  return forever_if(!handshakes && !waits && !leaves && !(port.state().busy && in.ack));
}
inline void advance(model::Axi4LitePort&, const model::Axi4LitePort::Inputs&, std::uint64_t) {}

// The units of LINK_TIMEOUT that pass in `clocks` clocks from `time` on.
inline std::uint64_t link_units(std::uint64_t time, std::uint64_t clocks) {
  // A unit at time t shows when (t - 2) is a multiple of a unit.
  return ((time + clocks - 3) >> model::LinkWatch::kUnitBits) - ((time - 3) >> model::LinkWatch::kUnitBits);
}
// Clocks before the one in which the link is lost.
inline std::uint64_t horizon(const model::LinkWatch& link, std::uint64_t time) {
  if (!link.watches()) return kForever;
  const std::uint64_t units = ((time - 3) >> model::LinkWatch::kUnitBits) + 1 + link.state().left;
  return (units << model::LinkWatch::kUnitBits) + 2 - time;
}
inline void advance(model::LinkWatch& link, std::uint64_t time, std::uint64_t clocks) {
  if (link.watches()) link.state().left -= static_cast<std::uint32_t>(link_units(time, clocks));
}

// Within the horizon only the time advances.
inline std::uint64_t horizon(const model::RegisterFile& registers, const model::RegisterFile::Inputs& in) {
  const model::RegisterFile::State& s = registers.state();
  const model::RegisterFile::Outputs& out = s.out;
  if (s.stage != model::RegisterFile::Stage::Idle || in.request || in.checker_refuse || in.stop || in.rest ||
      in.probe || in.mark || in.captures != 0 || in.passed != 0 || !s.queue.rests())
    return 0;
  const bool events = out.ack || out.setting.set || out.stream_write || out.abort || out.probe_clear || out.flush ||
                      out.start || out.strobe || out.clear_fault != 0 || s.snapshot_asked;
  const bool loads = s.loading || s.loader_read.valid || out.loader_valid;
  if (events || loads || s.snapshot.busy() || s.snapshot.waits() || out.irq != registers.interrupt(in)) return 0;
  const std::uint32_t read = s.stored[in.loader_address];
  if (s.loader_read.data != read || out.loader_data != read) return 0;
  return horizon(s.link, s.time);
}
inline void advance(model::RegisterFile& registers, const model::RegisterFile::Inputs&, std::uint64_t clocks) {
  advance(registers.state().link, registers.state().time, clocks);
  registers.state().time += clocks;
}

inline std::uint64_t horizon(const model::CommandChecker& checker, const model::CommandChecker::Inputs& in) {
  const model::CommandChecker::Outputs& o = checker.outputs();
  const bool asked = in.reset || in.write || in.flush || in.clear;
  return forever_if(!asked && o.ready && !o.geometry_write && !o.feed_write && !o.geometry_commit && !o.feed_commit &&
                    !o.drop && !o.refuse);
}
inline void advance(model::CommandChecker&, const model::CommandChecker::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::HalfwordQueue& queue, const model::HalfwordQueue::Inputs& in) {
  const model::HalfwordQueue::State& s = queue.state();
  const bool asked = in.reset || in.clear || in.write || in.commit || in.drop || (in.read && !s.outputs.empty);
  return forever_if(!asked && s.outputs.word == s.fetched && s.outputs.empty == (s.committed == 0) &&
                    s.outputs.room == queue.free());
}
inline void advance(model::HalfwordQueue&, const model::HalfwordQueue::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::QueueWatermarks& marks, const model::QueueWatermarks::Inputs& in) {
  const model::QueueWatermarks::State& s = marks.state();
  return forever_if(!in.setting.set && s.outputs == s.next && s.next == marks.judged(in));
}
inline void advance(model::QueueWatermarks&, const model::QueueWatermarks::Inputs&, std::uint64_t) {}

inline std::uint64_t horizon(const model::DirectLoader& loader, const model::DirectLoader::Inputs& in) {
  const model::DirectLoader::State& s = loader.state();
  const bool idle = s.phase == model::DirectLoader::Phase::Idle && !s.moving && !s.taken.valid;
  return forever_if(idle && !s.out.done && !s.out.load.valid && !in.start && !in.reset);
}
inline void advance(model::DirectLoader&, const model::DirectLoader::Inputs&, std::uint64_t) {}

}  // namespace trammel::skip
