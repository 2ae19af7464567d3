#include "trammel/driver/low_level/requests.hpp"

#include <fmt/format.h>

#include "trammel/driver/card.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/low_level/card_parts.hpp"

namespace trammel::driver {
namespace {

[[noreturn]] void stop_on_request(Card& card, const char* why) {
  card.parts().requests.take_hold();
  const Snapshot end = card.stop();
  throw StoppedError(end.geometry_begun, fmt::format("card: stopped on the path, {}", why));
}

}  // namespace

std::optional<bool> Requests::take_hold() {
  const int hold = hold_.exchange(-1);
  return hold < 0 ? std::nullopt : std::optional<bool>(hold != 0);
}

std::optional<std::uint32_t> Requests::take_ratio(PieceClass piece_class) {
  const std::uint32_t ratio = ratio_[static_cast<std::size_t>(piece_class)].exchange(kNoRatio);
  return ratio > kFullRatio ? std::nullopt : std::optional<std::uint32_t>(ratio);
}

void serve_requests(Card& card) {
  Requests& requests = card.parts().requests;
  card.parts().watchdog.look();
  if (requests.take_abort()) {
    requests.take_hold();
    requests.take_stop();
    card.abort();
    throw StateError("card: aborted, as another thread has asked for");
  }
  if (requests.take_stop()) stop_on_request(card, "as another thread has asked for");
  if (interrupted()) {
    const StopForInterrupt stopping;
    stop_on_request(card, "because the call was interrupted");
  }
  if (const auto hold = requests.take_hold()) card.set_hold(*hold);
  for (const PieceClass piece_class : {PieceClass::kFeed, PieceClass::kRapid, PieceClass::kFixed}) {
    const auto ratio = requests.take_ratio(piece_class);
    const bool there = piece_class == PieceClass::kFeed || card.parts().time_base.has_classes();
    if (ratio && there) card.set_ratio(piece_class, *ratio);
  }
}

}  // namespace trammel::driver
