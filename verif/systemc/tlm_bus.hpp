// The driver's access to a card in SystemC: a TLM-2.0 initiator that is a Bus, and the base of the targets.
#pragma once

#include <tlm.h>
#include <tlm_utils/simple_initiator_socket.h>
#include <tlm_utils/simple_target_socket.h>
#include <tlm_utils/tlm_quantumkeeper.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <systemc>

#include "trammel/driver/bus.hpp"

namespace trammel::platform {

// Converts `time`, counted from `now`; the result is at least 0 and at most the rest of SystemC's time.
sc_core::sc_time to_sc(std::chrono::nanoseconds time, const sc_core::sc_time& now = sc_core::sc_time_stamp());

// Clocks. The card answers within 700 (ANSWER_CLOCKS_8_AXES), and a port waits for at most three others: a card that
// needs longer than this does not answer at all.
inline constexpr int kLongestAnswer = 100'000;

// Information about a burst that ended early, which the generic payload lacks. A target that supports the extension
// sets `made` in each transaction. Host makes single-word requests until a target has done so, because a burst cannot
// be repeated.
struct BurstEnd : tlm::tlm_extension<BurstEnd> {
  std::optional<std::size_t> made;  // words transferred
  std::string failure;              // failure of the link; empty: none

  tlm_extension_base* clone() const override { return new BurstEnd(*this); }
  void copy_from(const tlm_extension_base& other) override { *this = static_cast<const BurstEnd&>(other); }
};

// A computer with a program (`software`, in a thread of SystemC) and a link to a card. The program sees it as the
// driver's Bus. Blocking transport, loosely timed: the program's time may run ahead of SystemC's by the global
// quantum. Accesses to consecutive registers, or repeated accesses to one register, are sent as one burst.
class Host final : public sc_core::sc_module, public driver::Bus {
 public:
  using Software = std::function<void(Host&)>;

  tlm_utils::simple_initiator_socket<Host> socket{"socket"};
  sc_core::sc_in<bool> irq{"irq"};

  // The program begins at `start`; `finished` is called at its end.
  Host(const sc_core::sc_module_name& name, Software software, const sc_core::sc_time& start,
       std::function<void()> finished);

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return true; }
  bool has_interrupt() const override { return true; }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override;

  // Lets SystemC catch up with the program.
  void synchronise() { keeper_.sync(); }
  double now() const { return keeper_.get_current_time().to_seconds(); }  // s
  std::uint64_t bursts() const { return bursts_; }
  bool done() const { return done_; }
  // The exception that ended the program; null: none.
  std::exception_ptr failure() const { return failure_; }

 private:
  void run();
  std::size_t burst(driver::Access* accesses, std::size_t count);
  std::size_t words_made(const tlm::tlm_generic_payload& payload, const BurstEnd& end);
  void transport(tlm::tlm_generic_payload& payload);

  Software software_;
  sc_core::sc_time start_;
  std::function<void()> finished_;
  tlm_utils::tlm_quantumkeeper keeper_;
  std::uint64_t bursts_ = 0;
  bool counts_words_ = false;  // the target counts them, in BurstEnd
  bool done_ = false;
  std::exception_ptr failure_;
};

// A card's register window as a target: 4 KiB of 32-bit words, little endian. One transaction at a time.
//
// Debug transport reads any range of bytes in the window up to the first register that cannot be read, and returns
// the number of bytes. It does not write (0 bytes), because the card executes each write as an order and needs clocks
// for it.
class RegisterTarget : public sc_core::sc_module {
 public:
  tlm_utils::simple_target_socket<RegisterTarget> socket{"socket"};

  explicit RegisterTarget(const sc_core::sc_module_name& name);

 protected:
  // Like Bus::transfer(), `delay` ahead of SystemC's time; adds the time that it needs, or waits.
  virtual std::size_t transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) = 0;
  // Answers reads for the present time without changing the card and without time passing; returns how many are
  // possible. At the pins none is, because a port's answer takes clocks.
  virtual std::size_t peek(driver::Access* /*reads*/, std::size_t /*count*/) { return 0; }

 private:
  void b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay);
  unsigned transport_dbg(tlm::tlm_generic_payload& payload);
};

}  // namespace trammel::platform
