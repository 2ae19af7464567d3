#include "card_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <memory>

#include "errors.hpp"
#include "terminal.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/configure.hpp"

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

// Of a card that has stopped with a fault. Its ramp may still be under way.
std::string place_and_cure(driver::Card& card) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::seconds(10);
  while (card.busy() && Clock::now() < until) card.bus().sleep(std::chrono::milliseconds(5));
  const driver::Snapshot now = card.read_snapshot();
  const auto* const first = now.position.begin();
  return fmt::format("the card {} pulse {} of its axes; clear the fault with --clear-faults to go on from there",
                     now.status.busy ? "is on its ramp, at" : "stands at",
                     fmt::join(first, first + card.identification().axes, ", "));
}

void clear_with_note(driver::Card& card) {
  const std::uint32_t faults = card.read_faults();
  card.clear_faults();
  tell("note", fmt::format("cleared the card's fault of before: {}", driver::describe_faults(faults)));
}

}  // namespace

void CardChoice::add_to(CLI::App& command) {
  command
      .add_option("--card", text,
                  "a card outside: tcp://HOST:PORT (of `trammel serve`), serial:/dev/ttyUSB0, spi:/dev/spidev0.0, "
                  "mmap:/dev/uio0 (default: sim:, simulated here)")
      ->type_name("URL");
}

void CardChoice::add_to_mover(CLI::App& command) {
  add_to(command);
  command.add_flag("--clear-faults", clear_faults, "with --card: clear the faults that the card has from before");
}

std::optional<transport::CardUrl> CardChoice::url() const {
  if (!text || *text == "sim:") {
    if (clear_faults) throw UsageError("--clear-faults: a simulated card has none from before; give it with --card");
    return std::nullopt;
  }
  try {
    const transport::CardUrl url = transport::parse_card_url(*text);
    if (url.kind == transport::CardUrl::Kind::kSim) {
      throw UsageError("--card sim: takes no options here: --axes, --clock and --engine do");
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

void take_over(driver::Card& card, bool clear_faults) {
  try {
    const driver::Status status = card.read_status();
    if (!clear_faults) card.parts().registers.throw_if_faulted(status, "--card");
    if (card.take_over()) {
      tell("note", "the card held with a motion of before under way; what was left is dropped");
    }
    if (status.faulted) clear_with_note(card);
  } catch (const driver::FaultError& error) {
    throw UsageError(fmt::format("{}; {}", error.what(), place_and_cure(card)));
  } catch (const driver::StateError& error) {
    throw UsageError(error.what());
  }
}

MotionWatchdog::MotionWatchdog(driver::Card& card, const machine::MotionSettings& motion) {
  try {
    scope_.emplace(card, run::watchdog_time(motion));
  } catch (const driver::ArgumentError& error) {
    throw UsageError(
        fmt::format("{}: change it by --set motion.watchdog=SECONDS or in the machine file", error.what()));
  }
}

void tell_of_fault(driver::Card& card) noexcept {
  try {
    if (card.read_status().faulted) tell("note", place_and_cure(card));
  } catch (const std::exception&) {
  }
}

void refuse_with_card(const CardChoice& card, const char* option, bool given) {
  if (given) throw UsageError(fmt::format("{}: of the simulated card alone, not with --card {}", option, *card.text));
}

}  // namespace trammel::app
