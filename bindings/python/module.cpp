// Python's module: driver, simulated card and interpolators.
//
// Times come as whole nanoseconds, since Python's timedelta ends at microseconds. Calls that use a card let other
// threads of Python go on, and those that wait end at Ctrl-C: waiting().
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
