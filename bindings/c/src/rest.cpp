// The state in which a stop left the card.
#include <algorithm>

#include "handle.hpp"

namespace trammel::c {
namespace {

trammel_rest c_rest(const driver::Rest& rest) {
  trammel_rest out{};
  out.time = rest.time;
  out.status = c_status(rest.status);
  out.faults = rest.faults;
  out.geometry_begun = rest.geometry_begun;
  out.feed_begun = rest.feed_begun;
  out.ticks_left = rest.ticks_left;
  std::copy(rest.position.begin(), rest.position.end(), out.position);
  out.exact = rest.exact();
  return out;
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;

trammel_result trammel_read_rest(trammel_card* card, trammel_rest* rest) {
  return guarded([=] { required(rest, "rest") = c_rest(card_of(card).read_rest()); });
}

trammel_result trammel_wait_until_stopped(trammel_card* card, int64_t margin_ns) {
  return guarded([=] { card_of(card).wait_until_stopped(std::chrono::nanoseconds(margin_ns)); });
}
