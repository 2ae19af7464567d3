// The Python module: driver, simulated card and interpolators.
//
// Times are whole nanoseconds, because Python's timedelta has a resolution of microseconds only. Calls that use a card
// release Python's lock, so that other threads run; Ctrl-C ends waiting calls (see waiting()).
#include "module.hpp"

NB_MODULE(_trammel, m) {
  using namespace trammel::python;
  m.doc() = "The compiled part of the package trammel: driver and simulated card.";
  m.attr("__version__") = TRAMMEL_VERSION;
  bind_errors(m);
  bind_card_values(m);
  bind_commands(m);
  bind_card(m);
  bind_stream(m);
  bind_position_stream(m);
  bind_interpolation(m.def_submodule("interpolation", "The interpolators of both papers and their rivals."));
}
