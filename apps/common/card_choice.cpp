#include "card_choice.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>

#include "errors.hpp"
#include "terminal.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::app {
namespace {

constexpr const char* kTokenHint = "give the token that `trammel serve` printed, as ?token=... or in TRAMMEL_TOKEN";

// Where the link or the card is not what it should be, before anything has moved.
template <class Call>
auto opening(const transport::CardUrl& url, Call call) {
  try {
    return call();
  } catch (const driver::IdentificationError& error) {
    throw UsageError(fmt::format("--card {}: {}", url.text, error.what()));
  } catch (const driver::LinkError& error) {
    throw UsageError(fmt::format("--card: {}", error.what()));
  }
}

// Who comes with a token makes the card hold when he goes: so reading does without it.
transport::CardUrl with_token(transport::CardUrl url, Purpose purpose) {
  const char* const token = std::getenv("TRAMMEL_TOKEN");
  const bool wants_one = purpose == Purpose::kMove && url.kind == transport::CardUrl::Kind::kTcp && url.token.empty();
  if (wants_one && token != nullptr) url.token = token;
  return url;
}

}  // namespace

void CardChoice::add_to(CLI::App& command) {
  command
      .add_option("--card", text,
                  "a card outside: tcp://HOST:PORT (of `trammel serve`), serial:/dev/ttyUSB0, spi:/dev/spidev0.0, "
                  "mmap:/dev/uio0 (default: sim:, simulated here)")
      ->type_name("URL");
}

std::optional<transport::CardUrl> CardChoice::url() const {
  if (!text) return std::nullopt;
  try {
    const transport::CardUrl url = transport::parse_card_url(*text);
    if (url.kind == transport::CardUrl::Kind::kSim) {
      if (url.text != "sim:") throw UsageError("--card sim: takes no options here: --axes, --clock and --engine do");
      return std::nullopt;
    }
    return url;
  } catch (const driver::ArgumentError& error) {
    throw UsageError(fmt::format("--card: {}", error.what()));
  }
}

void with_card(const transport::CardUrl& place, Purpose purpose,
               const std::function<void(driver::Card&, transport::Connection&)>& use) {
  const transport::CardUrl url = with_token(place, purpose);
  const auto connection = opening(url, [&] { return std::make_unique<transport::Connection>(url); });
  driver::Card card = opening(url, [&] { return driver::Card::open(connection->bus()); });
  if (purpose == Purpose::kMove && !connection->may_move()) {
    throw UsageError(
        fmt::format("--card {}: the server lets nobody move it without its token: {}", url.text, kTokenHint));
  }
  try {
    use(card, *connection);
  } catch (const driver::RefusedError& error) {
    // A card says why; a server that was not asked for motion with a hello cannot.
    const bool silent = url.kind == transport::CardUrl::Kind::kSerial || !url.hello;
    if (error.reason() != 0 || !silent || !url.token.empty()) throw;
    throw UsageError(fmt::format("--card {}: it refuses what moves it: {}", url.text, kTokenHint));
  }
}

void take_over(driver::Card& card) {
  try {
    if (card.take_over()) {
      tell("note", "the card held with a motion of before under way; what was left is dropped");
    }
  } catch (const driver::StateError& error) {
    throw UsageError(error.what());
  }
}

void refuse_with_card(const CardChoice& card, const char* option, bool given) {
  if (given) throw UsageError(fmt::format("{}: of the simulated card alone, not with --card {}", option, *card.text));
}

}  // namespace trammel::app
