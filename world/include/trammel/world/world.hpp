// A simulated machine behind the card's pins: carriages that the card's pulses move, and the switches and buttons at
// its inputs. Its time is the card's, in clocks; only pulse() and run_to() advance it. EngineInWorld connects it to a
// simulated card. One thread per object; allocates nothing after construction.
//
// Motion is integrated in steps of 20 microseconds or slightly less, which start at whole clocks. A switch is pressed
// or released at the end of such a step. Bounces and events may occur at any clock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trammel/world/description.hpp"
#include "trammel/world/watcher.hpp"

namespace trammel::world {

class World {
 public:
  // Everything is at rest at clock 0, each carriage at pulse 0. Switches that are pressed there are pressed from the
  // start, without bounces. Throws std::invalid_argument, which names the part, for parts out of range, two parts at
  // one input or with one name, and events of unknown buttons.
  World(const Description& description, std::uint32_t clock_hz);

  // A pulse of the card's axis (0 to 7) in this clock; direction: +1 or -1. No effect if the axis has no carriage.
  void pulse(std::uint64_t clock, unsigned card_axis, int direction);
  // Simulates up to `clock`; no effect for a clock in the past.
  void run_to(std::uint64_t clock);
  std::uint64_t now() const { return now_; }  // clocks
  std::uint32_t clock_hz() const { return clock_hz_; }
  // Up to this clock, which is later than now(), no pin changes, whatever pulses come. A press may make it earlier.
  std::uint64_t quiet_until() const;

  // Sets the watcher, also for copies of the world; nullptr removes it. Not owned.
  void set_watcher(Watcher* watcher) { watcher_ = watcher; }

  // The present levels of the card's pins; bit n: input n.
  std::uint32_t wired() const { return wired_; }    // inputs that are wired
  std::uint32_t levels() const { return levels_; }  // 0 for unwired inputs
  bool emergency_stop() const { return emergency_stop_; }
  bool has_emergency_stop() const { return has_emergency_stop_; }

  // Press or release now. Both throw std::invalid_argument, with the existing names, for a name that is not a button.
  // Names of switches are not accepted: carriages press these.
  void press(const std::string& button) { set(button, true); }
  void release(const std::string& button) { set(button, false); }
  bool pressed(const std::string& button_or_switch) const;  // throws for an unknown name
  std::vector<std::string> pressed() const;                 // names of the pressed switches and buttons
  void require_button(const std::string& name) const { find_button(name); }  // throws as press() does

  struct ContactState {
    std::string name;
    std::optional<unsigned> input;  // nullopt: the emergency stop's pin
    bool is_button = false;         // true: a button; false: a switch, which a carriage presses
    bool pressed = false;
  };
  std::vector<ContactState> contacts() const;  // switches, then buttons, in the order of the description

  // By index of the description's axes.
  std::size_t axes() const { return axes_.size(); }
  const AxisDescription& axis(std::size_t n) const { return axes_[n].description; }
  const Carriage& carriage(std::size_t n) const { return axes_[n].carriage; }

 private:
  struct Axis {
    AxisDescription description;
    Carriage carriage;
    std::size_t alarm;  // index of its alarm button, or kNone
  };
  struct Switch {
    SwitchDescription description;
    Contact contact;
    bool pressed_at(double place) const;
    std::int64_t edge() const;  // position of its next change, pulses
  };
  struct Button {
    ButtonDescription description;
    Contact contact;
    std::uint64_t cut_at = UINT64_MAX;  // clock at which it cuts the power; UINT64_MAX while it is released
  };
  struct Due {
    std::uint64_t clock;
    std::size_t button;
    bool press;
  };
  static constexpr std::size_t kNone = SIZE_MAX;

  void add_axes(const Description& description);
  void add_contacts(const Description& description);
  void add_events(const Description& description);
  void wire(const std::string& name, unsigned input);
  std::size_t find_button(const std::string& name) const;
  void set(const std::string& button, bool pressed) { set(find_button(button), pressed); }
  void set(std::size_t button, bool pressed);
  void make_events();
  void move();
  void watch(Axis& axis);
  void time_power(Button& button, bool pressed);
  void switch_power();
  void show_pins();
  std::uint64_t next_boundary() const { return (now_ / step_clocks_ + 1) * step_clocks_; }

  std::uint32_t clock_hz_;
  bool closed_level_;
  std::uint64_t step_clocks_;  // clocks per integration step
  unsigned parts_;             // divisions of a step, if a clock is longer than kLongestStep
  double part_;                // duration of a division, s
  std::vector<Axis> axes_;
  std::vector<Switch> switches_;
  std::vector<Button> buttons_;
  std::vector<Due> events_;  // by rising clock
  std::size_t next_event_ = 0;
  std::uint64_t now_ = 0;
  std::uint64_t step_due_ = UINT64_MAX;     // clock of the next integration step; UINT64_MAX: all at rest
  std::uint64_t contact_due_ = UINT64_MAX;  // clock of the next bounce
  std::uint64_t power_due_ = UINT64_MAX;    // clock of the next loss of power
  bool watches_ = false;                    // a drive monitors its motor
  std::uint32_t wired_ = 0;
  std::uint32_t levels_ = 0;
  bool emergency_stop_ = false;
  bool has_emergency_stop_ = false;
  Watcher* watcher_ = nullptr;
};

}  // namespace trammel::world
