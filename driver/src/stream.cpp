#include "trammel/driver/stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "card_identity.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/feed_time.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "wait_budget.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;

// Largest number of words written at once.
constexpr std::size_t kKeptWords = 512;
static_assert(kKeptWords >= kMaxCommandWords);
constexpr std::size_t kShortestCommandWords = 3;
constexpr std::size_t kShortestQueued = 4;  // halfwords; a barrier
// Number of commands that have left the queue, but may not have begun or ended yet.
constexpr std::size_t kBeyondQueue = 4;
constexpr unsigned kMapMinorOfSilence = 2;  // silent pieces came with map 3.2

void require_engine(const Identification& card, std::uint32_t engine, std::string_view command) {
  if (!map::has_engine(card.engines, engine)) {
    throw ArgumentError(fmt::format("stream: {} needs {}, which the card does not have (engines 0x{:X})", command,
                                    map::kEngineNames[engine], card.engines));
  }
}

// Refused because the card would run to the piece's end at its floor.
void refuse_reversal(const FeedCommand& feed, std::string_view command) {
  if (const auto ticks = ticks_to_reversal(feed)) {
    throw ArgumentError(fmt::format("stream: {}: acceleration and jerk would reverse the feed after {:.0f} of {} ticks",
                                    command, *ticks, feed.ticks));
  }
}

}  // namespace

// One wait for the card.
class Stream::Wait {
 public:
  Wait(Stream& stream, const char* context) : stream_(stream), budget_(*stream.card_, context, stream.margin_clocks_) {
    allow();
  }

  // Restarts the planned time: that of the piece or barrier that began last, and of the one that is about to begin.
  void allow() {
    const Count& feed = stream_.feed_;
    PlannedTime planned;
    std::size_t part = 0;
    for (std::uint64_t number = feed.begun - (feed.begun != 0 ? 1 : 0); number < feed.sent && number <= feed.begun;
         ++number) {
      const Duration& duration = stream_.durations_[stream_.slot(number)];
      planned.parts[part++] = {duration.gated, duration.piece_class};
      planned.real += duration.real;
    }
    budget_.allow(planned);
  }
  // `wake`: as for WaitBudget::pause().
  void pause(const Status& status, std::uint32_t wake) { budget_.pause(status, stream_.poll_clocks_, wake); }

  // Throws StateError when the card was idle at two successive polls although it has not begun all commands.
  void idle(bool without_reason) {
    idle_looks_ = without_reason ? idle_looks_ + 1 : 0;
    if (idle_looks_ < 2) return;
    check_identity(stream_.card_->parts());
    throw StateError(
        fmt::format("stream: the card is idle, but of {} geometry and {} feed commands it has begun {} and "
                    "{}: it was reset, or aborted by somebody else",
                    stream_.geometry_.sent, stream_.feed_.sent, stream_.geometry_.begun, stream_.feed_.begun));
  }

 private:
  Stream& stream_;
  WaitBudget budget_;
  int idle_looks_ = 0;
};

// The stream stays open after a fault, because the card itself then refuses commands, and after a time-out, because the
// card may still finish.
template <class Call>
auto Stream::closing_at_errors(Call call) {
  try {
    return call();
  } catch (const FaultError&) {
    used_ = kept_ = 0;
    throw;
  } catch (const TimeoutError&) {
    throw;
  } catch (const Error&) {
    broken_ = true;
    used_ = kept_ = 0;
    throw;
  }
}

Stream::Stream(Card& card, StreamOptions options)
    : card_(&card),
      options_(std::move(options)),
      margin_clocks_(clocks_of(options_.margin, card.timing().clock_hz, "stream: margin")),
      poll_clocks_(options_.poll_clocks != 0 ? options_.poll_clocks : poll_interval(card.timing().clock_hz)),
      accesses_(kKeptWords + 1),
      durations_(card.identification().feed_depth / kShortestQueued + kKeptWords / kShortestCommandWords +
                 kBeyondQueue) {
  if (margin_clocks_ == 0) {
    throw ArgumentError("stream: a margin of 0 ns");
  }
  const Status status = card.read_status();
  card.parts().registers.throw_if_faulted(status, "stream");
  if (!options_.opens_in_hold && !card.parts().time_base.holds_by_this_program()) {
    card.parts().time_base.throw_if_held("stream");
  };
  if (status.busy) {
    throw StateError("stream: the card is busy; wait until it is idle, or abort it, before opening the stream");
  }
  reset();
}

void Stream::restart() {
  card_->parts().registers.throw_if_faulted(card_->read_status(), "stream");
  reset();
}

void Stream::reset() {
  card_->abort();
  card_->clear_refusal();
  room_ = {};
  used_ = kept_ = 0;
  sent_ = 0;
  geometry_ = {};
  feed_ = {};
  last_is_end_ = false;
  broken_ = false;
}

void Stream::put(const Command& command) {
  require_open();
  std::array<std::uint32_t, kMaxCommandWords> words{};
  const std::size_t count = encode(command, next_number(), words.data());
  const Need need = checked_need(command, words[0]);
  if (used_ + count > kKeptWords || !has_room(need)) {
    flush();
    if (!has_room(need)) closing_at_errors([&] { wait_for_room(need); });
  }
  keep(command, need, words.data(), count);
}

void Stream::flush() {
  require_open();
  if (used_ != 0) closing_at_errors([this] { write_kept(); });
}

void Stream::send(const Command& command) {
  put(command);
  flush();
}

void Stream::send(const std::vector<Command>& commands) {
  require_open();
  std::array<std::uint32_t, kMaxCommandWords> words{};
  for (const Command& command : commands) {
    encode(command, 0, words.data());
    checked_need(command, words[0]);
  }
  for (const Command& command : commands) put(command);
  flush();
}

// Checks the properties that depend on the card; encode() has checked the ranges.
Stream::Need Stream::checked_need(const Command& command, std::uint32_t header) {
  const Identification& card = card_->identification();
  const map::Command& layout = layout_of(command);
  const auto mask = static_cast<std::uint8_t>(header >> 8);
  require_engine(card, layout.engine, layout.name);
  if (!layout.built) throw ArgumentError(fmt::format("stream: {}: no card has this command yet", layout.name));
  const auto* arc = std::get_if<ArcCommand>(&command);
  if (arc != nullptr && arc->eight_directions) require_engine(card, map::engine::kAccumulator8, layout.name);
  const auto* feed = std::get_if<FeedCommand>(&command);
  if (feed != nullptr && feed->jerk != 0) {
    require_engine(card, map::engine::kJerk, layout.name);
    refuse_reversal(*feed, layout.name);
  }
  if (feed != nullptr && feed->piece_class != PieceClass::kFeed) {
    require_engine(card, map::engine::kClasses, layout.name);
  }
  if (feed != nullptr && feed->silent && card.map_minor < kMapMinorOfSilence) {
    throw ArgumentError(fmt::format("stream: {}: the card's map {}.{} has no silent pieces; they came with {}.{}",
                                    layout.name, card.map_major, card.map_minor, card.map_major, kMapMinorOfSilence));
  }
  if (feed == nullptr && mask >> card.axes != 0) {
    throw ArgumentError(fmt::format("stream: axis mask 0x{:02X}, but the card has {} axes", mask, card.axes));
  }
  check_input(command);
  const std::uint32_t halfwords = map::queue_halfwords(layout, mask);
  return {layout.to_geometry ? halfwords : 0, layout.to_feed ? halfwords : 0};
}

// Refuses inputs that the card lacks: they read 0, so a wait for one might never end.
void Stream::check_input(const Command& command) {
  const auto* wait = std::get_if<WaitInputCommand>(&command);
  const auto* probe = std::get_if<ProbeCommand>(&command);
  if (wait == nullptr && probe == nullptr) return;
  if (!inputs_) inputs_ = card_->inputs_present();
  const unsigned input = wait != nullptr ? wait->input : probe->input;
  if (input >= *inputs_) {
    throw ArgumentError(
        fmt::format("stream: {}: input {}, but the card has {} inputs", layout_of(command).name, input, *inputs_));
  }
}

void Stream::keep(const Command& command, const Need& need, const std::uint32_t* words, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) accesses_[used_ + i] = write_of(reg::kStream, words[i]);
  used_ += count;
  ++kept_;
  room_.geometry -= need.geometry;
  room_.feed -= need.feed;
  if (need.geometry != 0 && counts_as_begun(command)) ++geometry_.put;
  if (need.feed != 0) {
    Duration duration;
    if (const auto* feed = std::get_if<FeedCommand>(&command)) {
      duration.piece_class = feed->piece_class;
      constexpr double kLongest = 4e18;  // limit, so that 64 bits suffice
      duration.gated = static_cast<std::uint64_t>(std::min(feed_clocks(*feed), kLongest)) + 1;
    } else if (const auto* dwell = std::get_if<DwellCommand>(&command)) {
      duration.real = dwell->clocks;
    }
    durations_[slot(feed_.put++)] = duration;
  }
  last_is_end_ = std::holds_alternative<EndCommand>(command);
}

void Stream::write_kept() {
  const std::size_t count = std::exchange(used_, 0);
  const std::size_t commands = std::exchange(kept_, 0);
  card_->parts().registers.transfer_stream(accesses_.data(), count);
  card_->parts().watchdog.look();
  sent_ += commands;
  geometry_.sent = geometry_.put;
  feed_.sent = feed_.put;
}

void Stream::wait_for_room(const Need& need) {
  Wait wait(*this, "stream: waiting for room in the card's queues");
  for (;;) {
    refresh_room(need);
    if (has_room(need)) {
      return;
    }
    const Status status = look(wait);
    wait.idle(!status.busy && !all_begun());
    wait.pause(status, wake_for(need));
  }
}

// The wake condition: room in the queues that lack it.
std::uint32_t Stream::wake_for(const Need& need) const {
  if (!card_->parts().interrupt.tells_of_room()) return 0;
  return card_->parts().interrupt.wake_at_room(need.geometry > room_.geometry ? need.geometry : 0,
                                               need.feed > room_.feed ? need.feed : 0);
}

void Stream::refresh_room(const Need& need) {
  std::array<Access, 3> accesses;
  std::size_t count = 0;
  if (need.geometry > room_.geometry) accesses[count++] = read_of(reg::kGeometryRoom);
  if (need.feed > room_.feed) accesses[count++] = read_of(reg::kFeedRoom);
  card_->parts().registers.transfer(accesses.data(), count, "stream");
  const Identification& card = card_->identification();
  for (std::size_t i = 0; i < count; ++i) {
    const bool geometry = accesses[i].address == reg::kGeometryRoom;
    if (accesses[i].data > (geometry ? card.geometry_depth : card.feed_depth)) {
      throw LinkError(fmt::format("stream: a {} queue with room for {} halfwords: what answers is no card",
                                  geometry ? "geometry" : "feed", accesses[i].data));
    }
    (geometry ? room_.geometry : room_.feed) = accesses[i].data;
  }
}

Status Stream::finish() {
  flush();
  return closing_at_errors([this] {
    Wait wait(*this, "stream: waiting for the end");
    // The first poll also comes after a pause, because a command takes some clocks from the port to the queue.
    Status status;
    for (;;) {
      wait.pause(status, WaitBudget::kIdle);
      status = look(wait);
      if (!status.busy && all_begun() && (status.ended || !last_is_end_)) {
        check_identity(card_->parts());
        return status;
      }
      wait.idle(!status.busy && !all_begun());
    }
  });
}

void Stream::check_probing(const ProbeCommand& condition, const std::vector<Command>& paths) {
  std::array<std::uint32_t, kMaxCommandWords> words{};
  encode(condition, 0, words.data());
  checked_need(condition, words[0]);
  if (paths.empty()) throw ArgumentError("probe: no paths to move along");
  for (const Command& command : paths) {
    const bool ends = std::holds_alternative<ProbeCommand>(command) ||
                      std::holds_alternative<ProbeEndCommand>(command) || std::holds_alternative<EndCommand>(command);
    if (ends) throw ArgumentError(fmt::format("probe: {} among the paths", layout_of(command).name));
    encode(command, 0, words.data());
    checked_need(command, words[0]);
  }
}

// Waits until the edge has come, or all is done without one.
Status Stream::wait_for_probe() {
  Wait wait(*this, "probe: waiting for the edge or the end of the paths");
  Status status;
  for (;;) {
    wait.pause(status, WaitBudget::kIdle | WaitBudget::kProbed);
    status = look(wait);
    if (status.probed || (!status.busy && all_begun())) return status;
    wait.idle(!status.busy && !all_begun());
  }
}

ProbeResult Stream::probe(const ProbeCommand& condition, const std::vector<Command>& paths) {
  require_open();
  check_probing(condition, paths);
  finish();
  const auto begun = static_cast<std::uint32_t>(geometry_.begun);
  closing_at_errors([this] { card_->clear_probe(); });
  put(condition);
  for (const Command& command : paths) put(command);
  put(ProbeEndCommand{});
  flush();
  return closing_at_errors([&] {
    ProbeResult result;
    const Status status = wait_for_probe();
    if (status.probed) {
      result.edge = card_->read_probe_snapshot();
      result.outcome = result.edge.geometry_begun == begun ? ProbeOutcome::kTrippedAlready : ProbeOutcome::kTripped;
      card_->clear_probe();
      finish();
    } else if (!status.probe_missed) {
      throw StateError("probe: it is over without an edge and without a miss: somebody else has cleared it");
    }
    result.rest = card_->read_snapshot();
    return result;
  });
}

Status Stream::look(Wait& wait) {
  std::array<Access, 4> accesses{read_of(reg::kStatus), read_of(reg::kGeometryBegun), read_of(reg::kFeedBegun)};
  card_->parts().registers.transfer(accesses.data(), 3, "stream");
  const Status status = card_->parts().registers.status_of(accesses[0]);
  card_->parts().registers.throw_if_faulted(status, "stream");
  if (status.refused) {
    if (const auto refusal = card_->refusal()) {
      card_->parts().registers.throw_refused(*refusal, "stream");
    }
  }
  const std::uint64_t begun_before = geometry_.begun + feed_.begun;
  advance(geometry_, accesses[1].data);
  advance(feed_, accesses[2].data);
  if (geometry_.begun + feed_.begun != begun_before) wait.allow();
  if (options_.progress) {
    StreamProgress progress;
    progress.commands_sent = sent_;
    progress.status = status;
    progress.geometry_begun = accesses[1].data;
    progress.feed_begun = accesses[2].data;
    options_.progress(progress);
  }
  serve_requests(*card_);
  return status;
}

// The card's counters have 32 bits, and start at 0 when the stream is opened.
void Stream::advance(Count& count, std::uint32_t begun) const {
  const std::uint64_t now = count_after(count.begun, begun);
  if (now > count.sent) {
    check_identity(card_->parts());
    // A fault after the read of STATUS may have reset the counter.
    card_->parts().registers.throw_if_faulted(card_->read_status(), "stream");
    throw StateError(
        fmt::format("stream: the card says that it has begun {} commands of a queue, where {} were sent and "
                    "{} had begun: it was reset, or aborted by somebody else",
                    begun, count.sent, count.begun));
  }
  count.begun = now;
}

void Stream::require_open() const {
  if (broken_) {
    throw StateError("stream: closed by an error; restart it");
  }
}

}  // namespace trammel::driver
