#include "transactors.hpp"

#include <string>

#include "bundles.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::platform {

namespace {

using std::chrono::nanoseconds;

constexpr std::uint8_t kAllStrobes = 0xF;
constexpr unsigned kBitsOfByte = 10;  // bits per byte on a serial line

nanoseconds to_ns(const sc_core::sc_time& time) {
  return nanoseconds(static_cast<std::int64_t>(time.to_seconds() * 1e9 + 0.5));
}

// At the pins nothing may run ahead of SystemC's time.
void catch_up(sc_core::sc_time& delay) {
  if (delay != sc_core::SC_ZERO_TIME) sc_core::wait(delay);
  delay = sc_core::SC_ZERO_TIME;
}

// Waits for the first rising edge at which `done` is true.
template <class Done>
void wait_for(const sc_core::sc_in<bool>& clk, Done done) {
  for (int i = 0; i < kLongestAnswer; ++i) {
    sc_core::wait(clk.posedge_event());
    if (done()) return;
  }
  throw driver::LinkError("no answer from the card in " + std::to_string(kLongestAnswer) + " clocks");
}

}  // namespace

std::size_t AxiTransactor::transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) {
  catch_up(delay);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(accesses[i].write ? write(accesses[i]) : read(accesses[i]))) return i;
  }
  return count;
}

// At a rising edge the card's pins show the values from before it, so a handshake is seen at the edge at which it
// happens.
bool AxiTransactor::write(const driver::Access& access) {
  AxiMaster m;
  m.awvalid = m.wvalid = true;
  m.awaddr = static_cast<std::uint16_t>(access.address);
  m.wdata = access.data;
  m.wstrb = kAllStrobes;
  m.bready = true;
  master.write(m);
  wait_for(clk, [&] {
    if (card.read().awready) m.awvalid = false;
    if (card.read().wready) m.wvalid = false;
    master.write(m);
    return !m.awvalid && !m.wvalid;
  });
  wait_for(clk, [&] { return card.read().bvalid; });
  const bool okay = card.read().bresp == 0;
  master.write({});
  return okay;
}

bool AxiTransactor::read(driver::Access& access) {
  AxiMaster m;
  m.arvalid = m.rready = true;
  m.araddr = static_cast<std::uint16_t>(access.address);
  master.write(m);
  wait_for(clk, [&] { return card.read().arready; });
  m.arvalid = false;
  master.write(m);
  wait_for(clk, [&] { return card.read().rvalid; });
  const bool okay = card.read().rresp == 0;
  if (okay) access.data = card.read().rdata;
  master.write({});
  return okay;
}

std::size_t WishboneTransactor::transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) {
  catch_up(delay);
  std::size_t made = 0;
  while (made < count && access(accesses[made])) ++made;
  master.write({});
  return made;
}

// CYC stays high from one access to the next. A classic master's request lasts until its answer, a pipelined one's
// until it is accepted.
bool WishboneTransactor::access(driver::Access& access) {
  WishboneMaster m;
  m.cyc = m.stb = true;
  m.we = access.write;
  m.sel = kAllStrobes;
  m.adr = static_cast<std::uint16_t>(access.address);
  m.dat = access.data;
  master.write(m);
  if (!classic_) {
    wait_for(clk, [&] { return !card.read().stall; });
    m.stb = false;
    master.write(m);
  }
  wait_for(clk, [&] { return card.read().ack || card.read().err; });
  if (card.read().ack && !access.write) access.data = card.read().dat;
  return card.read().ack;
}

nanoseconds FrameTransactor::now() const { return to_ns(sc_core::sc_time_stamp()); }

std::size_t FrameTransactor::take(std::uint8_t* bytes, std::size_t room) {
  std::size_t count = 0;
  for (; count < room && !came_.empty(); ++count) {
    bytes[count] = came_.front();
    came_.pop_front();
  }
  return count;
}

std::size_t FrameTransactor::transfer(driver::Access* accesses, std::size_t count, sc_core::sc_time& delay) {
  catch_up(delay);
  if (!bus_) bus_.emplace(static_cast<driver::ByteLink&>(*this));
  return bus_->transfer(accesses, count);
}

UartTransactor::UartTransactor(const sc_core::sc_module_name& name, double baud, const sc_core::sc_time& break_time)
    : FrameTransactor(name), baud_(baud), break_time_(break_time) {
  SC_HAS_PROCESS(UartTransactor);
  SC_THREAD(listen);
}

void UartTransactor::put(bool level, double bits) {
  rx.write(level);
  wait(sc_core::sc_time(bits / baud_, sc_core::SC_SEC));
}

void UartTransactor::send(const std::uint8_t* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    put(false, 1);
    for (unsigned bit = 0; bit < 8; ++bit) put((bytes[i] >> bit & 1) != 0, 1);
    put(true, 1);
  }
}

std::size_t UartTransactor::receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) {
  if (came_.empty()) wait(to_sc(longest), byte_came_);
  return take(bytes, room);
}

void UartTransactor::restart() {
  rx.write(false);
  wait(break_time_);
  put(true, 3);
  const std::uint8_t tells_the_rate = 0x55;
  send(&tells_the_rate, 1);
  put(true, 2);
  came_.clear();
}

nanoseconds UartTransactor::time_of(std::size_t bytes) const {
  return nanoseconds(static_cast<std::int64_t>(1e9 * kBitsOfByte / baud_ * static_cast<double>(bytes) + 1));
}

// Samples the middle of each bit, counted from the start bit's edge. A byte without a stop bit is ignored.
void UartTransactor::listen() {
  for (;;) {
    wait(tx.negedge_event());
    wait(sc_core::sc_time(1.5 / baud_, sc_core::SC_SEC));
    unsigned byte = 0;
    for (unsigned bit = 0; bit < 8; ++bit) {
      byte |= unsigned{tx.read()} << bit;
      wait(sc_core::sc_time(1 / baud_, sc_core::SC_SEC));
    }
    if (!tx.read()) continue;
    came_.push_back(static_cast<std::uint8_t>(byte));
    byte_came_.notify();
  }
}

void SpiTransactor::send(const std::uint8_t* bytes, std::size_t count) { exchange(bytes, count); }

std::size_t SpiTransactor::receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) {
  const std::uint8_t nothing[8] = {frames::kEnd, frames::kEnd, frames::kEnd, frames::kEnd,
                                   frames::kEnd, frames::kEnd, frames::kEnd, frames::kEnd};
  for (const nanoseconds until = now() + longest; came_.empty() && now() < until;) exchange(nothing, 8);
  return take(bytes, room);
}

// The time to send and to receive, in exchanges of eight bytes.
nanoseconds SpiTransactor::time_of(std::size_t bytes) const {
  return to_ns(static_cast<double>(bytes + 8) * 16 * half_ + static_cast<double>(bytes / 8 + 2) * 2 * gap_);
}

// Leaves out ends that only fill, so that silence is empty.
void SpiTransactor::exchange(const std::uint8_t* bytes, std::size_t count) {
  master.write({true, false, false});
  wait(gap_);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t byte = exchange(bytes[i]);
    if (byte != frames::kEnd || last_ != frames::kEnd) came_.push_back(byte);
    last_ = byte;
  }
  wait(gap_);
  master.write({true, true, false});
  wait(gap_);
}

// Highest bit first: output at SCK's falling edge, sampled at its rising edge.
std::uint8_t SpiTransactor::exchange(std::uint8_t byte) {
  unsigned in = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    const bool mosi = (byte << bit & 0x80) != 0;
    master.write({false, false, mosi});
    wait(half_);
    in = in << 1 | unsigned{card.read().miso};
    master.write({true, false, mosi});
    wait(half_);
  }
  return static_cast<std::uint8_t>(in);
}

}  // namespace trammel::platform
