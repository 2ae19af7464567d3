#include "trammel/run/take_over.hpp"

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::run {

std::optional<driver::Snapshot> take_over(driver::Card& card) {
  const driver::Status status = card.status();
  const bool stopping = card.read(card_map::reg::kHold) != 0;
  if (status.busy && !status.held && !stopping) {
    throw driver::StateError("the card is moving, and not by this program: wait until it is idle, or hold it");
  }
  if (status.busy) return card.stop();
  card.set_hold(false);
  return std::nullopt;
}

}  // namespace trammel::run
