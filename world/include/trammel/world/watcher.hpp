// Who wants to know what happens in a world while it happens: a report, a test. Called from within World's functions,
// in order of time; must not change the world.
#pragma once

#include <cstdint>

namespace trammel::world {

class World;

class Watcher {
 public:
  virtual ~Watcher() = default;
  // A pin has changed: World::levels() or World::emergency_stop(). At world.now().
  virtual void pins_changed(const World& world) = 0;
  // A step of the integration is made: carriages have moved. At world.now().
  virtual void moved(const World& world) = 0;
};

}  // namespace trammel::world
