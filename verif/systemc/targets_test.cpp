// The parts of the platform alone, and their limits: targets, Host, and programs that fail. Each test runs in
// its own process, because SystemC elaborates only once per process.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "platform.hpp"
#include "trammel/card_map.hpp"
#include "trammel/driver/low_level/card_parts.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::platform {
namespace {

using namespace std::chrono_literals;
using sc_core::SC_SEC;
using sc_core::sc_time;
using testing::Values;

constexpr std::uint32_t kClock = 1'000'000;
constexpr std::uint64_t kWindowEnd = 0x1000;

// A loosely timed card and a program, connected as in a user's own platform.
class CardAlone {
 public:
  explicit CardAlone(Host::Software software)
      : host_("host", std::move(software), sc_core::SC_ZERO_TIME, [] { sc_core::sc_stop(); }) {
    card.irq(irq_);
    host_.irq(irq_);
    host_.socket.bind(card.socket);
  }

  Motors motors;
  LooseCard card{"card", kClock, motors};

 private:
  sc_core::sc_signal<bool> irq_{"irq"};
  Host host_;
};

class AnyQuantum : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Systemc, AnyQuantum, Values(0, 1e-12, 1e7),
                         [](const auto& quantum) { return std::to_string(quantum.index); });

// Without a global quantum, with one far below a clock, and with one of which two exceed SystemC's time.
TEST_P(AnyQuantum, ALooseCardRuns) {
  tlm_utils::tlm_quantumkeeper::set_global_quantum(sc_time(GetParam(), SC_SEC));
  bool interrupted = false;
  CardAlone alone([&](Host& host) {
    driver::Card card = driver::Card::open(host);
    driver::run_line(card, driver::plan_line(card.timing(), {500, 0, 0, 0}, 50ms));
    driver::Access again[] = {driver::write_of(card_map::reg::kStart, 1),
                              driver::write_of(card_map::reg::kIrqEnable, card_map::field::kIrqEnableIdle)};
    EXPECT_EQ(host.transfer(again, 2), 2U);
    EXPECT_FALSE(host.irq.read());
    interrupted = host.wait_for_interrupt(std::chrono::nanoseconds::max());
    host.sleep(50ms);
    EXPECT_EQ(card.read_snapshot().position[0], 1000);  // this also runs the machine up to here
  });
  sc_core::sc_start(sc_time(3, SC_SEC));
  EXPECT_TRUE(interrupted);
  EXPECT_NEAR(alone.motors.position(0), 1000, 0.5);
}

TEST(Systemc, ALooseCardRunsWithoutAProgramThatAsks) {
  CardAlone alone([](Host& host) {
    host.sleep(1s);
    host.synchronise();
  });
  sc_core::sc_start(sc_time(100, SC_SEC));
  EXPECT_EQ(sc_core::sc_time_stamp(), sc_time(1, SC_SEC));
  EXPECT_EQ(alone.card.cycles(), kClock);
}

// Registers that read back, one of which refuses everything; it does not support BurstEnd.
class PlainTarget final : public sc_core::sc_module {
 public:
  static constexpr std::uint64_t kRefused = 0x108;
  tlm_utils::simple_target_socket<PlainTarget> socket{"socket"};
  std::vector<std::uint64_t> made;

  explicit PlainTarget(const sc_core::sc_module_name& name) : sc_module(name) {
    socket.register_b_transport(this, &PlainTarget::b_transport);
  }

 private:
  void b_transport(tlm::tlm_generic_payload& payload, sc_time&) {
    for (unsigned i = 0; i < payload.get_data_length(); i += 4) {
      const std::uint64_t address = payload.get_address() + i;
      if (address == kRefused) return payload.set_response_status(tlm::TLM_GENERIC_ERROR_RESPONSE);
      made.push_back(address);
    }
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  }
};

TEST(Systemc, ATargetWithoutBurstEndIsAskedWordByWord) {
  PlainTarget target("target");
  sc_core::sc_signal<bool> irq;
  std::size_t reported = 0;
  std::size_t reported_of_one = 1;
  const auto software = [&](Host& host) {
    std::array<driver::Access, 4> accesses;
    for (std::uint32_t i = 0; i < 4; ++i) accesses[i] = driver::write_of(0x100 + 4 * i, i);
    reported = host.transfer(accesses.data(), accesses.size());
    reported_of_one = host.transfer(&accesses[2], 1);
  };
  Host host("host", software, sc_core::SC_ZERO_TIME, [] {});
  host.irq(irq);
  host.socket.bind(target.socket);
  sc_core::sc_start();
  EXPECT_FALSE(host.failure());
  EXPECT_EQ(target.made, (std::vector<std::uint64_t>{0x100, 0x104}));
  EXPECT_EQ(reported, 2U);
  EXPECT_EQ(reported_of_one, 0U);
}

TEST(Systemc, ATargetWithBurstEndIsAskedInBursts) {
  CardAlone alone([](Host& host) {
    std::array<driver::Access, 4> accesses;
    for (std::uint32_t i = 0; i < 4; ++i) accesses[i] = driver::read_of(card_map::reg::kMagic + 4 * i);
    EXPECT_EQ(host.transfer(accesses.data(), 4), 4U);
    const std::uint64_t before = host.bursts();
    EXPECT_EQ(host.transfer(accesses.data(), 4), 4U);
    EXPECT_EQ(host.bursts(), before + 1);
  });
  sc_core::sc_start();
}

tlm::tlm_response_status status_at(Host& host, std::uint64_t address, unsigned words, unsigned streaming_width) {
  std::vector<unsigned char> data(4 * words);
  tlm::tlm_generic_payload payload;
  payload.set_read();
  payload.set_address(address);
  payload.set_data_ptr(data.data());
  payload.set_data_length(4 * words);
  payload.set_streaming_width(streaming_width);
  sc_time delay;
  host.socket->b_transport(payload, delay);
  return payload.get_response_status();
}

// The last word of the window is inside, and the card refuses it; addresses beyond it are not addresses of the
// target.
TEST(Systemc, AddressesEndWithTheWindow) {
  CardAlone alone([](Host& host) {
    constexpr std::uint64_t kLast = kWindowEnd - 4;
    constexpr std::uint64_t kLastOfAll = std::numeric_limits<std::uint64_t>::max() - 3;
    EXPECT_EQ(status_at(host, kLast, 1, 4), tlm::TLM_GENERIC_ERROR_RESPONSE);
    EXPECT_EQ(status_at(host, kLast, 2, 4), tlm::TLM_GENERIC_ERROR_RESPONSE);
    EXPECT_EQ(status_at(host, 0, 1024, 4096), tlm::TLM_GENERIC_ERROR_RESPONSE);
    EXPECT_EQ(status_at(host, kLast, 2, 8), tlm::TLM_ADDRESS_ERROR_RESPONSE);
    EXPECT_EQ(status_at(host, 0, 1025, 4100), tlm::TLM_ADDRESS_ERROR_RESPONSE);
    for (const std::uint64_t base : {kWindowEnd, std::uint64_t{1} << 32, kLastOfAll - 4, kLastOfAll}) {
      EXPECT_EQ(status_at(host, base, 1, 4), tlm::TLM_ADDRESS_ERROR_RESPONSE) << base;
      EXPECT_EQ(status_at(host, base, 2, 4), tlm::TLM_ADDRESS_ERROR_RESPONSE) << base;
      EXPECT_EQ(status_at(host, base, 2, 8), tlm::TLM_ADDRESS_ERROR_RESPONSE) << base;
      EXPECT_EQ(status_at(host, base, 3, 12), tlm::TLM_ADDRESS_ERROR_RESPONSE) << base;
    }
    EXPECT_EQ(status_at(host, 0, 4, 16), tlm::TLM_OK_RESPONSE);
  });
  sc_core::sc_start();
}

// Reads by debug transport; returns the bytes received.
std::string debug_read(Host& host, std::uint64_t address, unsigned length) {
  std::string data(length, '?');
  tlm::tlm_generic_payload payload;
  payload.set_read();
  payload.set_address(address);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(data.data()));
  payload.set_data_length(length);
  const unsigned came = host.socket->transport_dbg(payload);
  EXPECT_EQ(data.substr(came), std::string(length - came, '?')) << "bytes that did not come were written";
  data.resize(came);
  return data;
}

std::uint32_t debug_word(Host& host, std::uint64_t address) {
  const std::string bytes = debug_read(host, address, 4);
  std::uint32_t word = 0;
  EXPECT_EQ(bytes.size(), sizeof word) << address;
  std::memcpy(&word, bytes.data(), bytes.size());
  return word;
}

TEST(Systemc, DebugTransportReadsAnyBytes) {
  CardAlone alone([](Host& host) {
    EXPECT_EQ(debug_read(host, card_map::reg::kMagic, 4), "LMRT");
    EXPECT_EQ(debug_read(host, card_map::reg::kMagic + 1, 2), "MR");
    const std::string version{char(card_map::kMapVersionValue & 0xFF), '\0', char(card_map::kMapVersionValue >> 16)};
    EXPECT_EQ(debug_read(host, card_map::reg::kMagic + 3, 7), "T" + version + std::string("\0\x04\0", 3));
    EXPECT_EQ(debug_read(host, card_map::reg::kMagic, 0), "");
  });
  sc_core::sc_start();
}

// The bytes end at a register that cannot be read. No debug read leaves a refusal.
TEST(Systemc, DebugTransportEndsWhereNothingCanBeRead) {
  CardAlone alone([](Host& host) {
    EXPECT_EQ(debug_read(host, card_map::reg::kControl, 4), "") << "write only";
    EXPECT_EQ(debug_read(host, card_map::reg::kPorts - 2, 40).size(), 6U) << "nothing is behind PORTS";
    EXPECT_EQ(debug_read(host, kWindowEnd - 1, 2), "");
    EXPECT_EQ(debug_read(host, kWindowEnd, 4), "");
    EXPECT_EQ(debug_read(host, std::numeric_limits<std::uint64_t>::max() - 3, 8), "");
    EXPECT_FALSE(driver::Card::open(host).refusal());
  });
  sc_core::sc_start();
}

// Returns the present registers, although the card has not been run up to now: it is idle again, without having been
// run.
TEST(Systemc, DebugTransportShowsThePresentAndLeavesTheCard) {
  tlm_utils::tlm_quantumkeeper::set_global_quantum(sc_time(1, SC_SEC));
  LooseCard* loose = nullptr;
  CardAlone alone([&loose](Host& host) {
    driver::Access start[] = {driver::write_of(card_map::reg::kLengthLo, 50'000),
                              driver::write_of(card_map::reg::kStart, 1)};
    ASSERT_EQ(host.transfer(start, 2), 2U);
    host.synchronise();
    EXPECT_EQ(debug_word(host, card_map::reg::kStatus) & card_map::field::kStatusBusy, card_map::field::kStatusBusy);
    const std::uint64_t cycles = loose->cycles();
    host.sleep(100ms);
    host.synchronise();
    EXPECT_EQ(debug_word(host, card_map::reg::kStatus) & card_map::field::kStatusBusy, 0U);
    EXPECT_EQ(loose->cycles(), cycles);
  });
  loose = &alone.card;
  sc_core::sc_start();
}

TEST(Systemc, DebugTransportDoesNotWrite) {
  CardAlone alone([](Host& host) {
    const std::uint32_t before = debug_word(host, card_map::reg::kHoldLimit);
    std::uint32_t data = 77;
    tlm::tlm_generic_payload payload;
    payload.set_write();
    payload.set_address(card_map::reg::kHoldLimit);
    payload.set_data_ptr(reinterpret_cast<unsigned char*>(&data));
    payload.set_data_length(4);
    EXPECT_EQ(host.socket->transport_dbg(payload), 0U);
    payload.set_command(tlm::TLM_IGNORE_COMMAND);
    EXPECT_EQ(host.socket->transport_dbg(payload), 0U);
    EXPECT_EQ(driver::Card::open(host).parts().registers.read(card_map::reg::kHoldLimit), before);
  });
  sc_core::sc_start();
}

// At the pins a read would take clocks.
TEST(Systemc, DebugTransportReadsNothingAtPins) {
  Platform platform;
  platform.add(Port::kAxi, [](Host& host) { EXPECT_EQ(debug_read(host, card_map::reg::kMagic, 4), ""); });
  platform.run();
}

// No card is connected to the wires.
template <class Transactor, class Master, class Card>
void expect_no_answer(Transactor& transactor) {
  sc_core::sc_clock clk("clk", sc_time(1, sc_core::SC_US));
  sc_core::sc_signal<Master> master;
  sc_core::sc_signal<Card> card;
  sc_core::sc_signal<bool> irq;
  transactor.clk(clk);
  transactor.master(master);
  transactor.card(card);
  const auto software = [](Host& host) { driver::Card::open(host); };
  Host host("host", software, sc_core::SC_ZERO_TIME, [] { sc_core::sc_stop(); });
  host.irq(irq);
  host.socket.bind(transactor.socket);
  sc_core::sc_start(sc_time(1, SC_SEC));
  ASSERT_TRUE(host.failure());
  try {
    std::rethrow_exception(host.failure());
  } catch (const driver::LinkError& error) {
    EXPECT_STREQ(error.what(), "no answer from the card in 100000 clocks");
  }
}

TEST(Systemc, ACardThatDoesNotAnswerOnAxi) {
  AxiTransactor axi("axi");
  expect_no_answer<AxiTransactor, AxiMaster, AxiCard>(axi);
}

TEST(Systemc, ACardThatDoesNotAnswerOnWishbone) {
  WishboneTransactor wishbone("wishbone", false);
  expect_no_answer<WishboneTransactor, WishboneMaster, WishboneCard>(wishbone);
}

// The other program waits for the one that failed.
TEST(Systemc, AProgramThatFailsEndsTheSimulation) {
  Platform platform;
  platform.add(Port::kLoose, [](Host&) { throw std::domain_error("no plan"); });
  platform.add(Port::kAxi, [](Host& host) {
    for (int i = 0; i < 100; ++i) host.sleep(1ms);
    ADD_FAILURE() << "it went on";
  });
  EXPECT_THROW(platform.run(), std::domain_error);
}

TEST(Systemc, ASimulationThatEndsBeforeAProgramIsAnError) {
  Platform platform;
  platform.add(Port::kLoose, [](Host& host) {
    sc_core::sc_stop();
    host.sleep(1s);
    host.synchronise();
  });
  EXPECT_THROW(platform.run(), std::runtime_error);
}

TEST(Systemc, APortTakesOneProgram) {
  Platform platform;
  for (const Port port : {Port::kLoose, Port::kAxi, Port::kWishboneClassic}) {
    platform.add(port, [](Host&) {});
    EXPECT_THROW(platform.add(port, [](Host&) {}), std::invalid_argument) << name_of(port);
  }
  EXPECT_THROW(platform.add(Port::kWishbone, [](Host&) {}), std::invalid_argument) << "pipelined or classic";
}

TEST(Systemc, OptionsOutOfRange) {
  PlatformOptions options;
  for (const double quantum : {-1e-6, 1.5, std::nan("")}) {
    options.quantum = quantum;
    EXPECT_THROW(Platform{options}, std::invalid_argument) << quantum;
  }
  options = {};
  options.clock_hz = 0;
  EXPECT_THROW(Platform{options}, std::invalid_argument);
}

}  // namespace
}  // namespace trammel::platform
