#include "trammel/transport/memory_bus.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>

#include "trammel/card_map.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::transport {

MemoryBus::MemoryBus(const std::string& path, std::uint64_t offset, bool interrupt, SystemCalls& calls)
    : path_(path), calls_(calls) {
  file_ = calls_.open(path.c_str(), O_RDWR | O_SYNC | O_CLOEXEC);
  if (file_ < 0) fail("cannot open it");
  // mmap() needs page-aligned offsets.
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::uint64_t begin = offset / page * page;
  mapped_bytes_ = static_cast<std::size_t>(offset - begin) + card_map::kWindowBytes;
  void* mapped = calls_.mmap(mapped_bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, static_cast<off_t>(begin));
  if (mapped == MAP_FAILED) {
    const int error = errno;
    calls_.close(file_);
    errno = error;
    fail("cannot map its window");
  }
  mapped_ = mapped;
  window_ = reinterpret_cast<volatile std::uint32_t*>(static_cast<std::uint8_t*>(mapped) + (offset - begin));
  // A UIO device without an interrupt refuses to enable one.
  interrupt_ = interrupt && path.rfind("/dev/uio", 0) == 0 && enable_interrupt();
}

MemoryBus::~MemoryBus() {
  calls_.munmap(mapped_, mapped_bytes_);
  calls_.close(file_);
}

std::size_t MemoryBus::transfer(driver::Access* accesses, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    volatile std::uint32_t* word = window_ + accesses[i].address / 4;
    if (accesses[i].write) {
      calls_.store(word, accesses[i].data);
    } else {
      accesses[i].data = calls_.load(word);
    }
  }
  return count;
}

void MemoryBus::sleep(std::chrono::nanoseconds time) { std::this_thread::sleep_for(time); }

// UIO: writing 1 enables the interrupt, which is disabled automatically when it is raised. A read of 4 bytes takes it.
bool MemoryBus::enable_interrupt() {
  const std::int32_t one = 1;
  return calls_.write(file_, &one, sizeof(one)) == static_cast<ssize_t>(sizeof(one));
}

bool MemoryBus::wait_for_interrupt(std::chrono::nanoseconds longest) {
  using std::chrono::milliseconds;
  if (!interrupt_) return Bus::wait_for_interrupt(longest);
  if (!enable_interrupt()) fail("its interrupt cannot be enabled");
  pollfd entry{file_, POLLIN, 0};
  const auto whole =
      std::chrono::ceil<milliseconds>(std::min<std::chrono::nanoseconds>(longest, std::chrono::hours(1)));
  const int ready = calls_.poll(&entry, static_cast<int>(whole.count()));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return false;
  std::int32_t count = 0;
  if (ready < 0 || calls_.read(file_, &count, sizeof(count)) != static_cast<ssize_t>(sizeof(count))) {
    fail("waiting for its interrupt");
  }
  return true;
}

void MemoryBus::fail(const char* what) const {
  throw driver::LinkError(fmt::format("mmap {}: {}: {}", path_, what, std::strerror(errno)));
}

}  // namespace trammel::transport
