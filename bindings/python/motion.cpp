// Motion without a stream: one-shot lines, hold, override, stop.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "card.hpp"
#include "trammel/driver/one_shot.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

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

}  // namespace

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
           "percent"_a, "max_percent"_a = 100.0, "piece_class"_a = driver::PieceClass::kFeed,
           "Sets the override of a class. max_percent is the override that its programs are planned for.")
      .def("set_slew_time", waiting([](PythonCard& of, std::int64_t ns) { of.card.set_slew_time(nanoseconds(ns)); }),
           "full_scale_ns"_a, "Time that the time base takes from rest to its full ratio.")
      .def("abort", waiting([](PythonCard& of) { of.card.abort(); }), "Drops what is queued and stops at once.")
      .def("stop", waiting([](PythonCard& of, std::int64_t ns) { return of.card.stop(nanoseconds(ns)); }),
           "margin_ns"_a = 1'000'000'000, "A hold, and at rest an abort. Gives back where the card stands.")
      .def("take_over", waiting([](PythonCard& of) { return of.card.take_over(); }),
           "Of another host that has left it: ends its hold. Gives back where the card stands if a motion was dropped.")
      .def(
          "request_hold", [](PythonCard& of, bool on) { of.card.request_hold(on); }, "on"_a = true,
          "From any thread: the call that waits sets or ends the hold.")
      .def(
          "request_abort", [](PythonCard& of) { of.card.request_abort(); },
          "From any thread: the call that waits aborts the motion.")
      .def(
          "request_stop", [](PythonCard& of) { of.card.request_stop(); },
          "From any thread: the call that waits stops the card on the path and raises StoppedError.");
}

}  // namespace trammel::python
