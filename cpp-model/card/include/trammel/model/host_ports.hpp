// Golden model of a card's host ports, up to four in parallel before the arbiter: docs/developer/architecture.md. Not
// thread-safe.
#pragma once

#include <cstdint>
#include <optional>

#include "trammel/model/axi4_lite_port.hpp"
#include "trammel/model/frame_engine.hpp"
#include "trammel/model/port_arbiter.hpp"
#include "trammel/model/spi_port.hpp"
#include "trammel/model/uart_port.hpp"
#include "trammel/model/wishbone_port.hpp"

namespace trammel::model {

class HostPorts {
 public:
  // The ports that are built; their numbers at the inner port follow in this order.
  struct Config {
    bool axi = true;
    bool wishbone = false;
    bool pipelined = false;  // the Wishbone port is pipelined
    bool uart = false;
    bool spi = false;
    unsigned break_bits = 20;

    std::size_t ports() const { return std::size_t{axi} + wishbone + uart + spi; }
  };

  // Pins. The fields of the inner port are ignored here.
  struct Inputs {
    Axi4LitePort::Inputs axi;
    WishbonePort::Inputs wishbone;
    bool rx = true;
    SpiPort::Pins spi;
  };
  struct Answer {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
  };

  // Throws std::invalid_argument if no port is built.
  explicit HostPorts(const Config& config)
      : config_(config), arbiter_(config.ports()), wishbone_(config.pipelined), uart_(config.break_bits) {}

  void reset() { *this = HostPorts(config_); }

  // One rising edge with reset low; `answer`: the inner port's answer in this clock.
  void clock(const Inputs& in, const Answer& answer) {
    const PortArbiter::Accesses now = accesses();
    const std::size_t served = arbiter_.served();
    std::size_t port = 0;
    const auto of = [&](bool built) {
      return built && port++ == served ? answer : Answer{false, answer.error, answer.data};
    };
    Axi4LitePort::Inputs axi = in.axi;
    give(axi, of(config_.axi));
    WishbonePort::Inputs wishbone = in.wishbone;
    give(wishbone, of(config_.wishbone));
    const Answer serial = of(config_.uart);
    const Answer spi = of(config_.spi);
    arbiter_.clock(now, answer.ack);
    if (config_.axi) axi_.clock(axi);
    if (config_.wishbone) wishbone_.clock(wishbone);
    if (config_.uart) clock_uart(in.rx, serial);
    if (config_.spi) clock_spi(in.spi, spi);
  }

  // The request side of the inner port.
  PortArbiter::Inner inner() const { return arbiter_.inner(accesses()); }
  const Axi4LitePort::Outputs& axi() const { return axi_.outputs(); }
  const WishbonePort::Outputs& wishbone() const { return wishbone_.outputs(); }
  const UartPort::Outputs& uart() const { return uart_.outputs(); }
  const SpiPort::Outputs& spi() const { return spi_.outputs(); }
  const FrameEngine& uart_engine() const { return uart_engine_; }
  const FrameEngine& spi_engine() const { return spi_engine_; }

 private:
  template <class Port>
  static void give(Port& in, const Answer& answer) {
    in.ack = answer.ack;
    in.error = answer.error;
    in.data = answer.data;
  }
  template <class Outputs>
  static PortArbiter::Access access_of(const Outputs& out, bool partial) {
    return {out.request, out.write, partial, out.address, out.data, true, false};
  }

  static PortArbiter::Access access_of(const FrameEngine::Outputs& out) {
    return {out.request, out.write, false, out.address, out.data, out.of_session, out.new_session};
  }

  PortArbiter::Accesses accesses() const {
    PortArbiter::Accesses all{};
    std::size_t port = 0;
    if (config_.axi) all[port++] = access_of(axi_.outputs(), axi_.outputs().partial);
    if (config_.wishbone) all[port++] = access_of(wishbone_.outputs(), wishbone_.outputs().partial);
    if (config_.uart) all[port++] = access_of(uart_engine_.outputs());
    if (config_.spi) all[port++] = access_of(spi_engine_.outputs());
    return all;
  }

  // Engine and port see each other's registered outputs from before the edge.
  void clock_uart(bool rx, const Answer& answer) {
    const UartPort::Outputs& port = uart_.outputs();
    FrameEngine::Inputs engine;
    engine.restart = port.restart;
    engine.byte_valid = port.byte_valid;
    engine.byte = port.byte;
    engine.ready = port.ready;
    give(engine, answer);
    const UartPort::Inputs line{rx, uart_engine_.outputs().valid, uart_engine_.outputs().byte};
    uart_.clock(line);
    uart_engine_.clock(engine);
  }
  void clock_spi(const SpiPort::Pins& pins, const Answer& answer) {
    const SpiPort::Outputs& port = spi_.outputs();
    FrameEngine::Inputs engine;
    engine.byte_valid = port.byte_valid;
    engine.byte = port.byte;
    engine.ready = port.ready;
    give(engine, answer);
    const SpiPort::Inputs line{pins, spi_engine_.outputs().valid, spi_engine_.outputs().byte};
    spi_.clock(line);
    spi_engine_.clock(engine);
  }

  Config config_;
  PortArbiter arbiter_;
  Axi4LitePort axi_;
  WishbonePort wishbone_;
  UartPort uart_;
  FrameEngine uart_engine_;
  SpiPort spi_;
  FrameEngine spi_engine_;
};

}  // namespace trammel::model
