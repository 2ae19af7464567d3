#include "handle.hpp"

namespace trammel::c {
namespace {

sim::Engine& engine_of(trammel_card* card) {
  sim::Engine* const engine = required(card, "card").engine;
  if (engine == nullptr) throw driver::StateError("this is for simulated cards alone");
  return *engine;
}

// Without a listener the engine reports nothing, which is faster.
void attach_steps(trammel_card& card, sim::Engine& engine) {
  engine.set_sink(card.steps->has_listener() ? card.steps.get() : nullptr);
}

}  // namespace
}  // namespace trammel::c

using trammel::c::attach_steps;
using trammel::c::engine_of;
using trammel::c::guarded;

trammel_result trammel_simulated_listen(trammel_card* card, void (*listener)(void*, const trammel_step*),
                                        void* context) {
  return guarded([=] {
    trammel::sim::Engine& engine = engine_of(card);
    card->steps->listen(listener, context);
    attach_steps(*card, engine);
  });
}

trammel_result trammel_simulated_listen_to_outputs(trammel_card* card,
                                                   void (*listener)(void*, const trammel_output_change*),
                                                   void* context) {
  return guarded([=] {
    trammel::sim::Engine& engine = engine_of(card);
    card->steps->listen_to_outputs(listener, context);
    attach_steps(*card, engine);
  });
}

trammel_result trammel_simulated_wait(trammel_card* card, uint64_t clocks) {
  return guarded([=] {
    if (!engine_of(card).wait_or_interrupt(clocks)) throw trammel::driver::InterruptedError("wait: interrupted");
  });
}

trammel_result trammel_simulated_set_inputs(trammel_card* card, uint32_t levels) {
  return guarded([=] { engine_of(card).set_inputs(levels); });
}

trammel_result trammel_simulated_set_input(trammel_card* card, unsigned input, bool level) {
  return guarded([=] {
    trammel::sim::Engine& engine = engine_of(card);
    trammel::c::check_input(card->card, input);
    engine.set_input(input, level);
  });
}

trammel_result trammel_simulated_set_emergency_stop(trammel_card* card, bool pressed) {
  return guarded([=] { engine_of(card).set_emergency_stop(pressed); });
}

trammel_result trammel_simulated_reset(trammel_card* card) {
  return guarded([=] { engine_of(card).reset(); });
}
