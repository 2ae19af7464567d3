// Python's module: driver, simulated card and interpolators. The only file that knows of nanobind.
//
// Times come as whole nanoseconds, since Python's timedelta ends at microseconds. Calls that use a card let other
// threads of Python go on, and those that wait end at Ctrl-C: waiting().
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "trammel/driver/arc.hpp"
#include "trammel/driver/arc_chord.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/increment.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/one_shot.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/interpolation/any_interpolator.hpp"
#include "trammel/sim/engine.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"

namespace nb = nanobind;
using namespace nb::literals;
using namespace trammel;
using std::chrono::nanoseconds;

namespace {

// ---- Errors ----

struct ErrorTypes {
  nb::handle error, link, identification, refused, fault, state, held, stopped, interrupted, argument, timeout;
};
ErrorTypes error_types;  // live as long as the module, which Python never unloads

// A class of exceptions of the module, with one or two bases.
nb::handle make_error(nb::module_& m, const char* name, nb::handle base, nb::handle second = {}) {
  const std::string full = std::string("trammel.") + name;
  const nb::tuple bases = second ? nb::make_tuple(base, second) : nb::make_tuple(base);
  PyObject* const type = PyErr_NewException(full.c_str(), bases.ptr(), nullptr);
  if (type == nullptr) throw nb::python_error();
  m.attr(name) = nb::handle(type);
  return type;
}

// Raises `type`; `fields` are set on the exception.
template <class... Fields>
void raise(nb::handle type, const std::exception& error, std::pair<const char*, Fields>... fields) {
  nb::object exception = type(error.what());
  (nb::setattr(exception, fields.first, nb::cast(fields.second)), ...);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

// The driver's classes, the derived before their bases.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const driver::ArgumentError& e) {
    raise(error_types.argument, e);
  } catch (const std::invalid_argument& e) {  // arcs, interpolators, simulated cards
    raise(error_types.argument, e);
  } catch (const driver::StoppedError& e) {
    raise(error_types.stopped, e, std::pair{"geometry_begun", e.geometry_begun()});
  } catch (const driver::HeldError& e) {
    raise(error_types.held, e);
  } catch (const driver::StateError& e) {
    raise(error_types.state, e);
  } catch (const driver::InterruptedError& e) {
    raise(error_types.interrupted, e);
  } catch (const driver::TimeoutError& e) {
    raise(error_types.timeout, e, std::pair{"waited", e.waited()});
  } catch (const driver::RefusedError& e) {
    raise(error_types.refused, e, std::pair{"reason", e.reason()}, std::pair{"command_number", e.command_number()},
          std::pair{"address", e.address()});
  } catch (const driver::FaultError& e) {
    raise(error_types.fault, e, std::pair{"faults", e.faults()});
  } catch (const driver::LinkError& e) {
    raise(error_types.link, e);
  } catch (const driver::IdentificationError& e) {
    raise(error_types.identification, e);
  }
}

void bind_errors(nb::module_& m) {
  ErrorTypes& t = error_types;
  t.error = make_error(m, "Error", PyExc_RuntimeError);
  t.link = make_error(m, "LinkError", t.error);
  t.identification = make_error(m, "IdentificationError", t.error);
  t.refused = make_error(m, "RefusedError", t.error);
  t.fault = make_error(m, "FaultError", t.error);
  t.state = make_error(m, "StateError", t.error);
  t.held = make_error(m, "HeldError", t.state);
  t.stopped = make_error(m, "StoppedError", t.state);
  t.interrupted = make_error(m, "InterruptedError", t.error);
  t.argument = make_error(m, "ArgumentError", t.error, PyExc_ValueError);
  t.timeout = make_error(m, "TimeoutError", t.error, PyExc_TimeoutError);
  nb::register_exception_translator(translate);
}

// ---- Calls that wait ----

// What a signal's handler has raised while the thread's innermost call waited, if anything.
class RaisedWhileWaiting : public std::optional<nb::python_error> {
 public:
  RaisedWhileWaiting() : outer_(innermost()) { innermost() = this; }
  ~RaisedWhileWaiting() { innermost() = outer_; }
  RaisedWhileWaiting(const RaisedWhileWaiting&) = delete;
  RaisedWhileWaiting& operator=(const RaisedWhileWaiting&) = delete;

  static RaisedWhileWaiting*& innermost() {
    thread_local RaisedWhileWaiting* raised = nullptr;
    return raised;
  }

 private:
  RaisedWhileWaiting* outer_;
};

// Makes the call without Python's lock. While it waits, signals are looked for: what a handler raises (Ctrl-C:
// KeyboardInterrupt) ends the call, which stops the card on the path before, and is raised with what the driver said of
// that as its cause.
template <class Call>
auto without_lock(Call call) {
  RaisedWhileWaiting raised;
  const auto locked_out = [&] {
    const nb::gil_scoped_release unlocked;
    const driver::InterruptScope scope([&raised] {
      if (raised) return true;
      const nb::gil_scoped_acquire locked;
      if (PyErr_CheckSignals() == 0) return false;
      raised.emplace();
      return true;
    });
    return call();
  };
  try {
    if constexpr (std::is_void_v<decltype(call())>) {
      locked_out();
      if (!raised) return;
    } else {
      auto result = locked_out();
      if (!raised) return result;
    }
  } catch (const driver::Error& error) {
    if (!raised) throw;
    PyException_SetCause(raised->value().ptr(), error_types.error(error.what()).release().ptr());
  } catch (const nb::python_error&) {  // of a callback, in which a call of its own was ended
    if (!raised) throw;
  }
  throw std::move(*raised);
}

// The function, as Python calls it.
template <class Result, class... Values>
auto waiting(Result (*function)(Values...)) {
  return [function](Values... values) -> Result {
    return without_lock([&]() -> Result { return function(std::forward<Values>(values)...); });
  };
}
template <class Result, class Object, class... Values>
auto waiting(Result (Object::*function)(Values...)) {
  return [function](Object& object, Values... values) -> Result {
    return without_lock([&]() -> Result { return (object.*function)(std::forward<Values>(values)...); });
  };
}
template <class Lambda>
auto waiting(Lambda lambda) {
  return waiting(+lambda);
}

// ---- Cards ----

// (cycle, axis, direction) of a leading edge at a pin; (command, tick, axis, direction) of a step of the path.
using PinStep = std::tuple<std::uint64_t, unsigned, int>;
using PathStep = std::tuple<std::uint64_t, std::uint64_t, unsigned, int>;

class StepRecord final : public driver::StepSink {
 public:
  void pin_step(const driver::PinStep& s) override { pins.emplace_back(s.cycle, s.axis, s.direction); }
  void path_step(const driver::PathStep& s) override { path.emplace_back(s.command, s.tick, s.axis, s.direction); }

  std::vector<PinStep> pins;
  std::vector<PathStep> path;
};

// A bus that can be let go of while card and streams are still there: every access then says so.
class ClosableBus final : public driver::Bus {
 public:
  explicit ClosableBus(std::shared_ptr<driver::Bus> way) : way_(std::move(way)) {}
  void close() { way_.reset(); }

  std::size_t transfer(driver::Access* accesses, std::size_t count) override { return way().transfer(accesses, count); }
  void sleep(nanoseconds time) override { way().sleep(time); }
  bool reports_refusals() const override { return way().reports_refusals(); }
  bool has_interrupt() const override { return way().has_interrupt(); }
  bool wait_for_interrupt(nanoseconds longest) override { return way().wait_for_interrupt(longest); }
  std::string hold_origin() const override { return way().hold_origin(); }

 private:
  driver::Bus& way() const {
    if (!way_) throw driver::StateError("the card is closed");
    return *way_;
  }

  std::shared_ptr<driver::Bus> way_;
};

// Card, bus and, for simulated ones, the record of steps, which outlives the bus.
class PythonCard {
 public:
  PythonCard(std::shared_ptr<driver::Bus> way, sim::Engine* simulated)
      : bus_(std::move(way)), engine_(simulated), simulated_(simulated != nullptr), card(driver::Card::open(bus_)) {}

  sim::Engine& engine() const {
    if (!simulated_) throw driver::StateError("this is for simulated cards alone");
    if (engine_ == nullptr) throw driver::StateError("the card is closed");
    return *engine_;
  }
  void record(bool on) { engine().set_sink(on ? &steps : nullptr); }
  void close() {
    engine_ = nullptr;
    bus_.close();
  }

  StepRecord steps;

 private:
  ClosableBus bus_;
  sim::Engine* engine_;  // nullptr for others, and once closed
  bool simulated_;

 public:
  driver::Card card;
};

std::unique_ptr<PythonCard> simulate(unsigned axes, std::uint32_t clock_hz) {
  sim::EngineOptions options;
  options.axes = axes;
  options.clock_hz = clock_hz;
  std::shared_ptr<sim::Engine> engine = sim::make_model_engine(options);
  sim::Engine* const simulated = engine.get();
  return std::make_unique<PythonCard>(std::move(engine), simulated);
}

std::unique_ptr<PythonCard> open_card(const std::string& url) {
  const transport::CardUrl place = transport::parse_card_url(url);
  if (place.kind == transport::CardUrl::Kind::kSim) return simulate(place.axes, place.clock_hz);
  const auto connection = std::make_shared<transport::Connection>(place);
  return std::make_unique<PythonCard>(std::shared_ptr<driver::Bus>(connection, &connection->bus()), nullptr);
}

// By axis; what is missing at the end is 0.
template <class T>
std::array<T, card_map::kMaxAxes> by_axis(const std::vector<T>& values, const char* what) {
  if (values.size() > card_map::kMaxAxes) {
    throw driver::ArgumentError(std::string(what) + ": a card has 8 axes at most");
  }
  std::array<T, card_map::kMaxAxes> out{};
  std::copy(values.begin(), values.end(), out.begin());
  return out;
}

driver::OneShotPlan plan(const PythonCard& of, const std::vector<std::int64_t>& pulses,
                         std::optional<std::int64_t> duration_ns, std::optional<std::uint64_t> speed,
                         const std::vector<std::uint64_t>& max_velocity, bool slow_down) {
  if (duration_ns.has_value() == speed.has_value()) {
    throw driver::ArgumentError("a line has either duration_ns or speed (pulses/s along the path)");
  }
  driver::LineLimits limits;
  limits.max_velocity = by_axis(max_velocity, "max_velocity");
  limits.policy = slow_down ? driver::LimitPolicy::kSlow : driver::LimitPolicy::kRefuse;
  const driver::Displacement way = by_axis(pulses, "pulses");
  if (speed) return driver::plan_line(of.card.timing(), way, driver::PathSpeed{*speed, 1}, limits);
  return driver::plan_line(of.card.timing(), way, nanoseconds(*duration_ns), limits);
}

void bind_card_values(nb::module_& m) {
  nb::class_<card_map::Descriptor>(m, "Unit")
      .def_prop_ro("name", [](const card_map::Descriptor& of) { return driver::unit_name(of); })
      .def_ro("tag", &card_map::Descriptor::tag)
      .def_ro("major", &card_map::Descriptor::major)
      .def_ro("minor", &card_map::Descriptor::minor)
      .def_ro("instances", &card_map::Descriptor::instances)
      .def_ro("features", &card_map::Descriptor::features)
      .def_prop_ro("address", [](const card_map::Descriptor& of) { return 4 * of.base; })
      .def_ro("words", &card_map::Descriptor::words)
      .def_ro("stride", &card_map::Descriptor::stride);
  nb::class_<driver::Identification>(m, "Identification")
      .def_ro("map_major", &driver::Identification::map_major)
      .def_ro("map_minor", &driver::Identification::map_minor)
      .def_ro("commands_version", &driver::Identification::commands_version)
      .def_ro("axes", &driver::Identification::axes)
      .def_ro("clock_hz", &driver::Identification::clock_hz)
      .def_ro("engines", &driver::Identification::engines)
      .def_prop_ro("units",
                   [](const driver::Identification& of) {
                     return std::vector<card_map::Descriptor>(of.units.begin(), of.units.end());
                   })
      .def_ro("geometry_depth", &driver::Identification::geometry_depth)
      .def_ro("feed_depth", &driver::Identification::feed_depth);
  nb::class_<driver::Status>(m, "Status")
      .def_ro("busy", &driver::Status::busy)
      .def_ro("direct", &driver::Status::direct)
      .def_ro("path_active", &driver::Status::path_active)
      .def_ro("feed_active", &driver::Status::feed_active)
      .def_ro("held", &driver::Status::held)
      .def_ro("ended", &driver::Status::ended)
      .def_ro("faulted", &driver::Status::faulted)
      .def_ro("refused", &driver::Status::refused)
      .def_ro("stopping", &driver::Status::stopping)
      .def_ro("probed", &driver::Status::probed)
      .def_ro("probe_missed", &driver::Status::probe_missed)
      .def_ro("waiting", &driver::Status::waiting);
  nb::class_<driver::Snapshot>(m, "Snapshot")
      .def_ro("time", &driver::Snapshot::time)
      .def_ro("status", &driver::Snapshot::status)
      .def_ro("faults", &driver::Snapshot::faults)
      .def_ro("rate", &driver::Snapshot::rate)
      .def_ro("ratio", &driver::Snapshot::ratio)
      .def_ro("geometry_begun", &driver::Snapshot::geometry_begun)
      .def_ro("feed_begun", &driver::Snapshot::feed_begun)
      .def_ro("position", &driver::Snapshot::position);
  nb::class_<driver::OneShotPlan>(m, "LinePlan")
      .def_prop_ro("parts", &driver::OneShotPlan::size)
      .def_prop_ro("clocks", &driver::OneShotPlan::clocks)
      .def_prop_ro("slowed", &driver::OneShotPlan::slowed);
  nb::enum_<driver::StepMode>(m, "StepMode")
      .value("STEP_DIRECTION", driver::StepMode::kStepDirection)
      .value("UP_DOWN", driver::StepMode::kUpDown)
      .value("QUADRATURE", driver::StepMode::kQuadrature);
  nb::enum_<driver::PieceClass>(m, "PieceClass")
      .value("FEED", driver::PieceClass::kFeed)
      .value("RAPID", driver::PieceClass::kRapid)
      .value("FIXED", driver::PieceClass::kFixed);
}

void configure_axis(PythonCard& of, unsigned axis, std::int64_t length, std::int64_t space, std::int64_t setup,
                    std::int64_t hold, driver::StepMode mode, bool invert_first, bool invert_second) {
  of.card.configure_axis(axis, {nanoseconds(length), nanoseconds(space), nanoseconds(setup), nanoseconds(hold), mode,
                                invert_first, invert_second});
}

void bind_closing(nb::class_<PythonCard>& card) {
  card.def("close", waiting([](PythonCard& of) { of.close(); }),
           "Lets go of the link; a served card that could be moved then holds. Further accesses raise StateError.")
      .def("__enter__", [](nb::handle self) { return nb::borrow(self); })
      .def(
          "__exit__", [](PythonCard& of, const nb::object&, const nb::object&, const nb::object&) { of.close(); },
          "type"_a.none(), "value"_a.none(), "traceback"_a.none());
}

void bind_motion(nb::class_<PythonCard>& card) {
  card.def("start_line",
           waiting([](PythonCard& of, const std::vector<std::int64_t>& pulses, std::optional<std::int64_t> duration_ns,
                      std::optional<std::uint64_t> speed, const std::vector<std::uint64_t>& max_velocity,
                      bool slow_down) {
             const driver::OneShotPlan planned = plan(of, pulses, duration_ns, speed, max_velocity, slow_down);
             if (planned.size() != 1) throw driver::ArgumentError("the line has several parts: run_line() runs them");
             driver::start_line(of.card, planned.part(0));
             return planned;
           }),
           "pulses"_a, nb::kw_only(), "duration_ns"_a = nb::none(), "speed"_a = nb::none(),
           "max_velocity"_a = std::vector<std::uint64_t>{}, "slow_down"_a = false,
           "Starts a line, by axis, over duration_ns or at a speed along the path (pulses/s), and returns at once.")
      .def("run_line",
           waiting([](PythonCard& of, const std::vector<std::int64_t>& pulses, std::optional<std::int64_t> duration_ns,
                      std::optional<std::uint64_t> speed, const std::vector<std::uint64_t>& max_velocity,
                      bool slow_down, std::int64_t margin_ns) {
             const driver::OneShotPlan planned = plan(of, pulses, duration_ns, speed, max_velocity, slow_down);
             driver::run_line(of.card, planned, nanoseconds(margin_ns));
             return planned;
           }),
           "pulses"_a, nb::kw_only(), "duration_ns"_a = nb::none(), "speed"_a = nb::none(),
           "max_velocity"_a = std::vector<std::uint64_t>{}, "slow_down"_a = false, "margin_ns"_a = 1'000'000'000,
           "Runs a line and returns when it has ended.")
      .def("set_hold", waiting([](PythonCard& of, bool on) { of.card.set_hold(on); }), "on"_a = true,
           "Slews to rest on the path, or goes on.")
      .def("set_override",
           waiting([](PythonCard& of, double percent, double max_percent, driver::PieceClass piece_class) {
             of.card.set_override(piece_class, percent, max_percent);
           }),
           "percent"_a, "max_percent"_a = 100.0, "piece_class"_a = driver::PieceClass::kFeed)
      .def("set_slew_time", waiting([](PythonCard& of, std::int64_t ns) { of.card.set_slew_time(nanoseconds(ns)); }),
           "full_scale_ns"_a)
      .def("abort", waiting([](PythonCard& of) { of.card.abort(); }), "Drops what is queued and stops at once.")
      .def("stop", waiting([](PythonCard& of, std::int64_t ns) { return of.card.stop(nanoseconds(ns)); }),
           "margin_ns"_a = 1'000'000'000, "A hold, and at rest an abort. Gives back where the card stands.")
      .def("take_over", waiting([](PythonCard& of) { return of.card.take_over(); }),
           "Of another host that has left it: ends its hold. Gives back where the card stands if a motion was dropped.")
      .def(
          "request_hold", [](PythonCard& of, bool on) { of.card.request_hold(on); }, "on"_a = true)
      .def("request_abort", [](PythonCard& of) { of.card.request_abort(); })
      .def("request_stop", [](PythonCard& of) { of.card.request_stop(); });
}

void bind_state(nb::class_<PythonCard>& card) {
  card.def_prop_ro("identification", [](const PythonCard& of) { return of.card.identification(); })
      .def("configure_axis", waiting(configure_axis), "axis"_a, nb::kw_only(), "step_length_ns"_a = 0,
           "step_space_ns"_a = 0, "direction_setup_ns"_a = 0, "direction_hold_ns"_a = 0,
           "mode"_a = driver::StepMode::kStepDirection, "invert_first"_a = false, "invert_second"_a = false)
      .def("read_status", waiting([](PythonCard& of) { return of.card.read_status(); }))
      .def("read_snapshot", waiting([](PythonCard& of) { return of.card.read_snapshot(); }), "All of one clock.")
      .def("read_stop_snapshot", waiting([](PythonCard& of) { return of.card.read_stop_snapshot(); }))
      .def("wait_until_idle",
           waiting([](PythonCard& of, std::int64_t ns) { of.card.wait_until_idle(nanoseconds(ns)); }), "timeout_ns"_a)
      .def("read_faults", waiting([](PythonCard& of) { return of.card.read_faults(); }))
      .def("clear_faults", waiting([](PythonCard& of) { of.card.clear_faults(); }))
      .def("read_inputs", waiting([](PythonCard& of) { return of.card.read_inputs(); }))
      .def("read_outputs", waiting([](PythonCard& of) { return of.card.read_outputs(); }))
      .def("read_marks", waiting([](PythonCard& of) { return of.card.read_marks(); }))
      .def("read_mark_snapshot", waiting([](PythonCard& of) { return of.card.read_mark_snapshot(); }));
}

void bind_simulation(nb::class_<PythonCard>& card) {
  card.def("wait", waiting([](PythonCard& of, std::uint64_t clocks) {
             if (!of.engine().wait_or_interrupt(clocks)) throw driver::InterruptedError("wait: interrupted");
           }),
           "clocks"_a, "Simulated cards: lets clocks pass.")
      .def(
          "set_inputs", [](PythonCard& of, std::uint16_t levels) { of.engine().set_inputs(levels); }, "levels"_a,
          "Simulated cards: levels at the input pins, bit n: input n.")
      .def(
          "reset", [](PythonCard& of) { of.engine().reset(); }, "Simulated cards: as by the reset input.")
      .def("record_steps", &PythonCard::record, "on"_a = true,
           "Simulated cards: keeps every step from now on in pin_steps and path_steps.")
      .def_prop_ro(
          "pin_steps", [](const PythonCard& of) { return of.steps.pins; },
          "Leading edges at the STEP pins: (cycle, axis, direction).")
      .def_prop_ro(
          "path_steps", [](const PythonCard& of) { return of.steps.path; },
          "Steps of the path: (command, tick, axis, direction).");
}

// ---- Commands and their stream ----

driver::Command line(std::uint64_t ticks, const std::vector<std::int64_t>& pulses) {
  if (ticks == 0 || ticks >> card_map::constant::kFractionBits != 0) {
    throw driver::ArgumentError("a line's ticks are 1 .. 2^40 - 1");
  }
  const auto ways = by_axis(pulses, "pulses");
  driver::LineCommand out;
  out.ticks = ticks;
  for (unsigned axis = 0; axis < ways.size(); ++axis) {
    if (ways[axis] == 0) continue;
    const auto most = static_cast<std::int64_t>(ticks);
    if (ways[axis] > most || ways[axis] < -most) throw driver::ArgumentError("more pulses than ticks");
    out.mask = static_cast<std::uint8_t>(out.mask | 1U << axis);
    out.increment[axis] = driver::rounded_increment(ways[axis], ticks);
  }
  return out;
}

driver::ArcGeometry arc_geometry(std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end, double sweep,
                                 bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes) {
  return {centre[0], centre[1], end[0], end[1], clockwise, sweep, turns, axes[0], axes[1]};
}

driver::Command arc(std::uint64_t ticks, std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end,
                    double sweep, bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes,
                    bool eight_directions) {
  return driver::make_arc(arc_geometry(centre, end, sweep, clockwise, turns, axes), ticks,
                          eight_directions ? driver::StepRule::kEightDirections : driver::StepRule::kFourDirections);
}

driver::Command helix(std::uint64_t ticks, std::array<std::int64_t, 2> centre, std::array<std::int32_t, 2> end,
                      double sweep, bool clockwise, std::uint32_t turns, std::array<std::uint8_t, 2> axes,
                      const std::vector<std::int64_t>& further) {
  return driver::make_helix({arc_geometry(centre, end, sweep, clockwise, turns, axes), by_axis(further, "further")},
                            ticks);
}

driver::Command feed(std::uint64_t ticks, std::uint64_t rate, std::int64_t acceleration, std::int64_t jerk,
                     std::uint32_t floor, std::uint32_t stop_distance, driver::PieceClass piece_class) {
  return driver::FeedCommand{ticks, rate, acceleration, jerk, floor, stop_distance, piece_class};
}

// nanobind would take a variant apart into its alternatives.
struct PythonCommand {
  driver::Command command;
};

template <class... Values>
auto as_command(driver::Command (*make)(Values...)) {
  return [make](Values... values) { return PythonCommand{make(std::move(values)...)}; };
}

void bind_commands(nb::module_& m) {
  nb::class_<PythonCommand>(m, "Command")
      .def_prop_ro("name", [](const PythonCommand& c) { return std::string(driver::layout_of(c.command).name); })
      .def(
          "words",
          [](const PythonCommand& c, std::uint8_t number) {
            std::vector<std::uint32_t> words;
            driver::encode(c.command, number, words);
            return words;
          },
          "number"_a = 0, "As the card reads it.");
  m.def("line", as_command(line), "ticks"_a, "pulses"_a, "A straight line, by axis.");
  m.def("arc", as_command(arc), "ticks"_a, "centre"_a, "end"_a, "sweep"_a, "clockwise"_a = false, "turns"_a = 0,
        "axes"_a = std::array<std::uint8_t, 2>{0, 1}, "eight_directions"_a = false,
        "An arc of a circle: from the start to the centre in 1/256 pulses and to the end in pulses, sweep in radians.");
  m.def("helix", as_command(helix), "ticks"_a, "centre"_a, "end"_a, "sweep"_a, "clockwise"_a = false, "turns"_a = 0,
        "axes"_a = std::array<std::uint8_t, 2>{0, 1}, "further"_a = std::vector<std::int64_t>{},
        "An arc in chords, with lines of further axes over the same time.");
  m.def("feed", as_command(feed), "ticks"_a, "rate"_a, "acceleration"_a = 0, "jerk"_a = 0, "floor"_a = 1,
        "stop_distance"_a = 0, "piece_class"_a = driver::PieceClass::kFeed,
        "A piece of the feed: rate in 2^-64 ticks a clock. stop_distance 0: it ends at rest.");
  m.def(
      "dwell", [](std::uint64_t clocks) { return PythonCommand{driver::DwellCommand{clocks}}; }, "clocks"_a);
  m.def("end", [] { return PythonCommand{driver::EndCommand{}}; });
  m.def(
      "output",
      [](std::uint16_t set, std::uint16_t clear) {
        return PythonCommand{driver::OutputCommand{set, clear}};
      },
      "set"_a = 0, "clear"_a = 0, "Switches outputs at this place of the path.");
  m.def("mark", [] { return PythonCommand{driver::MarkCommand{}}; });
  m.def(
      "wait_input",
      [](std::uint8_t input, bool level, std::uint64_t timeout) {
        return PythonCommand{driver::WaitInputCommand{input, level, timeout}};
      },
      "input"_a, "level"_a = true, "timeout"_a = 0);
}

std::vector<driver::Command> commands_of(const std::vector<PythonCommand>& commands) {
  std::vector<driver::Command> out;
  out.reserve(commands.size());
  for (const PythonCommand& command : commands) out.push_back(command.command);
  return out;
}

// Ctrl-C may come while Python's function runs: it ends the call as everywhere, by a stop.
void tell(const std::function<void(const driver::StreamProgress&)>& progress, const driver::StreamProgress& is) {
  const nb::gil_scoped_acquire locked;
  try {
    progress(is);
  } catch (nb::python_error& error) {
    RaisedWhileWaiting* const raised = RaisedWhileWaiting::innermost();
    if (raised == nullptr || !error.matches(PyExc_KeyboardInterrupt)) throw;
    raised->emplace(std::move(error));
  }
}

void bind_stream(nb::module_& m) {
  nb::class_<driver::StreamProgress>(m, "StreamProgress")
      .def_ro("commands_sent", &driver::StreamProgress::commands_sent)
      .def_ro("status", &driver::StreamProgress::status)
      .def_ro("geometry_begun", &driver::StreamProgress::geometry_begun)
      .def_ro("feed_begun", &driver::StreamProgress::feed_begun);
  nb::enum_<driver::ProbeOutcome>(m, "ProbeOutcome")
      .value("TRIPPED", driver::ProbeOutcome::kTripped)
      .value("TRIPPED_ALREADY", driver::ProbeOutcome::kTrippedAlready)
      .value("MISSED", driver::ProbeOutcome::kMissed);
  nb::class_<driver::ProbeResult>(m, "ProbeResult")
      .def_ro("outcome", &driver::ProbeResult::outcome)
      .def_ro("edge", &driver::ProbeResult::edge)
      .def_ro("rest", &driver::ProbeResult::rest);
  nb::class_<driver::Stream>(m, "Stream")
      .def("__init__",
           waiting([](driver::Stream* place, PythonCard& of,
                      std::function<void(const driver::StreamProgress&)> progress, std::int64_t margin_ns) {
             driver::StreamOptions options;
             options.margin = nanoseconds(margin_ns);
             if (progress) {
               options.progress = [progress](const driver::StreamProgress& is) { tell(progress, is); };
             }
             new (place) driver::Stream(of.card, std::move(options));
           }),
           "card"_a, nb::kw_only(), "progress"_a.none() = nb::none(), "margin_ns"_a = 1'000'000'000,
           nb::keep_alive<1, 2>())
      .def("put", waiting([](driver::Stream& s, const PythonCommand& c) { s.put(c.command); }), "command"_a)
      .def("send", waiting([](driver::Stream& s, const std::vector<PythonCommand>& c) { s.send(commands_of(c)); }),
           "commands"_a, "Every one is checked before the first access to the card.")
      .def("flush", waiting(&driver::Stream::flush))
      .def("finish", waiting(&driver::Stream::finish), "Waits until all is done.")
      .def("restart", waiting(&driver::Stream::restart))
      .def("probe",
           waiting([](driver::Stream& s, std::uint8_t input, const std::vector<PythonCommand>& paths, bool level) {
             return s.probe({input, level}, commands_of(paths));
           }),
           "input"_a, "paths"_a, "level"_a = true)
      .def_prop_ro("sent", &driver::Stream::sent);
}

void bind_position_stream(nb::module_& m) {
  using driver::PositionStream;
  nb::class_<PositionStream::Sent>(m, "PositionsSent")
      .def_ro("ahead", &PositionStream::Sent::ahead)
      .def_ro("stale_ticks", &PositionStream::Sent::stale_ticks);
  nb::class_<PositionStream::Stopped>(m, "PositionsStopped")
      .def_ro("faults", &PositionStream::Stopped::faults)
      .def_ro("stale_ticks", &PositionStream::Stopped::stale_ticks)
      .def_ro("positions", &PositionStream::Stopped::positions);
  auto stream = nb::class_<PositionStream>(m, "PositionStream");
  stream.attr("PULSE") = PositionStream::kPulse;
  stream
      .def("__init__",
           waiting([](PositionStream* place, PythonCard& of, unsigned stale_periods, unsigned ahead,
                      const std::vector<double>& max_speed, std::int64_t margin_ns) {
             new (place) PositionStream(
                 of.card, {stale_periods, ahead, by_axis(max_speed, "max_speed"), nanoseconds(margin_ns)});
           }),
           "card"_a, nb::kw_only(), "stale_periods"_a = 1, "ahead"_a = 2, "max_speed"_a = std::vector<double>{},
           "margin_ns"_a = 1'000'000'000, nb::keep_alive<1, 2>())
      .def("send", waiting([](PositionStream& s, const std::vector<std::int64_t>& targets, std::int64_t duration_ns) {
             return s.send(by_axis(targets, "targets"), nanoseconds(duration_ns));
           }),
           "targets"_a, "duration_ns"_a,
           "A period: the axes are at targets (PULSE a pulse, from where they stood at the opening) at its end.")
      .def("recover", waiting(&PositionStream::recover), "After a FaultError: goes on from where the card stands.")
      .def("finish", waiting(&PositionStream::finish), "Waits until all is done; where the axes are.")
      .def_prop_ro("position", &PositionStream::position)
      .def_prop_ro("stale_ticks", &PositionStream::stale_ticks)
      .def_prop_ro("ticks_behind", &PositionStream::ticks_behind)
      .def_prop_ro("shortest_period", &PositionStream::shortest_period);
}

void bind_driver(nb::module_& m) {
  bind_card_values(m);
  auto card = nb::class_<PythonCard>(m, "Card");
  bind_closing(card);
  bind_motion(card);
  bind_state(card);
  bind_simulation(card);
  m.def("open", waiting(open_card), "url"_a, "The card that a URL names: sim:, tcp://host:port, serial:/dev/...");
  m.def("simulate", simulate, "axes"_a = 4, "clock_hz"_a = 1'000'000, "A simulated card: the golden model.");
  m.def("describe_faults", driver::describe_faults, "faults"_a);
  bind_commands(m);
  bind_stream(m);
  bind_position_stream(m);
}

// ---- Interpolators ----

namespace ip = interpolation;

// A walk that knows how many axes its curve has.
struct PythonWalk {
  ip::AnyInterpolator walk;
  unsigned axes;
  std::string method;

  nb::tuple point(const ip::Position& position) const {
    nb::list out;
    for (unsigned axis = 0; axis < axes; ++axis) out.append(position[axis]);
    return nb::tuple(out);
  }
};

// 128 bits, by way of two halves.
nb::object python_int(ip::Deviation value) {
  const auto high = static_cast<std::int64_t>(value >> 64);
  const auto low = static_cast<std::uint64_t>(value);
  return nb::int_(high) * nb::int_(std::uint64_t{1} << 32) * nb::int_(std::uint64_t{1} << 32) + nb::int_(low);
}

ip::Line line_curve(const std::vector<std::int64_t>& start, const std::vector<std::int64_t>& end) {
  if (start.size() != end.size() || start.size() < 2 || start.size() > ip::kMaxAxes) {
    throw driver::ArgumentError("a line goes between two points of 2 to 4 coordinates");
  }
  ip::Line out;
  out.axes = static_cast<unsigned>(start.size());
  std::copy(start.begin(), start.end(), out.start.begin());
  std::copy(end.begin(), end.end(), out.end.begin());
  return out;
}

std::unique_ptr<PythonWalk> walk(const std::string& method, const ip::Curve& curve, std::uint64_t clock_hz,
                                 std::uint64_t velocity) {
  const std::optional<ip::Method> named = ip::method_named(method);
  if (!named) throw driver::ArgumentError("no method is named " + method + " (methods() lists them)");
  ip::check_curve(curve);
  ip::Options options;
  options.clock_hz = clock_hz;
  options.velocity = velocity;
  const auto* line = std::get_if<ip::Line>(&curve);
  return std::make_unique<PythonWalk>(
      PythonWalk{ip::make_interpolator(*named, curve, options), line != nullptr ? line->axes : 2, method});
}

// All of a walk: a list of (time, position) after each step.
nb::list path_of(const PythonWalk& of) {
  nb::list out;
  ip::AnyInterpolator copy = of.walk;
  copy.run([&](const ip::Step&, const auto& at) { out.append(nb::make_tuple(at.time(), of.point(at.position()))); });
  return out;
}

void bind_methods(nb::module_& m) {
  nb::class_<ip::MethodInfo>(m, "MethodInfo")
      .def_prop_ro("name", [](const ip::MethodInfo& i) { return std::string(i.name); })
      .def_prop_ro("brief", [](const ip::MethodInfo& i) { return std::string(i.brief); })
      .def_ro("line_axes", &ip::MethodInfo::line_axes)
      .def_ro("circles", &ip::MethodInfo::circles)
      .def_ro("ellipses", &ip::MethodInfo::ellipses)
      .def_prop_ro("time_unit", [](const ip::MethodInfo& i) { return std::string(i.time_unit); })
      .def_ro("deviation", &ip::MethodInfo::deviation);
  m.def("methods", [] { return std::vector<ip::MethodInfo>(ip::methods().begin(), ip::methods().end()); });
}

void bind_interpolation(nb::module_ m) {
  bind_methods(m);
  nb::class_<ip::Curve>(m, "Curve");
  m.def(
      "line",
      [](const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) -> ip::Curve {
        return line_curve(a, b);
      },
      "start"_a, "end"_a);
  m.def(
      "circle", [](std::int64_t radius, bool clockwise) -> ip::Curve { return ip::make_circle(radius, clockwise); },
      "radius"_a, "clockwise"_a = false, "A full circle about the origin, from (radius, 0).");
  m.def(
      "arc",
      [](std::array<std::int64_t, 2> centre, std::array<std::int64_t, 2> start, std::array<std::int64_t, 2> end,
         bool clockwise, std::array<std::int64_t, 2> semi) -> ip::Curve {
        return ip::Arc{{centre[0], centre[1]}, {start[0], start[1]}, {end[0], end[1]}, clockwise, semi[0], semi[1]};
      },
      "centre"_a, "start"_a, "end"_a, "clockwise"_a = false, "semi_axes"_a = std::array<std::int64_t, 2>{0, 0},
      "Of a circle, or with semi-axes of an ellipse; start == end is a full turn.");
  nb::class_<PythonWalk>(m, "Interpolator")
      .def("path", path_of, "The rest of the walk: [(time, position), ...]; the walk itself stays where it is.")
      .def_prop_ro("position", [](const PythonWalk& w) { return w.point(w.walk.position()); })
      .def_prop_ro("done", [](const PythonWalk& w) { return w.walk.done(); })
      .def_prop_ro("time", [](const PythonWalk& w) { return w.walk.time(); })
      .def_prop_ro("total_time", [](const PythonWalk& w) { return w.walk.total_time(); })
      .def_prop_ro("deviation",
                   [](const PythonWalk& w) -> nb::object {
                     const std::optional<ip::Deviation> f = w.walk.deviation();
                     return f ? python_int(*f) : nb::none();
                   })
      .def("__iter__", [](nb::handle self) { return self; })
      .def("__next__", [](PythonWalk& w) {
        if (w.walk.done()) throw nb::stop_iteration();
        w.walk.next();
        return nb::make_tuple(w.walk.time(), w.point(w.walk.position()));
      });
  m.def("interpolate", walk, "method"_a, "curve"_a, "clock_hz"_a = ip::Options().clock_hz,
        "velocity"_a = ip::Options().velocity);
}

}  // namespace

NB_MODULE(_trammel, m) {
  m.attr("__version__") = TRAMMEL_VERSION;
  bind_errors(m);
  bind_driver(m);
  bind_interpolation(m.def_submodule("interpolation", "The interpolators of both papers and their rivals."));
}
