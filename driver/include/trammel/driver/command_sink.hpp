// Receiver of commands: the card's stream, a recorder, a counter.
#pragma once

#include "trammel/driver/commands.hpp"

namespace trammel::driver {

// Thread-safety: none, unless the sink says so.
class CommandSink {
 public:
  virtual ~CommandSink() = default;

  // Takes the next command. Commands come in the order to send: the feed pieces of a path before its geometry. The sink
  // defines its own errors.
  virtual void put(const Command& command) = 0;

 protected:
  CommandSink() = default;
  CommandSink(const CommandSink&) = default;
  CommandSink& operator=(const CommandSink&) = default;
};

}  // namespace trammel::driver
