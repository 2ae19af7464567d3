// Transactors from TLM-2.0 transactions to the pins of the card's host ports, each as a master on that bus. They
// first wait for SystemC's time, because at the pins nothing runs ahead. A card that does not answer is a LinkError;
// the request stays at the pins, because an AXI4-Lite master must not withdraw it.
#pragma once

#include <deque>
#include <optional>

#include "pins.hpp"
#include "tlm_bus.hpp"
#include "trammel/driver/frame_bus.hpp"

namespace trammel::platform {

// Makes one access after the other.
class AxiTransactor final : public RegisterTarget {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_out<AxiMaster> master{"master"};
  sc_core::sc_in<AxiCard> card{"card"};

  using RegisterTarget::RegisterTarget;

 private:
  std::size_t transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) override;
  bool read(driver::Access& access);
  bool write(const driver::Access& access);
};

// A pipelined or a classic master; makes one access after the other under one CYC.
class WishboneTransactor final : public RegisterTarget {
 public:
  sc_core::sc_in<bool> clk{"clk"};
  sc_core::sc_out<WishboneMaster> master{"master"};
  sc_core::sc_in<WishboneCard> card{"card"};

  WishboneTransactor(const sc_core::sc_module_name& name, bool classic) : RegisterTarget(name), classic_(classic) {}

 private:
  std::size_t transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) override;
  bool access(driver::Access& access);

  bool classic_;
};

// Shared by SPI and serial line: bytes, and frames of bytes made by the driver's own FrameBus.
class FrameTransactor : public RegisterTarget, protected driver::ByteLink {
 public:
  const driver::FrameBus::Counts& counts() const { return bus_->counts(); }

 protected:
  using RegisterTarget::RegisterTarget;

  std::chrono::nanoseconds now() const override;
  void sleep(std::chrono::nanoseconds time) override { wait(to_sc(time)); }
  std::size_t take(std::uint8_t* bytes, std::size_t room);

  std::deque<std::uint8_t> came_;

 private:
  std::size_t transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) override;

  std::optional<driver::FrameBus> bus_;  // connects at the first transfer
};

// A serial line at `baud`, independent of the card's clock; `break_time`: the length of a break that the card
// requires.
class UartTransactor final : public FrameTransactor {
 public:
  sc_core::sc_out<bool> rx{"rx"};  // RX of the card
  sc_core::sc_in<bool> tx{"tx"};

  UartTransactor(const sc_core::sc_module_name& name, double baud, const sc_core::sc_time& break_time);

 private:
  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  void restart() override;
  std::chrono::nanoseconds time_of(std::size_t bytes) const override;
  void listen();
  void put(bool level, double bits);

  double baud_;
  sc_core::sc_time break_time_;
  sc_core::sc_event byte_came_;
};

// An SPI master in mode 3 with this period of SCK, independent of the card's clock; `gap`: time between CS and SCK,
// and between exchanges.
class SpiTransactor final : public FrameTransactor {
 public:
  sc_core::sc_out<SpiMaster> master{"master"};
  sc_core::sc_in<SpiCard> card{"card"};

  SpiTransactor(const sc_core::sc_module_name& name, const sc_core::sc_time& period, const sc_core::sc_time& gap)
      : FrameTransactor(name), half_(period / 2), gap_(gap) {}

 private:
  void send(const std::uint8_t* bytes, std::size_t count) override;
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override;
  void restart() override { came_.clear(); }
  std::chrono::nanoseconds time_of(std::size_t bytes) const override;
  void exchange(const std::uint8_t* bytes, std::size_t count);
  std::uint8_t exchange(std::uint8_t byte);

  sc_core::sc_time half_;
  sc_core::sc_time gap_;
  std::uint8_t last_ = frames::kEnd;
};

}  // namespace trammel::platform
