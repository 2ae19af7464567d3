// The stream of commands.
#include "trammel/driver/stream.hpp"

#include <nanobind/stl/function.h>
#include <nanobind/stl/vector.h>

#include <functional>

#include "card.hpp"
#include "commands.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

std::vector<driver::Command> commands_of(const std::vector<PythonCommand>& commands) {
  std::vector<driver::Command> out;
  out.reserve(commands.size());
  for (const PythonCommand& command : commands) out.push_back(command.command);
  return out;
}

// Ctrl-C may come while the Python function runs. It then ends the call as everywhere, by a stop.
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

}  // namespace

void bind_stream(nb::module_& m) {
  nb::class_<driver::StreamProgress>(m, "StreamProgress", "What a stream tells its progress function.")
      .def_ro("commands_sent", &driver::StreamProgress::commands_sent,
              "Commands sent since the stream was opened or restarted.")
      .def_ro("status", &driver::StreamProgress::status, "STATUS of the card.")
      .def_ro("geometry_begun", &driver::StreamProgress::geometry_begun,
              "Of the commands sent, those begun from the geometry queue.")
      .def_ro("feed_begun", &driver::StreamProgress::feed_begun,
              "Of the commands sent, those begun from the feed queue.");
  nb::enum_<driver::ProbeOutcome>(m, "ProbeOutcome", "How probing ended.")
      .value("TRIPPED", driver::ProbeOutcome::kTripped, "The edge came on the way.")
      .value("TRIPPED_ALREADY", driver::ProbeOutcome::kTrippedAlready,
             "The input had the level before the path began: nothing moved.")
      .value("MISSED", driver::ProbeOutcome::kMissed, "The paths ended without the edge.");
  nb::class_<driver::ProbeResult>(m, "ProbeResult", "The end of Stream.probe().")
      .def_ro("outcome", &driver::ProbeResult::outcome, "How the probing ended.")
      .def_ro("edge", &driver::ProbeResult::edge, "Snapshot at the edge of the input; zeros if it was missed.")
      .def_ro("rest", &driver::ProbeResult::rest, "Snapshot of the card at rest.");
  nb::class_<driver::Stream>(m, "Stream", "A stream of commands to a card.")
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
           nb::keep_alive<1, 2>(),
           "Drops what is queued and numbers commands from 0. progress is called with a StreamProgress during waits.")
      .def("put", waiting([](driver::Stream& s, const PythonCommand& c) { s.put(c.command); }), "command"_a,
           "Sends a command, or keeps it back until flush() or a full transfer.")
      .def("send", waiting([](driver::Stream& s, const std::vector<PythonCommand>& c) { s.send(commands_of(c)); }),
           "commands"_a, "Sends commands; all are checked before the first access to the card.")
      .def("flush", waiting(&driver::Stream::flush), "Sends what put() has kept back.")
      .def("finish", waiting(&driver::Stream::finish), "Waits until all is done.")
      .def("restart", waiting(&driver::Stream::restart),
           "Drops what is queued, stops the path and numbers commands from 0.")
      .def("probe",
           waiting([](driver::Stream& s, std::uint8_t input, const std::vector<PythonCommand>& paths, bool level) {
             return s.probe({input, level}, commands_of(paths));
           }),
           "input"_a, "paths"_a, "level"_a = true, "Runs paths until the input has the level, and stops there.")
      .def_prop_ro("sent", &driver::Stream::sent, "Commands sent since the stream was opened or restarted.");
}

}  // namespace trammel::python
