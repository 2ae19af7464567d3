// SPI and memory at their system calls: exact accesses, lengths, errors. No hardware was there; at the other end of the
// calls is a card's frame engine without time, or memory.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/spi/spidev.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <functional>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/frames/endpoint.hpp"
#include "trammel/transport/links.hpp"
#include "trammel/transport/memory_bus.hpp"

namespace trammel::transport {
namespace {

using namespace std::chrono_literals;
using driver::Access;
using ::testing::_;
using ::testing::HasSubstr;
using ::testing::InSequence;
using ::testing::Invoke;
using ::testing::Return;
using ::testing::StrEq;
using ::testing::StrictMock;

class Calls : public SystemCalls {
 public:
  MOCK_METHOD(int, open, (const char*, int), (override));
  MOCK_METHOD(int, close, (int), (override));
  MOCK_METHOD(int, ioctl, (int, unsigned long, void*), (override));
  MOCK_METHOD(ssize_t, read, (int, void*, std::size_t), (override));
  MOCK_METHOD(ssize_t, write, (int, const void*, std::size_t), (override));
  MOCK_METHOD(int, poll, (pollfd*, int), (override));
  MOCK_METHOD(void*, mmap, (std::size_t, int, int, int, off_t), (override));
  MOCK_METHOD(int, munmap, (void*, std::size_t), (override));
  MOCK_METHOD(std::uint32_t, load, (const volatile std::uint32_t*), (override));
  MOCK_METHOD(void, store, (volatile std::uint32_t*, std::uint32_t), (override));
};

constexpr int kFile = 7;

// A failing call.
template <class Result>
auto fails(Result result, int error) {
  return Invoke([result, error](auto...) {
    errno = error;
    return result;
  });
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const driver::LinkError& error) {
    return error.what();
  }
  return "";
}

// --- memory ---

class MemoryTest : public ::testing::Test {
 protected:
  void expect_open(const char* path, std::size_t length, off_t offset) {
    EXPECT_CALL(calls_, open(StrEq(path), O_RDWR | O_SYNC | O_CLOEXEC)).WillOnce(Return(kFile));
    EXPECT_CALL(calls_, mmap(length, PROT_READ | PROT_WRITE, MAP_SHARED, kFile, offset))
        .WillOnce(Return(memory_.data()));
  }
  void expect_close(std::size_t length) {
    EXPECT_CALL(calls_, munmap(memory_.data(), length)).WillOnce(Return(0));
    EXPECT_CALL(calls_, close(kFile)).WillOnce(Return(0));
  }
  void expect_enable() {
    EXPECT_CALL(calls_, write(kFile, _, 4)).WillOnce(Invoke([](int, const void* bytes, std::size_t) {
      EXPECT_EQ(*static_cast<const std::int32_t*>(bytes), 1);
      return ssize_t{4};
    }));
  }

  std::array<std::uint32_t, 2048> memory_{};
  StrictMock<Calls> calls_;
  InSequence in_order_;
};

TEST_F(MemoryTest, OneAccessOf32BitsForEachInOrder) {
  expect_open("/dev/mem", 4096, 0x43C00000);
  EXPECT_CALL(calls_, store(&memory_[0x1C0 / 4], 5));
  EXPECT_CALL(calls_, load(&memory_[0x04 / 4])).WillOnce(Return(77));
  EXPECT_CALL(calls_, store(&memory_[0x1C0 / 4], 6));
  EXPECT_CALL(calls_, load(&memory_[0xFFC / 4])).WillOnce(Return(78));
  expect_close(4096);
  MemoryBus bus("/dev/mem", 0x43C00000, true, calls_);
  EXPECT_FALSE(bus.reports_refusals());
  EXPECT_FALSE(bus.has_interrupt()) << "/dev/mem has none";
  std::array<Access, 4> accesses{driver::write_of(0x1C0, 5), driver::read_of(0x04), driver::write_of(0x1C0, 6),
                                 driver::read_of(0xFFC)};
  EXPECT_EQ(bus.transfer(accesses.data(), accesses.size()), 4U);
  EXPECT_EQ(accesses[1].data, 77U);
  EXPECT_EQ(accesses[3].data, 78U);
  EXPECT_EQ(bus.transfer(nullptr, 0), 0U);
}

TEST_F(MemoryTest, AnOffsetWithinAPageIsMappedFromThePage) {
  expect_open("/dev/mem", 4096 + 0x804, 0x1000);
  EXPECT_CALL(calls_, load(&memory_[(0x804 + 0x08) / 4])).WillOnce(Return(4));
  expect_close(4096 + 0x804);
  MemoryBus bus("/dev/mem", 0x1804, true, calls_);
  Access access = driver::read_of(0x08);
  bus.transfer(&access, 1);
  EXPECT_EQ(access.data, 4U);
}

TEST_F(MemoryTest, UioInterrupt) {
  expect_open("/dev/uio0", 4096, 0);
  expect_enable();
  expect_enable();
  EXPECT_CALL(calls_, poll(_, 3)).WillOnce(Invoke([](pollfd* entry, int) {
    EXPECT_EQ(entry->fd, kFile);
    EXPECT_EQ(entry->events, POLLIN);
    return 1;
  }));
  EXPECT_CALL(calls_, read(kFile, _, 4)).WillOnce(Return(4));
  expect_enable();
  EXPECT_CALL(calls_, poll(_, 0)).WillOnce(Return(0));
  expect_enable();
  EXPECT_CALL(calls_, poll(_, 1)).WillOnce(fails(-1, EINTR));
  expect_enable();
  EXPECT_CALL(calls_, poll(_, 1)).WillOnce(Return(1));
  EXPECT_CALL(calls_, read(kFile, _, 4)).WillOnce(fails(ssize_t{-1}, EIO));
  expect_close(4096);
  MemoryBus bus("/dev/uio0", 0, true, calls_);
  ASSERT_TRUE(bus.has_interrupt());
  EXPECT_TRUE(bus.wait_for_interrupt(2500us)) << "rounded up to 3 ms";
  EXPECT_FALSE(bus.wait_for_interrupt(0ns));
  EXPECT_FALSE(bus.wait_for_interrupt(1ms));
  EXPECT_THAT(message_of([&] { bus.wait_for_interrupt(1ms); }), HasSubstr("mmap /dev/uio0: waiting for its interrupt"));
}

TEST_F(MemoryTest, WithoutAnInterruptAWaitIsASleep) {
  expect_open("/dev/uio1", 4096, 0x1000);
  EXPECT_CALL(calls_, write(kFile, _, 4)).WillOnce(fails(ssize_t{-1}, EIO));
  expect_close(4096);
  {
    MemoryBus bus("/dev/uio1", 0x1000, true, calls_);
    EXPECT_FALSE(bus.has_interrupt());
    EXPECT_FALSE(bus.wait_for_interrupt(1ns));
  }
  expect_open("/dev/uio0", 4096, 0);
  expect_close(4096);
  const MemoryBus unwanted("/dev/uio0", 0, false, calls_);
  EXPECT_FALSE(unwanted.has_interrupt());
}

TEST_F(MemoryTest, Errors) {
  EXPECT_CALL(calls_, open(_, _)).WillOnce(fails(-1, EACCES));
  EXPECT_THAT(message_of([&] { MemoryBus("/dev/mem", 0, true, calls_); }),
              HasSubstr("mmap /dev/mem: cannot open it: Permission denied"));
  EXPECT_CALL(calls_, open(_, _)).WillOnce(Return(kFile));
  EXPECT_CALL(calls_, mmap(_, _, _, _, _)).WillOnce(fails(MAP_FAILED, EPERM));
  EXPECT_CALL(calls_, close(kFile)).WillOnce(fails(-1, EIO));
  EXPECT_THAT(message_of([&] { MemoryBus("/dev/mem", 0, true, calls_); }),
              HasSubstr("cannot map its window: Operation not permitted"));
}

// --- SPI ---

// A card at the wires' end: its reply goes out in the exchanges that follow, ends where it has nothing to say.
class SpiCard {
 public:
  explicit SpiCard(frames::Endpoint::Access access) : endpoint_(std::move(access)) {}

  int exchange(void* argument) {
    const auto& transfer = *static_cast<const spi_ioc_transfer*>(argument);
    EXPECT_EQ(transfer.speed_hz, 12'500'000U);
    EXPECT_EQ(transfer.bits_per_word, 8);
    EXPECT_EQ(transfer.cs_change, 0);
    const auto* out = reinterpret_cast<const std::uint8_t*>(static_cast<std::uintptr_t>(transfer.tx_buf));
    auto* in = reinterpret_cast<std::uint8_t*>(static_cast<std::uintptr_t>(transfer.rx_buf));
    lengths.push_back(transfer.len);
    for (std::uint32_t i = 0; i < transfer.len; ++i) {
      in[i] = said_ < reply_.size() ? reply_[said_++] : frames::kEnd;
      if (i == 0) sent.emplace_back();
      sent.back().push_back(out[i]);
    }
    for (std::uint32_t i = 0; i < transfer.len; ++i) endpoint_.take(out[i], reply_);
    return static_cast<int>(transfer.len);
  }

  std::vector<std::uint32_t> lengths;
  std::vector<frames::Bytes> sent;

 private:
  frames::Endpoint endpoint_;
  frames::Bytes reply_;
  std::size_t said_ = 0;
};

class SpiTest : public ::testing::Test {
 protected:
  void expect_open(unsigned mode) {
    EXPECT_CALL(calls_, open(StrEq("/dev/spidev0.0"), O_RDWR | O_CLOEXEC)).WillOnce(Return(kFile));
    EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_WR_MODE, _)).WillOnce(Invoke([mode](int, unsigned long, void* value) {
      EXPECT_EQ(*static_cast<std::uint8_t*>(value), mode);
      return 0;
    }));
    EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_WR_BITS_PER_WORD, _)).WillOnce(Invoke([](int, unsigned long, void* value) {
      EXPECT_EQ(*static_cast<std::uint8_t*>(value), 8);
      return 0;
    }));
    EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_WR_MAX_SPEED_HZ, _)).WillOnce(Invoke([](int, unsigned long, void* value) {
      EXPECT_EQ(*static_cast<std::uint32_t*>(value), 12'500'000U);
      return 0;
    }));
    EXPECT_CALL(calls_, close(kFile)).WillOnce(Return(0));
  }

  StrictMock<Calls> calls_;
};

TEST_F(SpiTest, TheReplyComesInTheNextExchanges) {
  expect_open(3);
  std::vector<std::uint32_t> written;
  SpiCard card([&](bool write, std::uint32_t address, std::uint32_t data) {
    if (write) written.push_back(data);
    return frames::Endpoint::Answer{false, address};
  });
  EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_MESSAGE(1), _))
      .WillRepeatedly(Invoke([&](int, unsigned long, void* transfer) { return card.exchange(transfer); }));
  SpiLink link("/dev/spidev0.0", {12'500'000, 3}, calls_);
  driver::FrameBus bus(link);
  std::vector<Access> accesses;
  for (std::uint32_t i = 0; i < 59; ++i) accesses.push_back(driver::write_of(0x1C0, 0xC0DBC0DB + i));
  for (std::uint32_t i = 0; i < 59; ++i) accesses.push_back(driver::read_of(0x100 + 4 * i));
  card.lengths.clear();
  card.sent.clear();
  EXPECT_EQ(bus.transfer(accesses.data(), accesses.size()), accesses.size());
  EXPECT_EQ(written.size(), 59U);
  EXPECT_EQ(accesses.back().data, 0x100U + 4 * 58);
  EXPECT_EQ(bus.counts().sent_again, 0U);
  // The write in one exchange, its reply (36 bytes and what is stuffed) in the next; then the read, and 272 bytes or
  // more in exchanges of 48.
  frames::Request request;
  request.kind = frames::Kind::Write;
  request.fixed = true;
  request.count = 59;
  request.number = 1;
  request.epoch = 1;
  request.address = 0x1C0;
  for (std::uint32_t i = 0; i < 59; ++i) request.data.push_back(0xC0DBC0DB + i);
  frames::Bytes due{frames::kEnd};
  frames::append_request(due, request);
  ASSERT_GE(card.sent.size(), 4U);
  EXPECT_EQ(card.sent[0], due);
  EXPECT_EQ(card.lengths[0], due.size());
  EXPECT_EQ(card.lengths[1], 48U);
  EXPECT_EQ(card.sent[1], frames::Bytes(48, frames::kEnd)) << "ends flow while there is nothing to say";
  for (std::size_t i = 3; i < card.lengths.size(); ++i) EXPECT_EQ(card.lengths[i], 48U);
  EXPECT_LE(card.lengths.size(), 10U);
}

TEST_F(SpiTest, SilenceIsNothing) {
  expect_open(0);
  EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_MESSAGE(1), _))
      .WillRepeatedly(Invoke([&](int, unsigned long, void* argument) {
        const auto& transfer = *static_cast<const spi_ioc_transfer*>(argument);
        auto* in = reinterpret_cast<std::uint8_t*>(static_cast<std::uintptr_t>(transfer.rx_buf));
        std::fill_n(in, transfer.len, frames::kEnd);
        return static_cast<int>(transfer.len);
      }));
  SpiLink link("/dev/spidev0.0", {12'500'000, 0}, calls_);
  std::array<std::uint8_t, 16> bytes{};
  EXPECT_EQ(link.receive(bytes.data(), bytes.size(), 0ns), 0U);
  EXPECT_EQ(link.receive(bytes.data(), bytes.size(), 1ms), 0U);
  EXPECT_EQ(link.time_of(1000), 1000 * 641ns) << "8 bits at 12.5 MHz, rounded up";
}

TEST_F(SpiTest, Errors) {
  EXPECT_CALL(calls_, open(_, _)).WillOnce(fails(-1, ENOENT));
  EXPECT_THAT(message_of([&] { SpiLink("/dev/spidev0.0", {}, calls_); }),
              HasSubstr("spi /dev/spidev0.0: cannot open it: No such file or directory"));

  EXPECT_CALL(calls_, open(_, _)).WillOnce(Return(kFile));
  EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_WR_MODE, _)).WillOnce(fails(-1, ENOTTY));
  EXPECT_CALL(calls_, close(kFile)).WillOnce(Return(0));
  EXPECT_THAT(message_of([&] { SpiLink("/dev/spidev0.0", {}, calls_); }), HasSubstr("it takes no mode"));

  expect_open(0);
  SpiLink link("/dev/spidev0.0", {12'500'000, 0}, calls_);
  const std::array<std::uint8_t, 5> bytes{};
  EXPECT_CALL(calls_, ioctl(kFile, SPI_IOC_MESSAGE(1), _)).WillOnce(fails(-1, EMSGSIZE)).WillOnce(Return(3));
  EXPECT_THAT(message_of([&] { link.send(bytes.data(), bytes.size()); }), HasSubstr("an exchange failed"));
  EXPECT_THAT(message_of([&] { link.send(bytes.data(), bytes.size()); }), HasSubstr("3 of 5 bytes were exchanged"));
}

}  // namespace
}  // namespace trammel::transport
