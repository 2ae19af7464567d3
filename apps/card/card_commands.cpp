#include "card_commands.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/card_choice.hpp"
#include "common/engine_options.hpp"
#include "common/errors.hpp"
#include "common/machine_choice.hpp"
#include "common/standard_streams.hpp"
#include "common/terminal.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/run/assigned_inputs.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/sim/engines.hpp"

namespace trammel::app {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
using driver::Card;

struct LookOptions {
  CardChoice card;
  double interval = 0.2;     // monitor: seconds of card time
  std::uint64_t looks = 0;   // monitor: number of updates; 0: no limit
  unsigned exchanges = 200;  // selftest
  bool inputs = false;       // selftest: wait for switches,
  double switch_time = 30;   // at most this many seconds for each
  MachineChoice machine;     // for drives
  std::string order;
};

// Uses the card of --card, or a simulated card that is created only for this command.
template <class Use>
void look_at(const CardChoice& choice, Purpose purpose, Use use) {
  if (const auto url = choice.url()) {
    return with_card(*url, purpose, [&](Card& card, transport::Connection& connection) {
      use(card, connection.frames() != nullptr ? &connection : nullptr);
    });
  }
  sim::SimulationOptions options;
  const auto engine = sim::make_engine(options);
  Card card = Card::open(*engine);
  use(card, static_cast<transport::Connection*>(nullptr));
}

// --- dump ---

bool is_there(const map::Register& entry, const driver::Identification& card) {
  return map::has_engine(card.engines, entry.engine);
}

void dump(Card& card) {
  card.read_snapshot();
  std::vector<std::pair<std::uint32_t, std::string>> lines;
  for (const map::Register& entry : map::kRegisters) {
    if (entry.access == map::Access::Command || !is_there(entry, card.identification())) continue;
    const std::uint32_t slots = entry.only_present_axes ? card.identification().axes : entry.count;
    for (std::uint32_t i = 0; i < slots; ++i) {
      const std::uint32_t address = map::slot_address(entry, i);
      const std::uint32_t value = card.parts().registers.read(address);
      const std::string name = entry.count > 1 ? fmt::format("{}[{}]", entry.name, i) : std::string(entry.name);
      lines.emplace_back(address, fmt::format("0x{:03X}  {:<20} 0x{:08X}  {}\n", address, name, value, value));
    }
  }
  std::sort(lines.begin(), lines.end());
  for (const auto& [address, line] : lines) to_standard_output(line);
}

// --- monitor ---

std::string state_of(const driver::Snapshot& now) {
  const driver::Status& s = now.status;
  std::string text = s.busy ? "busy" : "idle";
  const auto add = [&](bool flag, const char* word) { text += flag ? std::string(", ") + word : std::string(); };
  add(s.direct, "a line in direct mode");
  add(s.path_active, "on a path");
  add(s.held, "held");
  add(s.button_hold, "held by the feed hold button until cycle start");
  add(s.stopping, "stopping");
  add(s.waiting, "waiting for an input");
  add(s.probed, "probed");
  add(s.ended, "ended");
  add(s.refused, "refused");
  if (s.faulted) text += ", FAULT: " + driver::describe_faults(now.faults);
  return text;
}

bool switches_drives(const Card& card) { return map::has_engine(card.identification().engines, map::engine::kEnables); }

// For a card that switches drives.
std::string drives_text(Card& card, const driver::Status& now) {
  const bool any = card.parts().registers.read(reg::kEnableAxes) != 0;
  return fmt::format("drives   {}{}{}", now.enabled ? "enabled" : "disabled",
                     now.enable_waits ? ", motion waits for them" : "",
                     any ? "" : " (of no axis; motion does not wait for drives)");
}

// A line for each input that has a role.
void add_inputs(Card& card, const std::vector<run::AssignedInput>& assigned, std::vector<std::string>& lines) {
  if (assigned.empty()) return;
  const std::uint32_t levels = card.read_inputs();
  const std::uint32_t raw = card.read_raw_inputs();
  for (const run::AssignedInput& input : assigned) {
    const bool active = (levels >> input.input & 1) != 0;
    const bool settled = active == ((raw >> input.input & 1) != 0);
    lines.push_back(fmt::format("{:<8} {}{}", active ? "ACTIVE" : "at rest", input.text(),
                                settled ? "" : ", changing (its filter time is not over)"));
  }
}

std::vector<std::string> table(Card& card, const std::vector<run::AssignedInput>& inputs) {
  const driver::Snapshot now = card.read_snapshot();
  const driver::Identification& id = card.identification();
  std::array<driver::Access, 3> room{driver::read_of(reg::kGeometryRoom), driver::read_of(reg::kFeedRoom)};
  card.parts().registers.transfer(room.data(), 2, "monitor");
  // RATE is in 2^-32 feed ticks per enabled clock, RATIO in 2^-16.
  const double rate = static_cast<double>(now.rate) / 4294967296.0 * id.clock_hz;
  std::vector<std::string> lines;
  lines.push_back(fmt::format("time     {:.3f} s", static_cast<double>(now.time) / id.clock_hz));
  lines.push_back(fmt::format("state    {}", state_of(now)));
  if (switches_drives(card)) lines.push_back(drives_text(card, now.status));
  lines.push_back(
      fmt::format("rate     {:.0f} feed ticks/s, time base at {:.1f} %", rate, 100.0 * now.ratio / Card::kFullRatio));
  lines.push_back(
      fmt::format("begun    {} of the geometry queue, {} of the feed queue", now.geometry_begun, now.feed_begun));
  lines.push_back(
      fmt::format("queued   {} and {} halfwords", id.geometry_depth - room[0].data, id.feed_depth - room[1].data));
  for (unsigned axis = 0; axis < id.axes; ++axis) {
    lines.push_back(fmt::format("axis {}   pulse {}", axis, now.position[axis]));
  }
  add_inputs(card, inputs, lines);
  return lines;
}

// On a terminal the table is updated in place; elsewhere the tables are printed one after the other.
void monitor(Card& card, const LookOptions& options) {
  const bool terminal = ::isatty(STDOUT_FILENO) == 1;
  const std::chrono::nanoseconds pause(static_cast<std::int64_t>(options.interval * 1e9));
  const std::vector<run::AssignedInput> inputs = run::assigned_inputs(card);
  for (std::uint64_t look = 0; options.looks == 0 || look < options.looks; ++look) {
    if (look != 0) card.bus().sleep(pause);
    const std::vector<std::string> lines = table(card, inputs);
    if (terminal && look != 0) to_standard_output(fmt::format("\x1b[{}A", lines.size()));
    for (const std::string& line : lines) to_standard_output(fmt::format("{}{}\n", line, terminal ? "\x1b[K" : ""));
    if (!terminal) to_standard_output("\n");
    finish_standard_streams();
  }
}

// --- selftest ---

// Prints the tests and their results.
class Checks {
 public:
  void add(const std::string& what, const std::string& wrong, const std::string& good = "") {
    to_standard_output(fmt::format("{}  {}{}\n", wrong.empty() ? "pass" : "FAIL", what,
                                   wrong.empty() ? (good.empty() ? "" : ": " + good) : ": " + wrong));
    ++made_;
    failed_ += wrong.empty() ? 0U : 1U;
  }
  unsigned made() const { return made_; }
  unsigned failed() const { return failed_; }

 private:
  unsigned made_ = 0;
  unsigned failed_ = 0;
};

// Registers that affect no pin, queue or interrupt while the card is idle.
bool may_be_tried(const map::Register& entry) {
  constexpr std::string_view kTried[] = {"STEP_LENGTH", "STEP_SPACE", "DIR_SETUP",    "DIR_HOLD",     "HOLD_LIMIT",
                                         "SLEW",        "COUNT",      "FREQUENCY_LO", "FREQUENCY_HI", "LENGTH_LO"};
  return std::find(std::begin(kTried), std::end(kTried), entry.name) != std::end(kTried);
}

// Writes patterns and reads them back; then restores the old value.
std::string try_setting(Card& card, const map::Register& entry, std::uint32_t address) {
  const std::uint32_t before = card.parts().registers.read(address);
  std::string wrong;
  for (const std::uint32_t pattern : {0x55555555U, 0xAAAAAAAAU, 0xFFFFFFFFU, 0x00000001U}) {
    std::uint32_t value = pattern & entry.mask;
    if (entry.limited != 0) value = std::clamp(value, entry.minimum, entry.maximum);
    std::array<driver::Access, 3> accesses{driver::write_of(address, value), driver::read_of(address)};
    card.parts().registers.transfer(accesses.data(), 2, "selftest");
    if (accesses[1].data != value) wrong = fmt::format("wrote 0x{:08X}, read 0x{:08X}", value, accesses[1].data);
  }
  std::array<driver::Access, 2> back{driver::write_of(address, before)};
  card.parts().registers.transfer(back.data(), 1, "selftest");
  return wrong;
}

void try_settings(Card& card, Checks& checks) {
  const driver::Identification& id = card.identification();
  unsigned tried = 0;
  std::string wrong;
  for (const map::Register& entry : map::kRegisters) {
    if (!may_be_tried(entry) || !is_there(entry, id)) continue;
    const std::uint32_t slots = entry.only_present_axes ? id.axes : entry.count;
    for (std::uint32_t i = 0; i < slots; ++i, ++tried) {
      const std::string one = try_setting(card, entry, map::slot_address(entry, i));
      if (!one.empty()) wrong = fmt::format("{}[{}]: {}", entry.name, i, one);
    }
  }
  checks.add("registers keep what is written", wrong, fmt::format("{} registers, 4 patterns each", tried));
}

// The card must refuse the access, for the given reason.
std::string expect_refusal(Card& card, driver::Access access, map::Reason reason) {
  std::array<driver::Access, 2> accesses{access};
  try {
    card.parts().registers.transfer(accesses.data(), 1, "selftest");
    return "it was not refused";
  } catch (const driver::RefusedError& error) {
    if (error.reason() == static_cast<std::uint8_t>(reason)) return {};
    return error.what();
  }
}

void try_refusals(Card& card, Checks& checks) {
  checks.add("a write to AXES is refused",
             expect_refusal(card, driver::write_of(reg::kAxes, 1), map::Reason::ReadOnly));
  checks.add("bits without meaning in HOLD are refused",
             expect_refusal(card, driver::write_of(reg::kHold, 2), map::Reason::BadValue));
  checks.add("a write to an unused address is refused",
             expect_refusal(card, driver::write_of(0x3FC, 0), map::Reason::UnknownAddress));
}

void try_clock(Card& card, Checks& checks) {
  using Clock = std::chrono::steady_clock;
  const std::uint64_t first = card.read_snapshot().time;
  const auto begun = Clock::now();
  card.bus().sleep(std::chrono::milliseconds(200));
  const std::uint64_t clocks = card.read_snapshot().time - first;
  const double seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  checks.add("the card's clock runs", clocks == 0 ? "it did not advance in 0.2 s" : "",
             fmt::format("{:.3f} s of card time in {:.3f} s of this computer",
                         static_cast<double>(clocks) / card.identification().clock_hz, seconds));
}

void try_link(Card& card, transport::Connection* connection, unsigned exchanges, Checks& checks) {
  std::string wrong;
  const auto begun = std::chrono::steady_clock::now();
  for (unsigned i = 0; i < exchanges && wrong.empty(); ++i) {
    const std::uint32_t magic = card.parts().registers.read(reg::kMagic);
    if (magic != map::kMagicValue) wrong = fmt::format("MAGIC reads 0x{:08X}", magic);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::string good = fmt::format("{} reads, {:.2f} ms each", exchanges, 1e3 * seconds / exchanges);
  if (connection != nullptr) {
    const driver::FrameBus::Counts& counts = connection->frames()->counts();
    good += fmt::format(", {} requests sent again", counts.sent_again);
  }
  checks.add("the link works", wrong, good);
}

// Tests each switch in turn; the operator presses it.
void try_inputs(Card& card, const LookOptions& options, Checks& checks) {
  const std::vector<run::AssignedInput> inputs = run::assigned_inputs(card);
  if (inputs.empty()) {
    checks.add("inputs have roles",
               "no input has a role. Run a program with a machine file that has [inputs]; that sets the roles");
  }
  const std::chrono::nanoseconds longest(static_cast<std::int64_t>(options.switch_time * 1e9));
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const run::SwitchResult result = run::try_switch(card, inputs[i].input, longest, [&](run::SwitchStep step) {
      to_standard_output(fmt::format("wait  {} of {}: {} {}, for {:g} s\n", i + 1, inputs.size(),
                                     step == run::SwitchStep::kPress ? "press" : "release", inputs[i].text(),
                                     options.switch_time));
      finish_standard_streams();
    });
    constexpr const char* kWrong[] = {
        "", "it is active before it is pressed. Check `normally` and `closed_level` in the machine file",
        "it was not pressed", "it was not released"};
    checks.add(inputs[i].text(), kWrong[static_cast<unsigned>(result)], "active when pressed, then at rest");
  }
}

void selftest(Card& card, transport::Connection* connection, const LookOptions& options) {
  const driver::Status status = card.read_status();
  if (status.busy) throw UsageError("selftest: the card is busy. Test it when it is idle");
  Checks checks;
  const driver::Identification& id = card.identification();
  checks.add("the card identifies itself", "",
             fmt::format("{} axes, {} Hz, map {}.{}", id.axes, id.clock_hz, id.map_major, id.map_minor));
  checks.add("the card has no fault", status.faulted ? card.read_fault_text() : "");
  const driver::Snapshot before = card.read_snapshot();
  try_link(card, connection, options.exchanges, checks);
  try_clock(card, checks);
  try_settings(card, checks);
  try_refusals(card, checks);
  if (options.inputs) try_inputs(card, options, checks);
  const driver::Snapshot after = card.read_snapshot();
  checks.add("nothing has moved", after.position == before.position && !after.status.busy ? "" : "a position changed");
  if (checks.failed() != 0) {
    throw std::runtime_error(fmt::format("selftest: {} of {} checks failed", checks.failed(), checks.made()));
  }
  to_standard_output(fmt::format("{} checks passed\n", checks.made()));
}

// --- drives ---

// The order ENABLE.on stays in force until it is revoked, even if no program runs.
void order_drives(Card& card, const machine::Machine& machine, const std::string& order) {
  if (!switches_drives(card)) throw UsageError("drives: this card has no outputs for drives (engine enables)");
  const driver::Status before = card.read_status();
  if (!before.busy) run::configure_outputs(card, machine);
  if (card.parts().registers.read(reg::kEnableAxes) == 0) {
    throw UsageError(
        "drives: the card switches the drive of no axis. Name an output `enable` in [outputs] of the machine file "
        "(--machine)");
  }
  if (order == "on" && card.read_faults() != 0) {
    throw UsageError("drives: " + card.read_fault_text() + ": `trammel recover` says what to do first");
  }
  if (order == "off" && before.busy)
    throw UsageError("drives: the card is moving, or holds in a motion. Give `off` when it is at rest");
  card.enable(order == "on");
}

void drives(const LookOptions& options) {
  const auto url = options.card.url();
  if (!url) throw UsageError("drives: needs --card, because a card that this command simulates has no drives");
  const machine::Machine machine = options.machine.load();
  const Purpose purpose = options.order.empty() ? Purpose::kRead : Purpose::kMove;
  with_card(*url, purpose, [&](Card& card, transport::Connection&) {
    if (!options.order.empty()) order_drives(card, machine, options.order);
    if (!switches_drives(card)) return to_standard_output("this card switches no drives\n");
    const std::uint32_t enable = card.parts().registers.read(reg::kEnable);
    to_standard_output(drives_text(card, card.read_status()) + "\n");
    const bool on = (enable & map::field::kEnableOn) != 0;
    const bool manual = (enable & map::field::kEnableManual) != 0;
    to_standard_output(fmt::format("order    {}\n", on       ? "on: they stay enabled"
                                                    : manual ? "off: motion waits for `trammel drives on`"
                                                             : "off: motion enables them"));
  });
}

void add_drives_command(CLI::App& app, const std::shared_ptr<LookOptions>& options) {
  CLI::App* command = app.add_subcommand(
      "drives", "show whether the drives of an external card are enabled, enable them (on), or end that order (off)");
  options->machine.add_to(*command);
  options->card.add_to(*command);
  command
      ->add_option("order", options->order,
                   "on: enable the drives until `trammel drives off`, also while nothing moves. off: end that order "
                   "(default: show the state)")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("ORDER");
  command->callback([options] { drives(*options); });
}

}  // namespace

void add_card_commands(CLI::App& app) {
  auto options = std::make_shared<LookOptions>();
  add_drives_command(app, options);
  CLI::App* dump_command = app.add_subcommand("dump", "print all registers of a card by name");
  options->card.add_to(*dump_command);
  dump_command->callback(
      [options] { look_at(options->card, Purpose::kRead, [](Card& card, transport::Connection*) { dump(card); }); });
  CLI::App* monitor_command =
      app.add_subcommand("monitor", "show a card's state, queues, positions and inputs in a table that is updated");
  options->card.add_to(*monitor_command);
  monitor_command->add_option("--interval", options->interval, "time between two updates, seconds of card time")
      ->check(CLI::Range(0.001, 3600.0).description(""))
      ->type_name("SECONDS")
      ->capture_default_str();
  monitor_command->add_option("--looks", options->looks, "end after this number of updates. 0 is no limit")
      ->transform(whole_number(0, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  monitor_command->callback([options] {
    if (!options->card.url()) tell("note", "this is a fresh simulated card, at rest; --card shows another one");
    look_at(options->card, Purpose::kRead, [&](Card& card, transport::Connection*) { monitor(card, *options); });
  });
  CLI::App* test_command = app.add_subcommand("selftest", "test a card's link, registers and clock; nothing moves");
  options->card.add_to(*test_command);
  test_command->add_flag(
      "--inputs", options->inputs,
      "also test the inputs that have a role: for each, wait until you have pressed and released it");
  test_command
      ->add_option("--switch-time", options->switch_time,
                   "with --inputs: longest wait for a press or a release, seconds of card time")
      ->check(CLI::Range(0.001, 3600.0).description(""))
      ->type_name("SECONDS")
      ->capture_default_str();
  test_command->callback([options] {
    look_at(options->card, Purpose::kMove,
            [&](Card& card, transport::Connection* connection) { selftest(card, connection, *options); });
  });
}

}  // namespace trammel::app
