#include "recorder.hpp"

#include <fmt/format.h>

#include <cstring>
#include <iterator>
#include <stdexcept>

#include "card_inputs.hpp"
#include "trammel/card_map.hpp"

namespace trammel::netlist {

namespace {

template <class Value>
void append_hex(std::string& line, const Value& value, unsigned width) {
  fmt::format_to(std::back_inserter(line), "{:0{}x}", value, (width + 3) / 4);
}
// Wide ports are arrays of words, lowest word first.
template <std::size_t kWords>
void append_hex(std::string& line, const VlWide<kWords>& value, unsigned) {
  for (std::size_t i = kWords; i-- > 0;) fmt::format_to(std::back_inserter(line), "{:08x}", value[i]);
}

model::CardModel::Config config(std::uint32_t idle_level) {
  model::CardModel::Config config;
  config.axes = Recorder::kAxes;
  config.idle_level = idle_level;
  return config;
}

}  // namespace

Recorder::Recorder(const std::string& path, std::uint32_t idle_level, std::uint32_t seed)
    : file_(std::fopen(path.c_str(), "w")), model_(config(idle_level)), seed_(seed) {
  if (file_ == nullptr) throw std::runtime_error("cannot write " + path);
  dut_->clock_hz_i = model::CardModel::Config{}.clock_hz;
  dut_->idle_level_i = static_cast<std::uint8_t>(idle_level);
  line_ = "";
  for_each_port([this](const char* name, char direction, const auto&, unsigned width) {
    fmt::format_to(std::back_inserter(line_), "{}{}{} ", name, direction, width);
  });
  std::fprintf(file_, "%s\n", line_.c_str());
}

Recorder::~Recorder() { std::fclose(file_); }

template <class Port>
void Recorder::for_each_port(Port&& port) {
  port("rst_i", '<', dut_->rst_i, 1);
  port("clock_hz_i", '<', dut_->clock_hz_i, 32);
  port("idle_level_i", '<', dut_->idle_level_i, 2 * kAxes);
  port("input_i", '<', dut_->input_i, kPins);
  port("output_idle_i", '<', dut_->output_idle_i, kPins);
  port("emergency_stop_level_i", '<', dut_->emergency_stop_level_i, 1);
  port("emergency_stop_i", '<', dut_->emergency_stop_i, 1);
  port("awvalid_i", '<', dut_->awvalid_i, 1);
  port("awaddr_i", '<', dut_->awaddr_i, 12);
  port("wvalid_i", '<', dut_->wvalid_i, 1);
  port("wdata_i", '<', dut_->wdata_i, 32);
  port("wstrb_i", '<', dut_->wstrb_i, 4);
  port("bready_i", '<', dut_->bready_i, 1);
  port("arvalid_i", '<', dut_->arvalid_i, 1);
  port("araddr_i", '<', dut_->araddr_i, 12);
  port("rready_i", '<', dut_->rready_i, 1);
  port("awready_o", '>', dut_->awready_o, 1);
  port("wready_o", '>', dut_->wready_o, 1);
  port("bvalid_o", '>', dut_->bvalid_o, 1);
  port("bresp_o", '>', dut_->bresp_o, 2);
  port("arready_o", '>', dut_->arready_o, 1);
  port("rvalid_o", '>', dut_->rvalid_o, 1);
  port("rdata_o", '>', dut_->rdata_o, 32);
  port("rresp_o", '>', dut_->rresp_o, 2);
  port("step_o", '>', dut_->step_o, kAxes);
  port("dir_o", '>', dut_->dir_o, kAxes);
  port("output_o", '>', dut_->output_o, kPins);
  port("irq_o", '>', dut_->irq_o, 1);
  port("observe_o", '>', dut_->observe_o, bus::observe::kWidth + bus::axis_observe::kWidth * kAxes);
}

bool Recorder::write(std::uint32_t address, std::uint32_t data, std::uint8_t strobes) {
  in_.awvalid = in_.wvalid = true;
  in_.awaddr = address;
  in_.wdata = data;
  in_.wstrb = strobes;
  while (!dut_->awready_o) clock();
  clock();
  in_ = {};
  while (!dut_->bvalid_o) clock();
  in_.bready = true;
  const bool okay = dut_->bresp_o == model::Axi4LitePort::kOkay;
  if (!okay) ++seen_.refused;
  clock();
  in_ = {};
  return okay;
}

std::uint32_t Recorder::read(std::uint32_t address) {
  in_.arvalid = true;
  in_.araddr = address;
  while (!dut_->arready_o) clock();
  clock();
  in_ = {};
  while (!dut_->rvalid_o) clock();
  in_.rready = true;
  const std::uint32_t data = dut_->rdata_o;
  if (dut_->rresp_o != model::Axi4LitePort::kOkay) ++seen_.refused;
  clock();
  in_ = {};
  return data;
}

void Recorder::wait(std::uint64_t clocks) {
  for (; clocks != 0; --clocks) clock();
}

void Recorder::reset(int clocks) {
  in_ = {};
  in_.rst = true;
  for (int i = 0; i < clocks; ++i) clock();
  in_ = {};
}

void Recorder::clock() {
  sim::set_inputs(*dut_, in_, kPins);
  dut_.clock();
  model_.clock(in_);
  judge();
  write_line();
}

// Only a correct card is recorded. Its outputs are unknown before the first reset, which takes effect after the
// second clock.
void Recorder::judge() {
  if (++seen_.clocks < 2) return;
  sim::CardRecord rtl;
  sim::CardRecord model;
  rtl.show_rtl<kAxes>(*dut_);
  model.show(model_);
  if (std::memcmp(&rtl, &model, sizeof rtl) != 0) {
    lockstep::fail("recorded card", seen_.clocks, seed_, sim::differences(rtl, model), "");
  }
  count(rtl);
}

void Recorder::count(const sim::CardRecord& rtl) {
  const std::uint32_t rising = rtl.step_o & ~last_step_;
  for (unsigned n = 0; n < kAxes; ++n) seen_.steps += rising >> n & 1U;
  seen_.path_ticks += rtl.path_tick;
  seen_.direct += (rtl.status & card_map::field::kStatusDirect) != 0;
  seen_.held += (rtl.status & card_map::field::kStatusPathActive) != 0 && rtl.ratio == 0;
  seen_.interrupts += rtl.irq_o != 0 && !last_irq_;
  seen_.faulted += rtl.fault != 0;
  last_step_ = rtl.step_o;
  last_irq_ = rtl.irq_o != 0;
}

void Recorder::write_line() {
  line_.clear();
  for_each_port([this](const char*, char, const auto& value, unsigned width) {
    append_hex(line_, value, width);
    line_ += ' ';
  });
  line_.back() = '\n';
  std::fwrite(line_.data(), 1, line_.size(), file_);
}

}  // namespace trammel::netlist
