#include "card_choice.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <memory>

#include "errors.hpp"
#include "stop_text.hpp"
#include "terminal.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"

namespace trammel::app {
namespace {

constexpr const char* kTokenHint = "give the token that `trammel serve` printed, as ?token=... or in TRAMMEL_TOKEN";

// Converts errors of the link and the card's identification, before any motion, to UsageError.
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

// A client that presents the token is refused while another one moves the card, and its disconnection makes the card
// hold. So a reading client never presents it, even if it is in the URL.
transport::CardUrl with_token(transport::CardUrl url, Purpose purpose) {
  if (purpose == Purpose::kRead) url.token.clear();
  const char* const token = std::getenv("TRAMMEL_TOKEN");
  const bool wants_one = purpose == Purpose::kMove && url.kind == transport::CardUrl::Kind::kTcp && url.token.empty();
  if (wants_one && token != nullptr) url.token = token;
  return url;
}

// Position and remedy for a card with a fault. The card may still be on its ramp.
std::string place_and_cure(driver::Card& card, const machine::Machine& machine) {
  try {
    card.wait_until_stopped();
  } catch (const driver::TimeoutError&) {  // the text says that the card is on its ramp
  }
  return stop_text(machine, read_stopped(card));
}

std::string lost_link_text(double watchdog) {
  const std::string stops =
      watchdog != 0 ? fmt::format("the card stops on the path, by its watchdog of {:g} s at the latest", watchdog)
                    : "without a watchdog the card stops only where `trammel serve` sees the link close";
  return fmt::format(
      "the link to the card is lost; {}. When the link is back, `trammel recover` says where it stands. A link that is "
      "only slow needs `timeout=MS` in the URL",
      stops);
}

void clear_with_note(driver::Card& card) {
  const std::string faults = card.read_fault_text();
  card.clear_faults();
  if ((card.read_faults() & card_map::field::kFaultEmergencyStop) != 0) {
    throw UsageError("--card: the emergency stop is pressed: release its button first");
  }
  tell("note", "cleared the card's earlier fault: " + faults);
}

}  // namespace

void CardChoice::add_to(CLI::App& command) {
  command
      .add_option("--card", text,
                  "use an external card: tcp://HOST:PORT (of `trammel serve`), serial:/dev/ttyUSB0, spi:/dev/spidev0.0 "
                  "or mmap:/dev/uio0 (default: sim:, a card that this command simulates)")
      ->type_name("URL");
}

void CardChoice::add_to_mover(CLI::App& command) {
  add_to(command);
  command.add_flag("--clear-faults", clear_faults,
                   "with --card: clear the card's faults first, and begin where the machine stands. Needed after a "
                   "fault has stopped the card");
  command.add_flag(
      "--trust-position", trust_position,
      "with --card: begin although the card marks its position as lost. Use it only if you know that no step was lost");
  command
      .add_option("--resume-file", resume_file,
                  "with --card: file in which a run keeps what --resume needs (default: a file named after the card, "
                  "in trammel/ of the user's state folder)")
      ->type_name("FILE");
}

std::optional<transport::CardUrl> CardChoice::url() const {
  if (!text || *text == "sim:") {
    if (clear_faults)
      throw UsageError(
          "--clear-faults: needs --card, because a card that this command simulates has no earlier faults");
    if (trust_position)
      throw UsageError(
          "--trust-position: needs --card, because a card that this command simulates has lost no position");
    if (resume_file)
      throw UsageError(
          "--resume-file: needs --card, because a run on a card that this command simulates cannot be resumed");
    return std::nullopt;
  }
  try {
    const transport::CardUrl url = transport::parse_card_url(*text);
    if (url.kind == transport::CardUrl::Kind::kSim) {
      throw UsageError("--card sim: takes no options here. Give --axes, --clock or --engine instead");
    }
    return url;
  } catch (const driver::ArgumentError& error) {
    throw UsageError(fmt::format("--card: {}", error.what()));
  }
}

ResumeFile CardChoice::resume() const { return {url()->text, resume_file}; }

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
    // A card gives the reason; a server that got no hello with a request for motion cannot.
    const bool silent = url.kind == transport::CardUrl::Kind::kSerial || !url.hello;
    if (error.reason() != 0 || !silent || !url.token.empty()) throw;
    throw UsageError(fmt::format("--card {}: the card refuses commands that move it: {}", url.text, kTokenHint));
  }
}

void match_axes(driver::Card& card, const machine::Machine& machine) {
  card.name_axes(run::names_of_card_axes(machine));
  const unsigned axes = card.identification().axes;
  if (machine.motors() <= axes) return;
  throw UsageError(
      fmt::format("--card: the card has {} axes, but the machine file has {} motors", axes, machine.motors()));
}

void take_over(driver::Card& card, const CardChoice& choice, const machine::Machine& machine, bool resumes) {
  try {
    const driver::Status status = card.read_status();
    constexpr std::uint32_t kSilent = card_map::field::kFaultWatchdog | card_map::field::kFaultLinkLoss;
    const bool silent_host = status.faulted && (card.read_faults() & ~kSilent) == 0;
    if (!choice.clear_faults && !(resumes && silent_host)) card.parts().registers.throw_if_faulted(status, "--card");
    if (card.take_over()) {
      tell("note", "the card was holding in an earlier motion; the rest of that motion is dropped");
    }
    keep_place_of_stop(card, choice.resume());
    if (status.faulted) clear_with_note(card);
  } catch (const driver::FaultError& error) {
    throw UsageError(fmt::format("{}; {}", error.what(), place_and_cure(card, machine)));
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

void limit_patience(transport::Connection& connection, const machine::MotionSettings& motion) {
  constexpr std::chrono::seconds kForSlowLinks(1);
  if (motion.watchdog != 0) connection.set_patience(run::watchdog_time(motion) + kForSlowLinks);
}

void tell_of_stop(driver::Card& card, const transport::Connection& connection,
                  const machine::Machine& machine) noexcept {
  try {
    if (connection.lost()) tell("note", lost_link_text(machine.motion.watchdog));
    if (card.read_status().faulted) tell("note", place_and_cure(card, machine));
  } catch (const std::exception&) {
  }
}

void refuse_with_card(const CardChoice& card, const char* option, bool given) {
  if (given)
    throw UsageError(
        fmt::format("{}: works only on a card that this command simulates, not with --card {}", option, *card.text));
}

}  // namespace trammel::app
