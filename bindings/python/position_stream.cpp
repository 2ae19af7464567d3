// Position streaming.
#include "trammel/driver/position_stream.hpp"

#include <nanobind/stl/array.h>
#include <nanobind/stl/vector.h>

#include "card.hpp"
#include "waiting.hpp"

namespace trammel::python {

void bind_position_stream(nb::module_& m) {
  using driver::PositionStream;
  nb::class_<PositionStream::Sent>(m, "PositionsSent", "The card's state when a period was sent.")
      .def_ro("ahead", &PositionStream::Sent::ahead, "Periods queued that have not begun.")
      .def_ro("stale_ticks", &PositionStream::Sent::stale_ticks,
              "Ticks that the card had gone on for when the period came; 0: it was in time.");
  nb::class_<PositionStream::Stopped>(m, "PositionsStopped", "Where the card stands after a fault.")
      .def_ro("faults", &PositionStream::Stopped::faults, "Latched faults: a mask for describe_faults().")
      .def_ro("stale_ticks", &PositionStream::Stopped::stale_ticks,
              "Ticks that the card went on for after the last period.")
      .def_ro("positions", &PositionStream::Stopped::positions, "Places of the axes, 2^-24 pulses.");
  auto stream = nb::class_<PositionStream>(m, "PositionStream", "Position streaming: a target for each period.");
  stream.attr("PULSE") = PositionStream::kPulse;
  stream
      .def("__init__",
           waiting([](PositionStream* place, PythonCard& of, unsigned stale_periods, unsigned ahead,
                      const std::vector<double>& max_speed, std::int64_t margin_ns) {
             new (place) PositionStream(
                 of.card, {stale_periods, ahead, by_axis(max_speed, "max_speed"), nanoseconds(margin_ns)});
           }),
           "card"_a, nb::kw_only(), "stale_periods"_a = 1, "ahead"_a = 2, "max_speed"_a = std::vector<double>{},
           "margin_ns"_a = 1'000'000'000, nb::keep_alive<1, 2>(),
           "Drops what is queued. Positions count from where the axes stand.")
      .def("send", waiting([](PositionStream& s, const std::vector<std::int64_t>& targets, std::int64_t duration_ns) {
             return s.send(by_axis(targets, "targets"), nanoseconds(duration_ns));
           }),
           "targets"_a, "duration_ns"_a,
           "A period: the axes are at targets (PULSE a pulse, from where they stood at the opening) at its end.")
      .def("recover", waiting(&PositionStream::recover), "After a FaultError: goes on from where the card stands.")
      .def("finish", waiting(&PositionStream::finish), "Waits until all is done; where the axes are.")
      .def_prop_ro("position", &PositionStream::position,
                   "Where the axes will be when all that was sent is done, 2^-24 pulses (whole pulses).")
      .def_prop_ro("stale_ticks", &PositionStream::stale_ticks, "Ticks that the card went on for since the opening.")
      .def_prop_ro("ticks_behind", &PositionStream::ticks_behind,
                   "Ticks of stale_ticks that coming periods still take up.")
      .def_prop_ro("shortest_period", &PositionStream::shortest_period,
                   "Shortest duration of a period, clocks of the card.");
}

}  // namespace trammel::python
