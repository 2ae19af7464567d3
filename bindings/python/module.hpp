// The parts of the module, one per file. Only the files of this folder depend on nanobind.
#pragma once

#include <nanobind/nanobind.h>

namespace trammel::python {

namespace nb = nanobind;
using namespace nb::literals;

class PythonCard;

void bind_errors(nb::module_& m);
void bind_card_values(nb::module_& m);
void bind_card(nb::module_& m);
void bind_motion(nb::class_<PythonCard>& card);
void bind_inputs(nb::module_& m, nb::class_<PythonCard>& card);
void bind_guards(nb::module_& m, nb::class_<PythonCard>& card);
void bind_place(nb::module_& m, nb::class_<PythonCard>& card);
void bind_pwm(nb::module_& m, nb::class_<PythonCard>& card);
void bind_world(nb::module_& m, nb::class_<PythonCard>& card);
void bind_machine_file(nb::module_& m, nb::class_<PythonCard>& card);
void bind_commands(nb::module_& m);
void bind_stream(nb::module_& m);
void bind_position_stream(nb::module_& m);
void bind_interpolation(nb::module_ m);

}  // namespace trammel::python
