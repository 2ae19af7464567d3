// SPI and memory with mocked system calls: exact accesses, lengths, errors. No hardware was used; the other end of the
// calls is the frame engine of a card without timing, or memory.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <linux/spi/spidev.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <deque>
#include <functional>
#include <memory>
#include <string>

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
using ::testing::HasSubstr;

// Expected calls to the device in order, with their results. Any other call fails the test, and so does a missing one.
class Calls final : public SystemCalls {
 public:
  using Answer = std::function<std::int64_t(const void*)>;

  ~Calls() override {
    for (const Due& due : due_) ADD_FAILURE() << "did not come: " << due.call;
  }
  Calls() = default;

  void expect(const std::string& call, std::int64_t result = 0, int error = 0) {
    due_.push_back({call, [result, error](const void*) {
                      errno = error;
                      return result;
                    }});
  }
  // The answer may read the argument of the call.
  void expect(const std::string& call, Answer answer) { due_.push_back({call, std::move(answer)}); }
  // Answers all further exchange calls when no other call is expected.
  void exchange_with(Answer answer) { exchange_ = std::move(answer); }
  void map_at(void* memory) { memory_ = static_cast<std::uint8_t*>(memory); }

  int open(const char* path, int flags) override { return make<int>(fmt::format("open {} {}", path, flags)); }
  int close(int file) override { return make<int>(fmt::format("close {}", file)); }
  int ioctl(int file, unsigned long request, void* argument) override {
    if (due_.empty() && exchange_ && request == SPI_IOC_MESSAGE(1)) return static_cast<int>(exchange_(argument));
    return make<int>(fmt::format("ioctl {} {}", file, request), argument);
  }
  ssize_t read(int file, void* bytes, std::size_t count) override {
    return make<ssize_t>(fmt::format("read {} {}", file, count), bytes);
  }
  ssize_t write(int file, const void* bytes, std::size_t count) override {
    return make<ssize_t>(fmt::format("write {} {}", file, count), bytes);
  }
  int poll(pollfd* file, int milliseconds) override {
    return make<int>(fmt::format("poll {} {} {}", file->fd, file->events, milliseconds));
  }
  void* mmap(std::size_t length, int protection, int flags, int file, off_t offset) override {
    const auto made =
        make<int>(fmt::format("mmap {} {} {} {} {}", length, protection, flags, file, std::int64_t{offset}));
    return made < 0 ? MAP_FAILED : memory_;
  }
  int munmap(void* address, std::size_t length) override {
    EXPECT_EQ(address, memory_);
    return make<int>(fmt::format("munmap {}", length));
  }
  std::uint32_t load(const volatile std::uint32_t* word) override {
    return make<std::uint32_t>(fmt::format("load {}", place(word)));
  }
  void store(volatile std::uint32_t* word, std::uint32_t value) override {
    make<int>(fmt::format("store {} {}", place(word), value));
  }

 private:
  struct Due {
    std::string call;
    Answer answer;
  };

  template <class Result>
  Result make(const std::string& call, const void* argument = nullptr) {
    const std::string next = due_.empty() ? "nothing" : due_.front().call;
    EXPECT_EQ(call, next);
    if (call != next) return Result{};
    const Answer answer = due_.front().answer;
    due_.pop_front();
    return static_cast<Result>(answer(argument));
  }
  // Bytes from the start of the mapping.
  std::ptrdiff_t place(const volatile std::uint32_t* word) const {
    return reinterpret_cast<const volatile std::uint8_t*>(word) - memory_;
  }

  std::deque<Due> due_;
  Answer exchange_;
  std::uint8_t* memory_ = nullptr;
};

constexpr int kFile = 7;

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
  MemoryTest() { calls_.map_at(memory_.data()); }
  void expect_open(const char* path, std::size_t length, std::int64_t offset) {
    calls_.expect(fmt::format("open {} {}", path, O_RDWR | O_SYNC | O_CLOEXEC), kFile);
    calls_.expect(fmt::format("mmap {} {} {} {} {}", length, PROT_READ | PROT_WRITE, MAP_SHARED, kFile, offset));
  }
  void expect_close(std::size_t length) {
    calls_.expect(fmt::format("munmap {}", length));
    calls_.expect("close 7");
  }
  void expect_enable() {
    calls_.expect("write 7 4", [](const void* bytes) {
      EXPECT_EQ(*static_cast<const std::int32_t*>(bytes), 1);
      return 4;
    });
  }

  std::array<std::uint32_t, 2048> memory_{};
  Calls calls_;
};

TEST_F(MemoryTest, OneAccessOf32BitsForEachInOrder) {
  expect_open("/dev/mem", 4096, 0x43C00000);
  calls_.expect("store 448 5");
  calls_.expect("load 4", 77);
  calls_.expect("store 448 6");
  calls_.expect("load 4092", 78);
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
  calls_.expect(fmt::format("load {}", 0x804 + 0x08), 4);
  expect_close(4096 + 0x804);
  MemoryBus bus("/dev/mem", 0x1804, true, calls_);
  Access access = driver::read_of(0x08);
  bus.transfer(&access, 1);
  EXPECT_EQ(access.data, 4U);
}

TEST_F(MemoryTest, UioInterrupt) {
  const auto poll_of = [](int milliseconds) { return fmt::format("poll 7 {} {}", POLLIN, milliseconds); };
  expect_open("/dev/uio0", 4096, 0);
  expect_enable();
  expect_enable();
  calls_.expect(poll_of(3), 1);
  calls_.expect("read 7 4", 4);
  expect_enable();
  calls_.expect(poll_of(0), 0);
  expect_enable();
  calls_.expect(poll_of(1), -1, EINTR);
  expect_enable();
  calls_.expect(poll_of(1), 1);
  calls_.expect("read 7 4", -1, EIO);
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
  calls_.expect("write 7 4", -1, EIO);
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
  const std::string opened = fmt::format("open /dev/mem {}", O_RDWR | O_SYNC | O_CLOEXEC);
  calls_.expect(opened, -1, EACCES);
  EXPECT_THAT(message_of([&] { MemoryBus("/dev/mem", 0, true, calls_); }),
              HasSubstr("mmap /dev/mem: cannot open it: Permission denied"));
  calls_.expect(opened, kFile);
  calls_.expect(fmt::format("mmap 4096 {} {} 7 0", PROT_READ | PROT_WRITE, MAP_SHARED), -1, EPERM);
  calls_.expect("close 7", -1, EIO);
  EXPECT_THAT(message_of([&] { MemoryBus("/dev/mem", 0, true, calls_); }),
              HasSubstr("cannot map its window: Operation not permitted"));
}

// --- SPI ---

// A card at the other end of the wires. Its reply goes out in the following exchanges; it sends END bytes when it has
// nothing to say.
class SpiCard {
 public:
  explicit SpiCard(frames::Endpoint::Access access) : endpoint_(std::move(access)) {}

  std::int64_t exchange(const void* argument) {
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
    return transfer.len;
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
  // The call points to a byte or a word.
  template <class Value>
  void expect_setting(unsigned long request, Value due) {
    calls_.expect(fmt::format("ioctl 7 {}", request), [due](const void* value) {
      EXPECT_EQ(*static_cast<const Value*>(value), due);
      return 0;
    });
  }
  void expect_open(std::uint8_t mode) {
    calls_.expect(opened_, kFile);
    expect_setting<std::uint8_t>(SPI_IOC_WR_MODE, mode);
    expect_setting<std::uint8_t>(SPI_IOC_WR_BITS_PER_WORD, 8);
    expect_setting<std::uint32_t>(SPI_IOC_WR_MAX_SPEED_HZ, 12'500'000);
  }
  // A link that the caller closes by destroying it.
  std::unique_ptr<SpiLink> link_of(unsigned mode) {
    return std::make_unique<SpiLink>("/dev/spidev0.0", SpiLink::Options{12'500'000, mode}, calls_);
  }

  const std::string opened_ = fmt::format("open /dev/spidev0.0 {}", O_RDWR | O_CLOEXEC);
  const std::string exchanged_ = fmt::format("ioctl 7 {}", std::uint64_t{SPI_IOC_MESSAGE(1)});
  Calls calls_;
};

TEST_F(SpiTest, TheReplyComesInTheNextExchanges) {
  expect_open(3);
  std::vector<std::uint32_t> written;
  SpiCard card([&](bool write, std::uint32_t address, std::uint32_t data) {
    if (write) written.push_back(data);
    return frames::Endpoint::Answer{false, address};
  });
  calls_.exchange_with([&](const void* transfer) { return card.exchange(transfer); });
  const std::unique_ptr<SpiLink> opened = link_of(3);
  SpiLink& link = *opened;
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
  // One exchange carries the write, the next one its reply (36 bytes plus stuffing). Then the read follows, with a
  // reply of at least 272 bytes in exchanges of 48 bytes.
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
  calls_.expect("close 7");
}

TEST_F(SpiTest, SilenceIsNothing) {
  expect_open(0);
  calls_.exchange_with([](const void* argument) -> std::int64_t {
    const auto& transfer = *static_cast<const spi_ioc_transfer*>(argument);
    auto* in = reinterpret_cast<std::uint8_t*>(static_cast<std::uintptr_t>(transfer.rx_buf));
    std::fill_n(in, transfer.len, frames::kEnd);
    return transfer.len;
  });
  const std::unique_ptr<SpiLink> link = link_of(0);
  std::array<std::uint8_t, 16> bytes{};
  EXPECT_EQ(link->receive(bytes.data(), bytes.size(), 0ns), 0U);
  EXPECT_EQ(link->receive(bytes.data(), bytes.size(), 1ms), 0U);
  EXPECT_EQ(link->time_of(1000), 1000 * 641ns) << "8 bits at 12.5 MHz, rounded up";
  calls_.expect("close 7");
}

TEST_F(SpiTest, Errors) {
  calls_.expect(opened_, -1, ENOENT);
  EXPECT_THAT(message_of([&] { link_of(0); }), HasSubstr("spi /dev/spidev0.0: cannot open it: No such file"));

  calls_.expect(opened_, kFile);
  calls_.expect(fmt::format("ioctl 7 {}", std::uint64_t{SPI_IOC_WR_MODE}), -1, ENOTTY);
  calls_.expect("close 7");
  EXPECT_THAT(message_of([&] { link_of(0); }), HasSubstr("it takes no mode"));

  expect_open(0);
  const std::unique_ptr<SpiLink> link = link_of(0);
  const std::array<std::uint8_t, 5> bytes{};
  calls_.expect(exchanged_, -1, EMSGSIZE);
  EXPECT_THAT(message_of([&] { link->send(bytes.data(), bytes.size()); }), HasSubstr("an exchange failed"));
  calls_.expect(exchanged_, 3);
  EXPECT_THAT(message_of([&] { link->send(bytes.data(), bytes.size()); }), HasSubstr("3 of 5 bytes were exchanged"));
  calls_.expect("close 7");
}

}  // namespace
}  // namespace trammel::transport
