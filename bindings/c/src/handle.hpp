// What stands behind trammel.h's handle, and how exceptions become results.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "trammel.h"
#include "trammel/bindings/simulated_machine.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/interrupt.hpp"
#include "trammel/driver/position_stream.hpp"
#include "trammel/driver/stream.hpp"
#include "trammel/sim/engine.hpp"

// Steps of a simulated card on their way to the caller's listener.
class StepForwarder final : public trammel::driver::StepSink {
 public:
  using Listener = void (*)(void* context, const trammel_step* step);
  void listen(Listener listener, void* context) {
    listener_ = listener;
    context_ = context;
  }
  void pin_step(const trammel::driver::PinStep& step) override {
    forward({step.cycle, 0, 0, step.axis, step.direction, true});
  }
  void path_step(const trammel::driver::PathStep& step) override {
    forward({step.cycle, step.command, step.tick, step.axis, step.direction, false});
  }

 private:
  void forward(const trammel_step& step) { listener_(context_, &step); }

  Listener listener_ = nullptr;
  void* context_ = nullptr;
};

struct trammel_card {
  trammel_card(std::shared_ptr<trammel::driver::Bus> way, trammel::sim::Engine* simulated)
      : steps(std::make_unique<StepForwarder>()),
        bus(std::move(way)),
        engine(simulated),
        card(trammel::driver::Card::open(*bus)) {}

  std::unique_ptr<StepForwarder> steps;  // outlives the bus that calls it
  std::shared_ptr<trammel::driver::Bus> bus;
  trammel::sim::Engine* engine;                           // the bus, where it is a simulated card's
  std::shared_ptr<trammel::bindings::CardInWorld> world;  // where it has a machine behind its pins
  trammel::driver::Card card;
  // One of them at most: each begins the card's commands anew.
  std::optional<trammel::driver::Stream> stream;
  std::optional<trammel::driver::PositionStream> positions;
};

namespace trammel::c {

// What a progress callback that gives back false ends a call with.
class Cancelled {};

// The exception under way as a result, noted for trammel_last_error(). Only within a catch.
trammel_result note_exception() noexcept;

// The thread's trammel_set_interrupt(), for one call.
class CallInterrupts {
 public:
  CallInterrupts();

 private:
  std::optional<driver::InterruptScope> scope_;
};

template <class Call>
trammel_result guarded(Call&& call) noexcept {
  try {
    const CallInterrupts interrupts;
    call();
    return TRAMMEL_OK;
  } catch (...) {
    return note_exception();
  }
}

// Throws ArgumentError for a null pointer.
template <class T>
T& required(T* pointer, const char* name) {
  if (pointer == nullptr) throw driver::ArgumentError(std::string(name) + " is null");
  return *pointer;
}

// The text of `make`, cut to the room of its reader, who is looked at first.
template <class Make>
void give_text(Make make, char* text, std::size_t size) {
  required(text, "text");
  if (size == 0) throw driver::ArgumentError("no room for a text of 0 bytes");
  const std::string whole = make();
  text[whole.copy(text, size - 1)] = '\0';
}

inline driver::Card& card_of(trammel_card* card) { return required(card, "card").card; }

// Throw ArgumentError for a number that is none of the enumeration's.
driver::PieceClass piece_class_of(std::int32_t piece_class);
driver::Command command_of(const trammel_command& command);

// Throws ArgumentError for an input that the card lacks.
void check_input(driver::Card& card, unsigned input);

trammel_status c_status(const driver::Status& status);
trammel_snapshot c_snapshot(const driver::Snapshot& snapshot);

// A card behind the caller's own functions.
std::unique_ptr<driver::Bus> make_callback_bus(const trammel_bus& bus);

}  // namespace trammel::c
