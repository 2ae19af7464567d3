// The machine's place.
#include <algorithm>

#include "handle.hpp"
#include "trammel/driver/card_place.hpp"

namespace trammel::c {

static_assert(TRAMMEL_NO_SCALES == driver::kNoScales);
static_assert(TRAMMEL_SCALES_IN_PULSES == driver::kScalesInPulses);

namespace {

trammel_place c_place(const driver::CardPlace& place, bool first) {
  trammel_place out{};
  out.first = first;
  out.valid = place.bits.valid;
  out.homed = place.bits.homed;
  out.keeps = place.keeps;
  out.scales = place.scales;
  const auto pulses = place.pulses();
  std::copy(place.zero.begin(), place.zero.end(), out.machine_zero);
  std::copy(pulses.begin(), pulses.end(), out.pulses);
  return out;
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;

trammel_result trammel_read_place(trammel_card* card, trammel_place* place) {
  return guarded([=] { required(place, "place") = c_place(driver::read_card_place(card_of(card)), false); });
}

trammel_result trammel_begin_at_place(trammel_card* card, uint8_t axes, bool trust, trammel_place* place) {
  return guarded([=] {
    const driver::PlaceBegin begin = driver::begin_at_place(card_of(card), axes, trust);
    if (place != nullptr) *place = c_place(begin.place, begin.first);
  });
}

trammel_result trammel_set_place(trammel_card* card, uint8_t axes, bool valid, bool homed) {
  return guarded([=] { card_of(card).set_place(axes, valid, homed); });
}

trammel_result trammel_set_machine_zero(trammel_card* card, unsigned axis, int32_t pulses) {
  return guarded([=] { card_of(card).set_machine_zero(axis, pulses); });
}

trammel_result trammel_set_scales(trammel_card* card, uint32_t hash) {
  return guarded([=] { card_of(card).set_scales(hash); });
}

trammel_result trammel_set_keeps_place(trammel_card* card, uint8_t axes) {
  return guarded([=] { card_of(card).set_keeps_place(axes); });
}
