#include <vector>

#include "handle.hpp"
#include "trammel/driver/feed_ramp.hpp"

namespace trammel::c {
namespace {

driver::Stream& stream_of(trammel_card* card) {
  std::optional<driver::Stream>& stream = required(card, "card").stream;
  if (!stream) throw driver::StateError("the card's stream is not open: trammel_open_stream() opens it");
  return *stream;
}

driver::StreamOptions options_of(const trammel_stream_options& options) {
  driver::StreamOptions out;
  if (options.margin_ns != 0) out.margin = std::chrono::nanoseconds(options.margin_ns);
  if (options.progress == nullptr) return out;
  out.progress = [options](const driver::StreamProgress& is) {
    const trammel_progress progress{is.commands_sent, is.geometry_begun, is.feed_begun, c_status(is.status)};
    if (!options.progress(options.context, &progress)) throw Cancelled();
  };
  return out;
}

trammel_probe_outcome outcome_of(driver::ProbeOutcome outcome) {
  switch (outcome) {
    case driver::ProbeOutcome::kTripped:
      return TRAMMEL_PROBE_TRIPPED;
    case driver::ProbeOutcome::kTrippedAlready:
      return TRAMMEL_PROBE_TRIPPED_ALREADY;
    case driver::ProbeOutcome::kMissed:
      break;
  }
  return TRAMMEL_PROBE_MISSED;
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_feed_for_ramp(const trammel_ramp* ramp, uint32_t clock_hz, trammel_feed_command* command) {
  return guarded([=] {
    const trammel_ramp& from = required(ramp, "ramp");
    trammel_feed_command& to = required(command, "command");
    const driver::FeedCommand made = driver::feed_for_ramp(
        {from.ticks, from.speed, from.end_speed, from.highest_speed, std::chrono::nanoseconds(from.slew_time_ns)},
        clock_hz);
    to = {};
    to.ticks = made.ticks;
    to.rate = made.rate;
    to.acceleration = made.acceleration;
    to.floor = made.floor;
    to.stop_distance = made.stop_distance;
    to.piece_class = static_cast<int32_t>(made.piece_class);
  });
}

trammel_result trammel_open_stream(trammel_card* card, const trammel_stream_options* options) {
  return guarded([=] {
    trammel_card& opened = required(card, "card");
    driver::StreamOptions wanted = options_of(options != nullptr ? *options : trammel_stream_options{});
    opened.positions.reset();
    opened.stream.reset();
    opened.stream.emplace(opened.card, std::move(wanted));
  });
}

trammel_result trammel_put(trammel_card* card, const trammel_command* command) {
  return guarded([=] { stream_of(card).put(command_of(required(command, "command"))); });
}

trammel_result trammel_flush(trammel_card* card) {
  return guarded([=] { stream_of(card).flush(); });
}

trammel_result trammel_finish(trammel_card* card, trammel_status* status) {
  return guarded([=] {
    const trammel_status at_end = c_status(stream_of(card).finish());
    if (status != nullptr) *status = at_end;
  });
}

trammel_result trammel_restart_stream(trammel_card* card) {
  return guarded([=] { stream_of(card).restart(); });
}

trammel_result trammel_probe(trammel_card* card, const trammel_input_condition* condition, const trammel_command* paths,
                             size_t count, trammel_probe_result* result) {
  return guarded([=] {
    driver::Stream& stream = stream_of(card);
    const trammel_input_condition& until = required(condition, "condition");
    required(paths, "paths");
    required(result, "result");
    if (until.timeout != 0) throw driver::ArgumentError("a probe has no time-out: its paths end");
    std::vector<driver::Command> commands;
    commands.reserve(count);
    for (size_t i = 0; i < count; ++i) commands.push_back(command_of(paths[i]));
    const driver::ProbeResult probed = stream.probe({until.input, until.level}, commands);
    *result = {outcome_of(probed.outcome), c_snapshot(probed.edge), c_snapshot(probed.rest)};
  });
}
