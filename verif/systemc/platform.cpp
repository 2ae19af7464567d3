#include "platform.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace trammel::platform {

namespace {

using sc_core::SC_SEC;
using sc_core::sc_time;

// In clocks of the card: a bit of the serial line and the period of SCK, neither of them a whole number.
constexpr double kClocksOfBit = 25.3;
constexpr double kClocksOfSck = 4.7;
constexpr double kClocksOfGap = 8;
// Clocks of the reset, and clocks before the programs begin.
constexpr double kReset = 4;
constexpr double kStart = 10;

constexpr const char* kNames[] = {"loose", "axi", "wishbone", "wishbone_classic", "spi", "uart"};  // by Port

sc_time clocks(const PlatformOptions& options, double count) { return sc_time(count / options.clock_hz, SC_SEC); }

}  // namespace

const char* name_of(Port port) { return kNames[static_cast<unsigned>(port)]; }

std::optional<Port> port_of(const std::string& name) {
  for (unsigned i = 0; i < std::size(kNames); ++i) {
    if (name == kNames[i]) return static_cast<Port>(i);
  }
  return std::nullopt;
}

// The pin-accurate card, all modules at its pins, and the wires.
struct Platform::Pins final : sc_core::sc_module {
  Pins(const sc_core::sc_module_name& name, const PlatformOptions& options, Motors& motors)
      : sc_module(name),
        clk("clk", clocks(options, 1)),
        card("card", options.clock_hz),
        machine("machine", motors),
        reset_time(clocks(options, kReset)) {
    SC_HAS_PROCESS(Pins);
    SC_THREAD(reset);
    join(card);
    if (options.checkers) {
      checkers.emplace("checkers", static_cast<std::uint32_t>(8 * kClocksOfBit));
      join(*checkers);
    }
    card.switches(switches);
    card.step(step);
    card.dir(dir);
    card.outputs(outputs);
    card.irq(irq);
    machine.step(step);
    machine.dir(dir);
    machine.switches(switches);
  }

  void reset() {
    rst.write(true);
    wait(reset_time);
    rst.write(false);
  }

  template <class Ends>
  void join(Ends& ends) {
    ends.clk(clk);
    ends.rst(rst);
    ends.axi_master(axi_master);
    ends.axi_card(axi_card);
    ends.wishbone_master(wishbone_master);
    ends.wishbone_card(wishbone_card);
    ends.spi_master(spi_master);
    ends.spi_card(spi_card);
    ends.rx(rx);
    ends.tx(tx);
  }

  void set_classic_wishbone() {
    card.set_classic();
    if (checkers) checkers->checkers().set_pipelined(false);
  }

  void trace(const std::string& path) {
    if (!std::ofstream(path + ".vcd")) throw std::runtime_error(path + ".vcd: cannot be written");
    file = sc_core::sc_create_vcd_trace_file(path.c_str());
    const auto add = [this](const auto& wire) { sc_trace(file, wire.read(), wire.basename()); };
    add(clk), add(rst), add(axi_master), add(axi_card), add(wishbone_master), add(wishbone_card), add(spi_master);
    add(spi_card), add(rx), add(tx), add(switches), add(step), add(dir), add(outputs), add(irq);
  }

  sc_core::sc_clock clk;
  sc_core::sc_signal<bool> rst{"rst"};
  sc_core::sc_signal<AxiMaster> axi_master{"axi_master"};
  sc_core::sc_signal<AxiCard> axi_card{"axi_card"};
  sc_core::sc_signal<WishboneMaster> wishbone_master{"wishbone_master"};
  sc_core::sc_signal<WishboneCard> wishbone_card{"wishbone_card"};
  sc_core::sc_signal<SpiMaster> spi_master{"spi_master"};
  sc_core::sc_signal<SpiCard> spi_card{"spi_card"};
  sc_core::sc_signal<bool> rx{"rx", true};
  sc_core::sc_signal<bool> tx{"tx", true};
  sc_core::sc_signal<std::uint32_t> switches{"switches"};
  sc_core::sc_signal<std::uint32_t> step{"step"};
  sc_core::sc_signal<std::uint32_t> dir{"dir"};
  sc_core::sc_signal<std::uint32_t> outputs{"outputs"};
  sc_core::sc_signal<bool> irq{"irq"};
  PinCardModule card;
  std::optional<CheckerModule> checkers;
  MachineModule machine;
  sc_time reset_time;
  sc_core::sc_trace_file* file = nullptr;
};

Platform::Platform(const PlatformOptions& options)
    : options_(options), loose_machine_(options.motors), pin_machine_(options.motors) {
  if (options.clock_hz == 0) throw std::invalid_argument("a card with a clock of 0 Hz never runs");
  if (!(options.quantum >= 0 && options.quantum <= 1)) throw std::invalid_argument("a quantum is 0 to 1 s");
  tlm_utils::tlm_quantumkeeper::set_global_quantum(sc_time(options.quantum, SC_SEC));
}

Platform::~Platform() {
  if (pins_ && pins_->file != nullptr) sc_core::sc_close_vcd_trace_file(pins_->file);
}

void Platform::add(Port port, Host::Software software) {
  if (!taken_.insert(port == Port::kWishboneClassic ? Port::kWishbone : port).second)
    throw std::invalid_argument(std::string("the port for ") + name_of(port) + " has a program already");
  if (port == Port::kLoose && !loose_) {
    loose_ = std::make_unique<LooseCard>("loose_card", options_.clock_hz, loose_machine_);
    loose_->irq(loose_irq_);
  }
  if (port != Port::kLoose && !pins_) {
    pins_ = std::make_unique<Pins>("pins", options_, pin_machine_);
    if (!options_.vcd.empty()) pins_->trace(options_.vcd);
  }
  const std::string name = std::string("host_") + name_of(port);
  hosts_.push_back(
      std::make_unique<Host>(name.c_str(), std::move(software), clocks(options_, kStart), [this] { program_ended(); }));
  Host& host = *hosts_.back();
  if (port == Port::kLoose) {
    host.irq(loose_irq_);
    host.socket.bind(loose_->socket);
  } else {
    host.irq(pins_->irq);
    host.socket.bind(transactor(port).socket);
  }
}

RegisterTarget& Platform::transactor(Port port) {
  switch (port) {
    case Port::kLoose:
      break;
    case Port::kAxi: {
      auto axi = std::make_unique<AxiTransactor>("axi");
      axi->clk(pins_->clk);
      axi->master(pins_->axi_master);
      axi->card(pins_->axi_card);
      transactors_.push_back(std::move(axi));
      break;
    }
    case Port::kWishbone:
    case Port::kWishboneClassic: {
      const bool classic = port == Port::kWishboneClassic;
      if (classic) pins_->set_classic_wishbone();
      auto wishbone = std::make_unique<WishboneTransactor>("wishbone", classic);
      wishbone->clk(pins_->clk);
      wishbone->master(pins_->wishbone_master);
      wishbone->card(pins_->wishbone_card);
      transactors_.push_back(std::move(wishbone));
      break;
    }
    case Port::kSpi: {
      auto spi = std::make_unique<SpiTransactor>("spi", clocks(options_, kClocksOfSck), clocks(options_, kClocksOfGap));
      spi->master(pins_->spi_master);
      spi->card(pins_->spi_card);
      transactors_.push_back(std::move(spi));
      break;
    }
    case Port::kUart: {
      auto uart = std::make_unique<UartTransactor>("uart", options_.clock_hz / kClocksOfBit,
                                                   clocks(options_, (1U << kBreakBits) + 20));
      uart->rx(pins_->rx);
      uart->tx(pins_->tx);
      transactors_.push_back(std::move(uart));
      break;
    }
  }
  return *transactors_.back();
}

// If one program fails, the others do not count, because they may wait for it.
void Platform::program_ended() {
  const bool failed = std::any_of(hosts_.begin(), hosts_.end(), [](const auto& host) { return host->failure(); });
  if (failed || std::all_of(hosts_.begin(), hosts_.end(), [](const auto& host) { return host->done(); }))
    sc_core::sc_stop();
}

void Platform::run() {
  sc_core::sc_start();
  for (const auto& host : hosts_) {
    if (host->failure()) std::rethrow_exception(host->failure());
  }
  for (const auto& host : hosts_) {
    if (!host->done()) throw std::runtime_error(std::string("the simulation ended before ") + host->basename());
  }
}

void Platform::set_sink(bool loose, PulseSink sink) {
  if (loose) {
    loose_->set_sink(std::move(sink));
  } else {
    pins_->machine.set_sink(std::move(sink));
  }
}

std::uint64_t Platform::cycles(bool loose) const { return loose ? loose_->cycles() : pins_->card.cycles(); }

std::vector<std::string> Platform::broken() const {
  return pins_ && pins_->checkers ? pins_->checkers->checkers().broken() : std::vector<std::string>{};
}

sc_core::sc_signal<AxiMaster>& Platform::axi_master() { return pins_->axi_master; }
sc_core::sc_signal<WishboneMaster>& Platform::wishbone_master() { return pins_->wishbone_master; }

}  // namespace trammel::platform
