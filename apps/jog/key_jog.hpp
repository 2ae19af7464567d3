// Axes moved by the keys of a terminal: by a step for each key, or for as long as a key is held.
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

// What the keys of one look at the terminal do. The card is configured, and nobody else moves it. Not thread-safe.
class KeyJog {
 public:
  // At most `speed`, mm/s (degrees/s), of each axis; none: a quarter of the axis's max_velocity.
  KeyJog(driver::Card& card, const machine::Machine& machine, run::MachinePosition& position,
         std::optional<double> speed)
      : machine_(machine), position_(position), jog_(card, machine, position), speed_(speed) {}

  // Throws what run::Jog does, but for a motion that is refused: note() says why.
  void keys(const std::vector<JogKey>& keys, DeadMan::Time now);
  // Between two looks at the keys. Whether an axis moves. A held key that is released ends its motion on a ramp.
  bool look(DeadMan::Time now);
  // A ramp to a stop; look() tells when it has ended.
  void stop();

  // The key for the end has come.
  bool ended() const { return ended_; }
  // Place, step and speed, for one line of a terminal.
  std::string line() const;
  // Why the last key did nothing; empty when it did.
  const std::string& note() const { return note_; }

 private:
  void key(const JogKey& key, DeadMan::Time now);
  void move(const JogKey& key, DeadMan::Time now);
  double speed_of(std::size_t axis) const;

  const machine::Machine& machine_;
  run::MachinePosition& position_;
  run::Jog jog_;
  std::optional<double> speed_;
  double share_ = 1;   // of the speed
  unsigned step_ = 3;  // 0: for as long as the key is held
  DeadMan dead_man_;
  std::optional<JogKey> moving_;  // by which key
  bool while_held_ = false;       // that motion, whatever the step is now
  bool stopping_ = false;
  bool ended_ = false;
  std::string note_;
};

}  // namespace trammel::app
