// The object behind trammel.h's handle, and the conversion of exceptions to results.
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

// Forwards steps and output changes of a simulated card to the caller's listeners.
class StepForwarder final : public trammel::driver::StepSink {
 public:
  using Listener = void (*)(void* context, const trammel_step* step);
  using OutputListener = void (*)(void* context, const trammel_output_change* change);
  void listen(Listener listener, void* context) {
    listener_ = listener;
    context_ = context;
  }
  void listen_to_outputs(OutputListener listener, void* context) {
    output_listener_ = listener;
    output_context_ = context;
  }
  bool has_listener() const { return listener_ != nullptr || output_listener_ != nullptr; }
  void pin_step(const trammel::driver::PinStep& step) override {
    forward({step.cycle, 0, 0, step.axis, step.direction, true});
  }
  void path_step(const trammel::driver::PathStep& step) override {
    forward({step.cycle, step.command, step.tick, step.axis, step.direction, false});
  }
  void outputs_changed(const trammel::driver::OutputChange& change) override {
    const trammel_output_change changed{change.cycle, change.changed, change.levels};
    if (output_listener_ != nullptr) output_listener_(output_context_, &changed);
  }

 private:
  void forward(const trammel_step& step) {
    if (listener_ != nullptr) listener_(context_, &step);
  }

  Listener listener_ = nullptr;
  void* context_ = nullptr;
  OutputListener output_listener_ = nullptr;
  void* output_context_ = nullptr;
};

struct trammel_card {
  trammel_card(std::shared_ptr<trammel::driver::Bus> way, trammel::sim::Engine* simulated)
      : steps(std::make_unique<StepForwarder>()),
        bus(std::move(way)),
        engine(simulated),
        card(trammel::driver::Card::open(*bus)) {}

  std::unique_ptr<StepForwarder> steps;  // outlives the bus that calls it
  std::shared_ptr<trammel::driver::Bus> bus;
  trammel::sim::Engine* engine;                           // the bus as an engine, if the card is simulated; else null
  std::shared_ptr<trammel::bindings::CardInWorld> world;  // set if the card has a machine behind its pins
  trammel::driver::Card card;
  // At most one of them is open: each restarts the card's command numbers.
  std::optional<trammel::driver::Stream> stream;
  std::optional<trammel::driver::PositionStream> positions;
};

namespace trammel::c {

// Thrown when a progress callback returns false.
class Cancelled {};

// Converts the exception being handled to a result, and stores it for trammel_last_error(). Call it only within a
// catch.
trammel_result note_exception() noexcept;

// Applies the thread's trammel_set_interrupt() to one call.
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

// Writes the text of `make` to `text`, truncated to `size`. The arguments are checked before `make` is called.
template <class Make>
void give_text(Make make, char* text, std::size_t size) {
  required(text, "text");
  if (size == 0) throw driver::ArgumentError("no room for a text of 0 bytes");
  const std::string whole = make();
  text[whole.copy(text, size - 1)] = '\0';
}

inline driver::Card& card_of(trammel_card* card) { return required(card, "card").card; }

// Both throw ArgumentError for a number that the enumeration does not define.
driver::PieceClass piece_class_of(std::int32_t piece_class);
driver::Command command_of(const trammel_command& command);

// Throws ArgumentError for an input that the card lacks.
void check_input(driver::Card& card, unsigned input);

trammel_status c_status(const driver::Status& status);
trammel_snapshot c_snapshot(const driver::Snapshot& snapshot);

// A bus that calls the caller's functions.
std::unique_ptr<driver::Bus> make_callback_bus(const trammel_bus& bus);

}  // namespace trammel::c
