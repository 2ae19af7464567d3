// Lockstep of the AXI4-Lite port between a random master and a random register file. Data is compared while its valid
// or request is high.
#include "trammel/model/axi4_lite_port.hpp"

#include <gtest/gtest.h>

#include <random>

#include "Vdut.h"
#include "trammel/sim/lockstep.hpp"
#include "wires.hpp"

namespace {

using trammel::lockstep::Checker;
using trammel::lockstep::Simulated;
using trammel::model::Axi4LitePort;

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : checker_("axi4_lite_port", seed), random_(seed) { reset(); }

  // One clock of reset, with random other inputs.
  void reset() {
    rtl_->rst_i = 1;
    drive();
    rtl_.clock();
    rtl_->rst_i = 0;
    model_.reset();
    compare();
    in_ = {};
    handshake_ = {};
    wait_ = 0;
  }

  void random_clock() {
    random_master();
    random_file();
    if (chance(500)) reset();
    drive();
    rtl_.clock();
    model_.clock(in_);
    checker_.next_cycle();
    compare();
    const Axi4LitePort::Outputs& out = model_.outputs();
    if (out.request) checker_.event(out.write ? "write" : "read", out.address);
    requests_ += out.request;
  }

  std::uint64_t requests() const { return requests_; }
  Checker& checker() { return checker_; }

 private:
  std::uint32_t draw() { return static_cast<std::uint32_t>(random_()); }
  bool chance(std::uint32_t one_in) { return draw() % one_in == 0; }

  // Valid stays high until its ready; a new access may follow at once.
  void random_master() {
    const Axi4LitePort::Outputs& out = model_.outputs();
    if (handshake_.aw) in_.awvalid = false;
    if (handshake_.w) in_.wvalid = false;
    if (handshake_.ar) in_.arvalid = false;
    if (!in_.awvalid && chance(6)) {
      in_.awvalid = true;
      in_.awaddr = draw() & 0xFFF;
    }
    if (!in_.wvalid && chance(6)) {
      in_.wvalid = true;
      in_.wdata = draw();
      in_.wstrb = chance(4) ? static_cast<std::uint8_t>(draw() & 0xF) : Axi4LitePort::kAllStrobes;
    }
    if (!in_.arvalid && chance(6)) {
      in_.arvalid = true;
      in_.araddr = draw() & 0xFFF;
    }
    in_.bready = chance(3);
    in_.rready = chance(3);
    handshake_ = {in_.awvalid && out.awready, in_.wvalid && out.wready, in_.arvalid && out.arready};
  }

  void random_file() {
    if (model_.outputs().request) wait_ = 1 + draw() % 12;
    in_.ack = wait_ == 1;
    if (wait_ != 0) --wait_;
    in_.error = chance(3);
    in_.data = draw();
  }

  void drive() {
    rtl_->awvalid_i = in_.awvalid;
    rtl_->awaddr_i = static_cast<SData>(in_.awaddr);
    rtl_->wvalid_i = in_.wvalid;
    rtl_->wdata_i = in_.wdata;
    rtl_->wstrb_i = in_.wstrb;
    rtl_->bready_i = in_.bready;
    rtl_->arvalid_i = in_.arvalid;
    rtl_->araddr_i = static_cast<SData>(in_.araddr);
    rtl_->rready_i = in_.rready;
    using namespace trammel::bus::register_answer;
    rtl_->answer_i = in_place(kAck, in_.ack) | in_place(kError, in_.error) | in_place(kData, in_.data);
  }

  void compare() {
    const Axi4LitePort::Outputs& out = model_.outputs();
    using namespace trammel::bus::register_access;
    const auto access = [this](const trammel::bus::Field& field) { return get(rtl_->access_o, field); };
    checker_.compare("awready_o", rtl_->awready_o, out.awready);
    checker_.compare("wready_o", rtl_->wready_o, out.wready);
    checker_.compare("arready_o", rtl_->arready_o, out.arready);
    checker_.compare("bvalid_o", rtl_->bvalid_o, out.bvalid);
    checker_.compare("rvalid_o", rtl_->rvalid_o, out.rvalid);
    checker_.compare("request_o", access(kRequest), out.request);
    checker_.compare("bresp_o", rtl_->bresp_o, out.bresp);
    checker_.compare("rresp_o", rtl_->rresp_o, out.rresp);
    checker_.compare("access_o, port and session", access(kPort) << 2 | access(kNewSession) << 1 | access(kOfSession),
                     1U);
    if (out.rvalid) checker_.compare("rdata_o", rtl_->rdata_o, out.rdata);
    if (!out.request) return;
    checker_.compare("write_o", access(kWrite), out.write);
    checker_.compare("address_o", access(kAddress), out.address);
    if (!out.write) return;
    checker_.compare("partial_o", access(kPartial), out.partial);
    checker_.compare("data_o", access(kData), out.data);
  }

  struct Handshake {
    bool aw = false;
    bool w = false;
    bool ar = false;
  };

  Checker checker_;
  std::mt19937_64 random_;
  Simulated<Vdut> rtl_;
  Axi4LitePort model_;
  Axi4LitePort::Inputs in_;
  Handshake handshake_;
  std::uint32_t wait_ = 0;
  std::uint64_t requests_ = 0;
};

TEST(Axi4LitePort, RandomTraffic) {
  const std::uint64_t seed = trammel::lockstep::seed_from_environment(1);
  EXPECT_EQ("", trammel::lockstep::judge([&] {
              Bench bench(seed);
              const std::uint64_t length = trammel::lockstep::scaled(200'000);
              for (std::uint64_t i = 0; i < length; ++i) bench.random_clock();
              EXPECT_GT(bench.requests(), 10'000u);
              EXPECT_GE(bench.checker().comparisons(), bench.checker().cycles() * 9);
            }));
}

}  // namespace
