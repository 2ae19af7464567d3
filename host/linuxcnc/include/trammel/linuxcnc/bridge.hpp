// Between LinuxCNC's realtime modules and the card: takes the periods of the HAL component, moves the card by them, and
// tells what the card does. While a period asks for the path, a PathSide moves the card.
//
// What starts motion. A stream opens when a period with ENABLE follows one without it, seen by this owner, and nothing
// stands uncleared. So neither a clear, nor a new owner, nor one that wakes up late, moves anything by itself.
// What stops it. A disabled machine stops at its last target where that is at rest, else on the card's ramp. A fault of
// the card, a missing period, and a target that the driver refuses stop it likewise; cause and place stay in the status
// until a period with CLEAR. A missing period at rest is counted and forgotten: nothing was lost.
//
// Thread-safety: one thread, which uses the card as well.
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
  std::function<void(const std::string&)> note;  // told who has come and gone, and what stopped the card
  ServoRecord* record = nullptr;
};

class Bridge {
 public:
  static constexpr std::chrono::milliseconds kTurn{1};

  // Sets the card up by the machine file, and gives it a place where it has none. `card` is open on `bus`, stands, and
  // is not faulted; all must outlive the bridge. Throws driver::Error.
  Bridge(Region& region, driver::Card& card, run::AttentiveBus& bus, const machine::Machine& machine, PathSide& path,
         BridgeOptions options = {});

  // Turns until `ended` is true; the card stands then. Throws driver::LinkError; TimeoutError where it does not stand.
  void run(const std::function<bool()>& ended);
  // One turn: waits at most so long (of the host's time) for a period, moves the card, publishes.
  void turn(std::chrono::nanoseconds longest);
  // Stops the card as for a disabled machine.
  void stop();

  const trammel_status& status() const { return status_; }

 private:
  void set_up();
  void take_periods();
  void take(const trammel_period& period);
  void take_enabled(const trammel_period& period);
  void take_settings();
  void serve_path();
  bool path_turn();
  void open();
  void close(bool ramp = false);
  void waiting(const std::function<void()>& call);
  void set_hold(bool hold);
  void clear();
  void come_back_at_once();
  // Calls `call`, and makes what it throws the cause of a stop.
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
  bool stopped_ = false;      // by something that was not cleared yet
  bool armed_ = false;        // a period without ENABLE has come since
  bool path_wanted_ = false;  // of the last period, likewise
  bool holding_ = false;      // by this bridge
  bool clear_seen_ = false;   // the last period had CLEAR
  bool inside_ = false;       // of a call that waits: periods are looked at, and move nothing
  std::uint32_t last_flags_ = 0;
  std::uint32_t index_refused_ = 0;
  bool hal_there_ = false;
  bool planner_there_ = false;
  std::function<bool()> ended_;
};

}  // namespace trammel::linuxcnc
