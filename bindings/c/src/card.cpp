#include <algorithm>
#include <vector>

#include "handle.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"
#include "trammel_machine.h"

namespace trammel::c {

static_assert(TRAMMEL_MAX_AXES == card_map::kMaxAxes);
static_assert(TRAMMEL_FULL_RATIO == driver::Card::kFullRatio);

namespace {

using std::chrono::nanoseconds;

// Calls `open`, which creates the card. `out` is null unless it succeeds.
template <class Open>
trammel_result open_card(trammel_card** out, Open open) noexcept {
  return guarded([&] {
    required(out, "card") = nullptr;
    *out = open().release();
  });
}

std::unique_ptr<trammel_card> open_place(const transport::CardUrl& place) {
  const auto connection = std::make_shared<transport::Connection>(place);
  return std::make_unique<trammel_card>(std::shared_ptr<driver::Bus>(connection, &connection->bus()),
                                        connection->engine());
}

std::unique_ptr<trammel_card> open_simulated(const trammel_simulation& simulation) {
  transport::CardUrl place;
  place.axes = simulation.axes;
  place.clock_hz = simulation.clock_hz;
  return open_place(place);
}

std::unique_ptr<trammel_card> open_in_world(const trammel_simulation& simulation, const char* world_file) {
  const auto world = std::make_shared<bindings::CardInWorld>(world_file == nullptr ? "" : world_file, simulation.axes,
                                                             simulation.clock_hz);
  auto card = std::make_unique<trammel_card>(std::shared_ptr<driver::Bus>(world, &world->engine()), &world->engine());
  card->world = world;
  return card;
}

driver::AxisSettings settings_of(const trammel_axis_settings& settings) {
  if (settings.mode < TRAMMEL_STEP_DIRECTION || settings.mode > TRAMMEL_QUADRATURE) {
    throw driver::ArgumentError("mode " + std::to_string(settings.mode) + " is none of trammel_step_mode");
  }
  driver::AxisSettings out;
  out.step_length = nanoseconds(settings.step_length_ns);
  out.step_space = nanoseconds(settings.step_space_ns);
  out.direction_setup = nanoseconds(settings.direction_setup_ns);
  out.direction_hold = nanoseconds(settings.direction_hold_ns);
  out.mode = static_cast<driver::StepMode>(settings.mode);
  out.invert_first = settings.invert_first;
  out.invert_second = settings.invert_second;
  return out;
}

driver::OneShotPlan plan(const driver::Card& card, const trammel_one_shot& line) {
  driver::Displacement displacement{};
  std::copy(std::begin(line.pulses), std::end(line.pulses), displacement.begin());
  driver::LineLimits limits;
  std::copy(std::begin(line.max_velocity), std::end(line.max_velocity), limits.max_velocity.begin());
  limits.policy = line.slow_down ? driver::LimitPolicy::kSlow : driver::LimitPolicy::kRefuse;
  const bool has_speed = line.speed_pulses != 0 || line.speed_seconds != 0;
  if (has_speed && line.duration_ns != 0) throw driver::ArgumentError("a line has a duration or a speed, not both");
  if (has_speed) {
    return driver::plan_line(card.timing(), displacement, driver::PathSpeed{line.speed_pulses, line.speed_seconds},
                             limits);
  }
  return driver::plan_line(card.timing(), displacement, nanoseconds(line.duration_ns), limits);
}

void give(trammel_line_plan* out, const driver::OneShotPlan& plan) {
  if (out != nullptr) *out = {plan.size(), plan.clocks(), plan.slowed()};
}

}  // namespace

driver::PieceClass piece_class_of(std::int32_t piece_class) {
  if (piece_class < TRAMMEL_CLASS_FEED || piece_class > TRAMMEL_CLASS_FIXED) {
    throw driver::ArgumentError("class " + std::to_string(piece_class) + " is none of trammel_piece_class");
  }
  return static_cast<driver::PieceClass>(piece_class);
}

trammel_status c_status(const driver::Status& s) {
  return {s.busy,     s.direct,     s.path_active, s.feed_active,  s.held,         s.ended,  s.faulted,      s.refused,
          s.snapshot, s.incomplete, s.stopping,    s.geometry_low, s.feed_low,     s.probed, s.probe_missed, s.waiting,
          s.underrun, s.stale,      s.button_hold, s.enabled,      s.enable_waits, s.settled};
}

trammel_snapshot c_snapshot(const driver::Snapshot& snapshot) {
  trammel_snapshot out{};
  out.time = snapshot.time;
  out.status = c_status(snapshot.status);
  out.faults = snapshot.faults;
  out.rate = snapshot.rate;
  out.ratio = snapshot.ratio;
  out.geometry_begun = snapshot.geometry_begun;
  out.feed_begun = snapshot.feed_begun;
  std::copy(snapshot.position.begin(), snapshot.position.end(), out.position);
  return out;
}

}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_open(const char* url, trammel_card** card) {
  return open_card(card, [=] { return open_place(trammel::transport::parse_card_url(&required(url, "url"))); });
}

trammel_result trammel_open_simulated(const trammel_simulation* simulation, trammel_card** card) {
  return open_card(card, [=] { return open_simulated(required(simulation, "simulation")); });
}

trammel_result trammel_open_in_world(const trammel_simulation* simulation, const char* world_file,
                                     trammel_card** card) {
  return open_card(card, [=] { return open_in_world(required(simulation, "simulation"), world_file); });
}

trammel_result trammel_open_bus(const trammel_bus* bus, trammel_card** card) {
  return open_card(card,
                   [=] { return std::make_unique<trammel_card>(make_callback_bus(required(bus, "bus")), nullptr); });
}

void trammel_close(trammel_card* card) { delete card; }

trammel_result trammel_transfer(trammel_card* card, trammel_access* accesses, size_t count, size_t* made) {
  return guarded([=] {
    driver::Bus& bus = card_of(card).bus();
    if (count != 0) required(accesses, "accesses");
    required(made, "made");
    std::vector<driver::Access> todo(count);
    for (size_t i = 0; i < count; ++i) {
      if (accesses[i].address >= trammel::card_map::kWindowBytes || accesses[i].address % 4 != 0) {
        throw driver::ArgumentError("address " + std::to_string(accesses[i].address) + " is none of a register");
      }
      todo[i] = {accesses[i].address, accesses[i].data, accesses[i].write};
    }
    *made = bus.transfer(todo.data(), count);
    for (size_t i = 0; i < *made; ++i) accesses[i].data = todo[i].data;
  });
}

trammel_result trammel_identify(const trammel_card* card, trammel_identification* identification) {
  return guarded([=] {
    const driver::Identification& is = required(card, "card").card.identification();
    required(identification, "identification") = {is.map_major, is.map_minor, is.commands_version, is.axes,
                                                  is.clock_hz,  is.engines,   is.geometry_depth,   is.feed_depth};
  });
}

trammel_result trammel_identify_units(const trammel_card* card, trammel_unit* units, size_t room, size_t* count) {
  return guarded([=] {
    const driver::UnitTable& table = required(card, "card").card.identification().units;
    size_t& number = required(count, "count");
    if (room != 0) required(units, "units");
    number = 0;
    for (const trammel::card_map::Descriptor& unit : table) {
      if (number < room) {
        units[number] = {unit.tag,       unit.major,    unit.minor,
                         unit.instances, unit.features, static_cast<uint16_t>(4 * unit.base),
                         unit.words,     unit.stride};
      }
      ++number;
    }
  });
}

trammel_result trammel_configure_axis(trammel_card* card, unsigned axis, const trammel_axis_settings* settings) {
  return guarded([=] { card_of(card).configure_axis(axis, settings_of(required(settings, "settings"))); });
}

trammel_result trammel_read_status(trammel_card* card, trammel_status* status) {
  return guarded([=] { required(status, "status") = c_status(card_of(card).read_status()); });
}

trammel_result trammel_read_snapshot(trammel_card* card, trammel_snapshot* snapshot) {
  return guarded([=] { required(snapshot, "snapshot") = c_snapshot(card_of(card).read_snapshot()); });
}

trammel_result trammel_read_stop_snapshot(trammel_card* card, trammel_snapshot* snapshot) {
  return guarded([=] { required(snapshot, "snapshot") = c_snapshot(card_of(card).read_stop_snapshot()); });
}

trammel_result trammel_wait_until_idle(trammel_card* card, int64_t timeout_ns) {
  return guarded([=] { card_of(card).wait_until_idle(std::chrono::nanoseconds(timeout_ns)); });
}

trammel_result trammel_read_faults(trammel_card* card, uint32_t* faults) {
  return guarded([=] { required(faults, "faults") = card_of(card).read_faults(); });
}

trammel_result trammel_clear_faults(trammel_card* card) {
  return guarded([=] { card_of(card).clear_faults(); });
}

trammel_result trammel_set_watchdog(trammel_card* card, int64_t time_ns) {
  return guarded([=] { card_of(card).set_watchdog(nanoseconds(time_ns)); });
}

trammel_result trammel_describe_faults(uint32_t faults, char* text, size_t size) {
  return guarded([=] { give_text([=] { return driver::describe_faults(faults); }, text, size); });
}

trammel_result trammel_read_fault_text(trammel_card* card, char* text, size_t size) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    give_text([&] { return of.read_fault_text(); }, text, size);
  });
}

trammel_result trammel_read_inputs(trammel_card* card, uint32_t* levels) {
  return guarded([=] { required(levels, "levels") = card_of(card).read_inputs(); });
}

trammel_result trammel_read_outputs(trammel_card* card, uint16_t* levels) {
  return guarded([=] { required(levels, "levels") = card_of(card).read_outputs(); });
}

trammel_result trammel_set_input_polarity(trammel_card* card, uint32_t inverted) {
  return guarded([=] { card_of(card).set_input_polarity(inverted); });
}

trammel_result trammel_set_output_safe(trammel_card* card, uint16_t levels, uint16_t change) {
  return guarded([=] { card_of(card).set_output_safe(levels, change); });
}

trammel_result trammel_read_marks(trammel_card* card, uint32_t* marks, trammel_snapshot* last) {
  return guarded([=] {
    driver::Card& read = card_of(card);
    if (marks != nullptr) *marks = read.read_marks();
    if (last != nullptr) *last = c_snapshot(read.read_mark_snapshot());
  });
}

trammel_result trammel_set_hold(trammel_card* card, bool hold) {
  return guarded([=] { card_of(card).set_hold(hold); });
}

trammel_result trammel_set_ratio(trammel_card* card, std::int32_t piece_class, uint32_t ratio) {
  return guarded([=] { card_of(card).set_ratio(piece_class_of(piece_class), ratio); });
}

trammel_result trammel_set_override(trammel_card* card, std::int32_t piece_class, double percent, double max_percent) {
  return guarded([=] { card_of(card).set_override(piece_class_of(piece_class), percent, max_percent); });
}

trammel_result trammel_set_slew_time(trammel_card* card, int64_t full_scale_ns) {
  return guarded([=] { card_of(card).set_slew_time(std::chrono::nanoseconds(full_scale_ns)); });
}

trammel_result trammel_abort(trammel_card* card) {
  return guarded([=] { card_of(card).abort(); });
}

trammel_result trammel_stop(trammel_card* card, int64_t margin_ns, trammel_snapshot* snapshot) {
  return guarded([=] {
    const trammel_snapshot rest = c_snapshot(card_of(card).stop(std::chrono::nanoseconds(margin_ns)));
    if (snapshot != nullptr) *snapshot = rest;
  });
}

trammel_result trammel_take_over(trammel_card* card, bool* dropped) {
  return guarded([=] {
    const bool some = card_of(card).take_over().has_value();
    if (dropped != nullptr) *dropped = some;
  });
}

void trammel_request_hold(trammel_card* card, bool hold) {
  if (card != nullptr) card->card.request_hold(hold);
}

void trammel_request_ratio(trammel_card* card, std::int32_t piece_class, uint32_t ratio) {
  const bool is_class = piece_class >= TRAMMEL_CLASS_FEED && piece_class <= TRAMMEL_CLASS_FIXED;
  if (card != nullptr && is_class) card->card.request_ratio(static_cast<driver::PieceClass>(piece_class), ratio);
}

void trammel_request_abort(trammel_card* card) {
  if (card != nullptr) card->card.request_abort();
}

void trammel_request_stop(trammel_card* card) {
  if (card != nullptr) card->card.request_stop();
}

trammel_result trammel_start_line(trammel_card* card, const trammel_one_shot* line, trammel_line_plan* out) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const driver::OneShotPlan planned = plan(of, required(line, "line"));
    if (planned.size() != 1) {
      throw driver::ArgumentError("the line has " + std::to_string(planned.size()) +
                                  " parts: trammel_run_line() runs them one after the other");
    }
    driver::start_line(of, planned.part(0));
    give(out, planned);
  });
}

trammel_result trammel_run_line(trammel_card* card, const trammel_one_shot* line, int64_t margin_ns,
                                trammel_line_plan* out) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    const driver::OneShotPlan planned = plan(of, required(line, "line"));
    driver::run_line(of, planned, std::chrono::nanoseconds(margin_ns));
    give(out, planned);
  });
}
