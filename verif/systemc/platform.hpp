// The virtual prototype: computers with programs, each on its own link to a card with a machine behind it. The
// program on Port::kLoose uses the golden model; the programs on pins share the Verilated card. Both cards can be
// present at once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "modules.hpp"
#include "transactors.hpp"

namespace trammel::platform {

enum class Port { kLoose, kAxi, kWishbone, kWishboneClassic, kSpi, kUart };
// The port with this name on the command line: loose, axi, wishbone (pipelined), wishbone_classic, spi, uart.
std::optional<Port> port_of(const std::string& name);
const char* name_of(Port port);

struct PlatformOptions {
  std::uint32_t clock_hz = 1'000'000;
  double quantum = 100e-6;  // s, the global quantum of loosely timed models; 0: programs never run ahead
  MotorParameters motors;
  bool checkers = true;  // check the rules at the pins
  std::string vcd;       // trace of the pins, without ".vcd"; empty: none
};

class Platform {
 public:
  // Throws std::invalid_argument for a clock of 0 Hz, and for a quantum below 0 s or above 1 s.
  explicit Platform(const PlatformOptions& options = {});
  ~Platform();

  // Adds a program, at most one per port; the Wishbone port is either pipelined or classic. To be called before
  // run(). Throws std::invalid_argument for a second program on a port, and std::runtime_error if the trace cannot be
  // written.
  void add(Port port, Host::Software software);
  // Runs to the end of all programs, or of the first one that fails, and rethrows its exception. Throws
  // std::runtime_error if the simulation ends before the programs. SystemC can be run only once per process.
  void run();

  // The machine on the loosely timed card, or on the pin-accurate one.
  Motors& machine(bool loose) { return loose ? loose_machine_ : pin_machine_; }
  void set_sink(bool loose, PulseSink sink);
  std::uint64_t cycles(bool loose) const;
  // The rules that were broken at the pins.
  std::vector<std::string> broken() const;
  // For programs that break rules at the pins.
  sc_core::sc_signal<AxiMaster>& axi_master();
  sc_core::sc_signal<WishboneMaster>& wishbone_master();

 private:
  struct Pins;

  RegisterTarget& transactor(Port port);
  void program_ended();

  PlatformOptions options_;
  Motors loose_machine_;
  Motors pin_machine_;
  std::set<Port> taken_;  // ports in use; kWishbone is entered for both Wishbone kinds
  std::vector<std::unique_ptr<Host>> hosts_;
  std::vector<std::unique_ptr<RegisterTarget>> transactors_;
  std::unique_ptr<LooseCard> loose_;
  sc_core::sc_signal<bool> loose_irq_{"loose_irq"};
  std::unique_ptr<Pins> pins_;
};

}  // namespace trammel::platform
