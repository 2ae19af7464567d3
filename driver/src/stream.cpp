#include "trammel/driver/stream.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;

void require_engine(const Identification& card, std::uint32_t engine, std::string_view command) {
  if (!map::has_engine(card.engines, engine)) {
    throw ArgumentError(fmt::format("stream: {} needs {}, which the card does not have (engines 0x{:X})", command,
                                    map::kEngineNames[engine], card.engines));
  }
}

// What of a command depends on the card; its layout is checked by encode().
void check_for_card(const Identification& card, const Command& command, const map::Command& layout) {
  require_engine(card, layout.engine, layout.name);
  if (const auto* feed = std::get_if<FeedCommand>(&command); feed != nullptr && feed->jerk != 0) {
    require_engine(card, map::engine::kJerk, layout.name);
  }
}

}  // namespace

Stream::Stream(Card& card, StreamOptions options)
    : card_(&card),
      options_(std::move(options)),
      stall_clocks_(card.clocks(options_.stall_timeout, "stream: stall timeout")),
      poll_clocks_(options_.poll_clocks != 0 ? options_.poll_clocks : card.poll_interval()) {
  if (stall_clocks_ == 0) {
    throw ArgumentError("stream: a stall timeout of 0 ns");
  }
  const Status status = card.status();
  card.throw_if_faulted(status, "stream");
  if (status.busy) {
    throw StateError("stream: the card is busy; wait until it is idle, or abort it, before opening the stream");
  }
  reset();
}

void Stream::restart() {
  card_->throw_if_faulted(card_->status(), "stream");
  reset();
}

void Stream::reset() {
  card_->abort();
  card_->clear_refusal();
  room_ = {};
  sent_ = 0;
  last_is_end_ = false;
  broken_ = false;
}

void Stream::send(const Command& command) { send(&command, 1); }

void Stream::send(const std::vector<Command>& commands) { send(commands.data(), commands.size()); }

void Stream::send(const Command* commands, std::size_t count) {
  require_open();
  std::vector<std::uint32_t> words;
  std::vector<Encoded> encoded;
  encoded.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    encoded.push_back(encode_checked(commands[i], static_cast<std::uint8_t>(sent_ + i), words));
  }
  const Encoded* next = encoded.data();
  const Encoded* const end = next + encoded.size();
  while (next != end) {
    wait_for_room(next->need);
    const Encoded* last = next;
    for (; last != end && has_room(last->need); ++last) {
      room_.geometry -= last->need.geometry;
      room_.feed -= last->need.feed;
    }
    write(words, next, last);
    next = last;
  }
}

Stream::Encoded Stream::encode_checked(const Command& command, std::uint8_t number,
                                       std::vector<std::uint32_t>& words) const {
  const Identification& card = card_->identification();
  Encoded encoded;
  encoded.begin = words.size();
  encode(command, number, words);
  encoded.end = words.size();
  encoded.is_end = std::holds_alternative<EndCommand>(command);
  const std::uint32_t header = words[encoded.begin];
  const auto mask = static_cast<std::uint8_t>(header >> 8);
  const map::Command& layout = *map::find_command(static_cast<std::uint8_t>(header));
  check_for_card(card, command, layout);
  if (mask >> card.axes != 0) {
    throw ArgumentError(fmt::format("stream: axis mask 0x{:02X}, but the card has {} axes", mask, card.axes));
  }
  const std::uint32_t halfwords = map::queue_halfwords(layout, mask);
  encoded.need = {layout.to_geometry ? halfwords : 0, layout.to_feed ? halfwords : 0};
  return encoded;
}

void Stream::wait_for_room(const Need& need) {
  Watch watch;
  while (!has_room(need)) {
    refresh_room(need);
    if (has_room(need)) {
      return;
    }
    look(watch);
    pause(watch, "stream: waiting for room in the card's queues");
  }
}

void Stream::refresh_room(const Need& need) {
  if (need.geometry > room_.geometry) {
    room_.geometry = card_->bus().read(reg::kGeometryRoom);
  }
  if (need.feed > room_.feed) {
    room_.feed = card_->bus().read(reg::kFeedRoom);
  }
}

void Stream::write(const std::vector<std::uint32_t>& words, const Encoded* first, const Encoded* last) {
  const std::size_t begin = first->begin;
  const std::size_t end = (last - 1)->end;
  try {
    card_->bus().write_block(reg::kStream, &words[begin], end - begin, Addressing::kFixed);
  } catch (const BusError&) {
    broken_ = true;
    if (const auto refusal = card_->refusal_after_failure()) {
      throw_refused(*refusal);
    }
    throw;
  }
  sent_ += static_cast<std::uint64_t>(last - first);
  last_is_end_ = (last - 1)->is_end;
}

Status Stream::finish() {
  require_open();
  Watch watch;
  for (;;) {
    // The first look comes after a pause too: a command is some clocks on its way from the port to the queue.
    pause(watch, "stream: waiting for the end");
    const Status status = look(watch);
    if (!status.busy && (status.ended || !last_is_end_)) {
      return status;
    }
  }
}

Status Stream::look(Watch& watch) {
  const Status status = card_->status();
  card_->throw_if_faulted(status, "stream");
  if (status.refused) {
    if (const auto refusal = card_->refusal()) {
      throw_refused(*refusal);
    }
  }
  const std::uint32_t geometry_begun = card_->bus().read(reg::kGeometryBegun);
  const std::uint32_t feed_begun = card_->bus().read(reg::kFeedBegun);
  const bool same = geometry_begun == watch.geometry_begun && feed_begun == watch.feed_begun;
  if (!watch.started || !same || status.held) {
    watch = {0, geometry_begun, feed_begun, true};
  }
  if (options_.progress) {
    StreamProgress progress;
    progress.commands_sent = sent_;
    progress.status = status;
    progress.geometry_begun = geometry_begun;
    progress.feed_begun = feed_begun;
    options_.progress(progress);
  }
  return status;
}

void Stream::pause(Watch& watch, const char* context) {
  if (watch.waited >= stall_clocks_) {
    throw TimeoutError(context, watch.waited);
  }
  card_->bus().wait(poll_clocks_);
  watch.waited += poll_clocks_;
}

void Stream::require_open() const {
  if (broken_) {
    throw StateError("stream: closed by a refusal or a bus error; restart it");
  }
}

void Stream::throw_refused(const Refusal& refusal) {
  broken_ = true;
  throw RefusedError(refusal.reason, refusal.command_number, refusal.address, "stream");
}

}  // namespace trammel::driver
