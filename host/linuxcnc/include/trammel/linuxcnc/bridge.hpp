// Connects LinuxCNC's realtime modules to the card: takes the periods of the HAL component, moves the card by them, and
// reports the card's state. While a period requests the path, a PathSide moves the card.
//
// Start of motion: a stream opens when this owner has seen a period without ENABLE followed by one with it, and no stop
// is uncleared. Therefore neither a clear, nor a new owner, nor an owner that wakes up late starts a motion by itself.
// Stop of motion: a disabled machine stops at its last target if that is at rest, otherwise on the card's ramp. A fault
// of the card, a missing period, and a target that the driver refuses stop it as well; cause and position stay in the
// status until a period with CLEAR. A missing period at rest is counted and otherwise ignored, because nothing was
// lost.
//
// Thread safety: one thread, which also uses the card.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "trammel/driver/card.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/linuxcnc/card_look.hpp"
#include "trammel/linuxcnc/path_side.hpp"
#include "trammel/linuxcnc/region.hpp"
#include "trammel/linuxcnc/servo_stream.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/attentive_bus.hpp"

namespace trammel::linuxcnc {

struct BridgeOptions {
  std::function<void(const std::string&)> note;  // gets messages: connections of modules, and reasons of stops
  ServoRecord* record = nullptr;
};

class Bridge {
 public:
  static constexpr std::chrono::milliseconds kTurn{1};

  // Configures the card for the machine file, and gives it a place if it has none. `card` is open on `bus`, at rest and
  // without a fault; all must outlive the bridge. Throws driver::Error.
  Bridge(Region& region, driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine, PathSide& path,
         BridgeOptions options = {});

  // Turns until `ended` returns true; then the card is at rest. Throws driver::LinkError, and TimeoutError if the card
  // does not come to rest.
  void run(const std::function<bool()>& ended);
  // One turn: waits for a period for at most `longest` of the host's time, moves the card, publishes the status.
  void turn(std::chrono::nanoseconds longest);
  // Stops the card as for a disabled machine.
  void stop();

  const trammel_status& status() const { return status_; }

 private:
  void set_up();
  void take_periods();
  void take(const trammel_period& period);
  void take_enabled(const trammel_period& period);
  void ignore(const std::string& why);
  void take_settings();
  void serve_path();
  bool path_turn();
  void open();
  void close(bool ramp = false);
  void waiting(const std::function<void()>& call);
  void set_hold(bool hold);
  void clear();
  void come_back_at_once();
  // Calls `call`, and makes its exception the cause of a stop.
  void guarded(const std::function<void()>& call);
  void stopped_by_fault(std::uint32_t faults);
  void stopped_by(std::uint32_t cause, const std::string& text);
  void set_stopped(std::uint32_t cause, const CardLook::Pulses& at, const std::string& text);
  void set_text(const std::string& text);
  void publish();
  void tell_who_is_there();
  void tell(const std::string& text) const;

  Region& region_;
  driver::Card& card_;
  run::AttentiveBus& bus_;
  const machine::Machine machine_;
  PathSide& path_;
  BridgeOptions options_;
  std::optional<CardLook> look_;
  ServoStream stream_;
  std::optional<driver::WatchdogScope> watchdog_;
  trammel_settings settings_{};
  bool settings_came_ = false;
  trammel_status status_{};
  bool stopped_ = false;      // stopped by a cause that is not cleared yet
  bool armed_ = false;        // a period without ENABLE has arrived since the last stop
  bool path_wanted_ = false;  // the last period requests the path, and armed_ permits it
  bool holding_ = false;      // this bridge has set the hold
  bool clear_seen_ = false;   // the last period had CLEAR
  bool inside_ = false;       // in a call that waits: periods are read, but move nothing
  unsigned ignored_ = 0;      // periods of a machine that is on and is not followed, without a break
  std::uint32_t last_flags_ = 0;
  std::uint32_t index_refused_ = 0;
  bool hal_there_ = false;
  bool planner_there_ = false;
  std::function<bool()> ended_;
};

}  // namespace trammel::linuxcnc
