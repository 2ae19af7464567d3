// Machine files, homing, positions in mm.
#include <algorithm>

#include "handle.hpp"
#include "trammel/bindings/homing.hpp"
#include "trammel_machine.h"

struct trammel_machine {
  trammel::machine::Machine machine;
};

namespace trammel::c {
namespace {

const machine::Machine& machine_of(const trammel_machine* machine) { return required(machine, "machine").machine; }

const char* text_or_empty(const char* text) { return text == nullptr ? "" : text; }

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;
namespace bindings = trammel::bindings;

trammel_result trammel_load_machine(const char* file, trammel_machine** machine) {
  return guarded([=] {
    required(machine, "machine") = nullptr;
    *machine = new trammel_machine{bindings::load_machine(text_or_empty(file))};
  });
}

trammel_result trammel_change_machine(trammel_machine* machine, const char* entry) {
  return guarded([=] { bindings::change_machine(required(machine, "machine").machine, &required(entry, "entry")); });
}

void trammel_free_machine(trammel_machine* machine) { delete machine; }

trammel_result trammel_machine_letters(const trammel_machine* machine, char letters[TRAMMEL_MAX_AXES + 1]) {
  return guarded([=] {
    const auto& axes = machine_of(machine).axes;
    std::fill_n(&required(letters, "letters"), TRAMMEL_MAX_AXES + 1, '\0');
    for (std::size_t n = 0; n < axes.size(); ++n) letters[n] = axes[n].letter;
  });
}

trammel_result trammel_configure(trammel_card* card, const trammel_machine* machine) {
  return guarded([=] { bindings::configure(card_of(card), machine_of(machine)); });
}

trammel_result trammel_home(trammel_card* card, const trammel_machine* machine, const char* axes,
                            const trammel_home_options* options, trammel_homed_axis* homed, uint32_t* count) {
  return guarded([=] {
    driver::Card& moved = card_of(card);
    const auto& of = machine_of(machine);
    std::function<void(const std::string&)> say;
    if (options != nullptr && options->say != nullptr) {
      say = [told = *options](const std::string& text) { told.say(told.context, text.c_str()); };
    }
    card->stream.reset();
    card->positions.reset();
    const auto all = bindings::home(moved, of, text_or_empty(axes), say);
    if (count != nullptr) *count = static_cast<uint32_t>(all.size());
    for (std::size_t n = 0; homed != nullptr && n < all.size(); ++n) {
      homed[n] = {of.axes[all[n].axis].letter, all[n].search_edge, all[n].edge, all[n].squared_by};
    }
  });
}

trammel_result trammel_read_coordinates(trammel_card* card, const trammel_machine* machine, double* coordinates) {
  return guarded([=] {
    driver::Card& of = card_of(card);
    double& first = required(coordinates, "coordinates");
    const std::vector<double> at = bindings::read_coordinates(of, machine_of(machine));
    std::fill_n(&first, TRAMMEL_MAX_AXES, 0.0);
    std::copy(at.begin(), at.end(), &first);
  });
}

trammel_result trammel_pulses_of(const trammel_machine* machine, const double* way, int64_t* pulses) {
  return guarded([=] {
    const auto& of = machine_of(machine);
    const double* const from = &required(way, "way");
    int64_t* const to = &required(pulses, "pulses");
    const std::vector<int64_t> all =
        bindings::pulses_of(of, {from, from + static_cast<std::ptrdiff_t>(of.axes.size())});
    std::fill_n(to, TRAMMEL_MAX_AXES, 0);
    std::copy(all.begin(), all.end(), to);
  });
}
