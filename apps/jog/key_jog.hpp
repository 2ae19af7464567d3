// Moves axes with the keys of a terminal: by a step per key, or for as long as a key is held.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "jog_keys.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/jog.hpp"

namespace trammel::app {

// Executes the keys from one reading of the terminal. The card is configured, and nothing else moves it. Not
// thread-safe.
class KeyJog {
 public:
  // `speed`: limit of each axis in mm/s (degrees/s); none: a quarter of the axis's max_velocity.
  KeyJog(driver::Card& card, const machine::Machine& machine, run::MachinePosition& position,
         std::optional<double> speed)
      : machine_(machine), position_(position), jog_(card, machine, position), speed_(speed) {}

  // Throws as run::Jog does, except for a motion that is refused: note() gives the reason.
  void keys(const std::vector<JogKey>& keys, DeadMan::Time now);
  // Call between two readings of the keys. Returns whether an axis moves. When a held key is released, its motion ends
  // on a ramp.
  bool look(DeadMan::Time now);
  // Starts a ramp to a stop; look() returns false when it has ended.
  void stop();

  // Whether the key for the end was pressed.
  bool ended() const { return ended_; }
  // Position, step and speed, in one line for a terminal.
  std::string line() const;
  // The reason why the last key had no effect; empty if it had one.
  const std::string& note() const { return note_; }

 private:
  void key(const JogKey& key, DeadMan::Time now);
  void move(const JogKey& key, DeadMan::Time now);
  double speed_of(std::size_t axis) const;

  const machine::Machine& machine_;
  run::MachinePosition& position_;
  run::Jog jog_;
  std::optional<double> speed_;
  double share_ = 1;   // fraction of the speed
  unsigned step_ = 3;  // 0: for as long as the key is held
  DeadMan dead_man_;
  std::optional<JogKey> moving_;  // the key that started the current motion
  bool while_held_ = false;       // the current motion lasts while its key is held, even if the step has changed
  bool stopping_ = false;
  bool ended_ = false;
  std::string note_;
};

}  // namespace trammel::app
