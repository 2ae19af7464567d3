// Receives the events of a world as they happen: for a report, a test. World's functions call it in order of time; it
// must not change the world.
#pragma once

#include <cstdint>

namespace trammel::world {

class World;

class Watcher {
 public:
  virtual ~Watcher() = default;
  // A pin has changed (World::levels() or World::emergency_stop()) at world.now().
  virtual void pins_changed(const World& world) = 0;
  // An integration step was made, so carriages have moved, at world.now().
  virtual void moved(const World& world) = 0;
};

}  // namespace trammel::world
