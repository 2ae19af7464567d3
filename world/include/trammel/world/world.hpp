// A simulated machine behind the card's pins: carriages that its pulses move, and the switches and buttons at its
// inputs. Its time is the card's, in clocks, and goes on by pulse() and run_to() alone. EngineInWorld connects it to a
// simulated card. One object, one thread; nothing is allocated once it is made.
//
// Motion is integrated in steps of 20 microseconds or a little less, which begin at whole clocks: a switch is pressed
// or released at the end of such a step. Bounces and events come at any clock.
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
  // All at rest at clock 0, each carriage at pulse 0; switches that are pressed there are so from the beginning,
  // without bounces. Throws std::invalid_argument, with the name of what is wrong: parts out of range, two at one input
  // or of one name, events of no button.
  World(const Description& description, std::uint32_t clock_hz);

  // A pulse of the card's axis (0 to 7) in this clock; direction: +1 or -1. Nothing where no carriage hangs on it.
  void pulse(std::uint64_t clock, unsigned card_axis, int direction);
  // What happens until then; nothing for a clock that has gone.
  void run_to(std::uint64_t clock);
  std::uint64_t now() const { return now_; }  // clocks
  std::uint32_t clock_hz() const { return clock_hz_; }
  // Until this clock, which is later than now(), no pin changes, whatever pulses come. Pressing makes it earlier.
  std::uint64_t quiet_until() const;

  // Told from now on, a copy's too: nullptr ends it. Not owned.
  void set_watcher(Watcher* watcher) { watcher_ = watcher; }

  // The card's pins as they stand now; bit n: input n.
  std::uint32_t wired() const { return wired_; }    // inputs that something is wired to
  std::uint32_t levels() const { return levels_; }  // 0 where nothing is
  bool emergency_stop() const { return emergency_stop_; }
  bool has_emergency_stop() const { return has_emergency_stop_; }

  // Now. Throw std::invalid_argument, with the names that there are, for a name that no button has. Names of switches
  // are not taken: carriages press these.
  void press(const std::string& button) { set(button, true); }
  void release(const std::string& button) { set(button, false); }
  bool pressed(const std::string& button_or_switch) const;  // throws likewise
  std::vector<std::string> pressed() const;                 // names of the switches and buttons that are
  void require_button(const std::string& name) const { find_button(name); }  // throws as press() does

  struct ContactState {
    std::string name;
    std::optional<unsigned> input;  // none: the emergency stop's pin
    bool is_button = false;         // else a switch, which a carriage presses
    bool pressed = false;
  };
  std::vector<ContactState> contacts() const;  // switches, then buttons, as the description has them

  // By index of the description's axes.
  std::size_t axes() const { return axes_.size(); }
  const AxisDescription& axis(std::size_t n) const { return axes_[n].description; }
  const Carriage& carriage(std::size_t n) const { return axes_[n].carriage; }

 private:
  struct Axis {
    AxisDescription description;
    Carriage carriage;
    std::size_t alarm;  // button; kNone
  };
  struct Switch {
    SwitchDescription description;
    Contact contact;
    bool pressed_at(double place) const;
    std::int64_t edge() const;  // place of its next change, pulses
  };
  struct Button {
    ButtonDescription description;
    Contact contact;
    std::uint64_t cut_at = UINT64_MAX;  // clock at which it takes the power; none while it is released
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
  std::uint64_t step_clocks_;  // of an integration
  unsigned parts_;             // into which it is divided, where a clock is longer than kLongestStep
  double part_;                // s
  std::vector<Axis> axes_;
  std::vector<Switch> switches_;
  std::vector<Button> buttons_;
  std::vector<Due> events_;  // in order
  std::size_t next_event_ = 0;
  std::uint64_t now_ = 0;
  std::uint64_t step_due_ = UINT64_MAX;     // clock of the next integration; none while all stand still
  std::uint64_t contact_due_ = UINT64_MAX;  // clock of the next bounce
  std::uint64_t power_due_ = UINT64_MAX;    // clock at which a button takes the power
  bool watches_ = false;                    // a drive watches its motor
  std::uint32_t wired_ = 0;
  std::uint32_t levels_ = 0;
  bool emergency_stop_ = false;
  bool has_emergency_stop_ = false;
  Watcher* watcher_ = nullptr;
};

}  // namespace trammel::world
