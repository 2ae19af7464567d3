#include <fcntl.h>
#include <fmt/format.h>
#include <linux/spi/spidev.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "trammel/driver/errors.hpp"
#include "trammel/frames/stuffing.hpp"
#include "trammel/transport/links.hpp"

namespace trammel::transport {
namespace {

using std::chrono::nanoseconds;

// spidev's default limit per transfer is 4096 bytes; a request is shorter than this value.
constexpr std::size_t kLongestExchange = 2048;
// Bytes per exchange of receive(): short, so that a fast card's answer is seen early; a reply without words has at
// least 36 bytes.
constexpr std::size_t kListen = 48;

}  // namespace

SpiLink::SpiLink(const std::string& device, const Options& options, SystemCalls& calls)
    : device_(device), options_(options), calls_(calls), last_(frames::kEnd) {
  file_ = calls_.open(device.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) fail("cannot open it");
  try {
    std::uint8_t mode = options.mode == 3 ? SPI_MODE_3 : SPI_MODE_0;
    std::uint8_t bits = 8;
    set(SPI_IOC_WR_MODE, &mode, "it takes no mode");
    set(SPI_IOC_WR_BITS_PER_WORD, &bits, "it takes no words of 8 bits");
    set(SPI_IOC_WR_MAX_SPEED_HZ, &options_.sck_hz, "it takes no such SCK");
  } catch (...) {
    calls_.close(file_);
    throw;
  }
}

SpiLink::~SpiLink() { calls_.close(file_); }

void SpiLink::set(unsigned long request, void* value, const char* what) {
  if (calls_.ioctl(file_, request, value) < 0) fail(what);
}

void SpiLink::send(const std::uint8_t* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count; done += kLongestExchange) {
    exchange(bytes + done, std::min(kLongestExchange, count - done));
  }
}

// Makes at least one exchange, so that a longest wait of 0 is a poll.
std::size_t SpiLink::receive(std::uint8_t* bytes, std::size_t room, nanoseconds longest) {
  constexpr auto kFill = [] {
    std::array<std::uint8_t, kListen> fill{};
    for (std::uint8_t& byte : fill) byte = frames::kEnd;
    return fill;
  }();
  const nanoseconds until = now() + longest;
  while (came_.empty()) {
    exchange(kFill.data(), kFill.size());
    if (now() >= until) break;
  }
  const std::size_t count = std::min(room, came_.size());
  std::copy_n(came_.begin(), count, bytes);
  came_.erase(came_.begin(), came_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

// Drops repeated kEnd bytes, which are only fill, so that an idle card yields no bytes.
void SpiLink::exchange(const std::uint8_t* bytes, std::size_t count) {
  std::array<std::uint8_t, kLongestExchange> received{};
  spi_ioc_transfer transfer{};
  transfer.tx_buf = reinterpret_cast<std::uintptr_t>(bytes);
  transfer.rx_buf = reinterpret_cast<std::uintptr_t>(received.data());
  transfer.len = static_cast<std::uint32_t>(count);
  transfer.speed_hz = options_.sck_hz;
  transfer.bits_per_word = 8;
  const int made = calls_.ioctl(file_, SPI_IOC_MESSAGE(1), &transfer);
  if (made < 0) fail("an exchange failed");
  if (static_cast<std::size_t>(made) != count) {
    throw driver::LinkError(fmt::format("spi {}: {} of {} bytes were exchanged", device_, made, count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (received[i] != frames::kEnd || last_ != frames::kEnd) came_.push_back(received[i]);
    last_ = received[i];
  }
}

nanoseconds SpiLink::time_of(std::size_t bytes) const {
  return nanoseconds(static_cast<std::int64_t>(8'000'000'000 / options_.sck_hz + 1) * static_cast<std::int64_t>(bytes));
}

void SpiLink::fail(const char* what) const {
  throw driver::LinkError(fmt::format("spi {}: {}: {}", device_, what, std::strerror(errno)));
}

}  // namespace trammel::transport
