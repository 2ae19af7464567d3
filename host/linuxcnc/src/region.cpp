#include "trammel/linuxcnc/region.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace trammel::linuxcnc {
namespace {

constexpr std::size_t kLongestName = 64;
constexpr std::int64_t kNanoseconds = 1'000'000'000;

bool is_region_name(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

struct flock lock_of(int byte) {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

}  // namespace

Region::Region(const std::string& name, const std::string& folder)
    : path_(folder + "/" + TRAMMEL_REGION_PREFIX + name) {
  if (!is_region_name(name)) {
    throw RegionError(
        fmt::format("\"{}\" is no name for LinuxCNC's shared memory: use up to {} letters, digits, '-' "
                    "and '_'",
                    name, kLongestName));
  }
  try {
    open_file();
    attach();
  } catch (...) {
    if (memory_ != nullptr) ::munmap(memory_, sizeof(trammel_region));
    if (file_ >= 0) ::close(file_);
    throw;
  }
}

// The file is kept: an attached module continues to use it, and the next owner takes it over.
Region::~Region() {
  ::munmap(memory_, sizeof(trammel_region));
  ::close(file_);
}

void Region::fail(const std::string& what) const { throw RegionError(path_ + ": " + what); }

void Region::open_file() {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file_ < 0) {
    fail(fmt::format("{}; LinuxCNC and this program must run as the same user", std::strerror(errno)));
  }
  struct flock lock = lock_of(TRAMMEL_LOCK_OWNER);
  if (::fcntl(file_, F_OFD_SETLK, &lock) != 0) {
    fail("another program owns this card for LinuxCNC; end it, or choose another --name");
  }
  struct stat status {};
  if (::fstat(file_, &status) != 0) fail(std::strerror(errno));
  if (static_cast<std::size_t>(status.st_size) != sizeof(trammel_region)) {
    if (has_hal() || has_planner()) fail("LinuxCNC's modules have another layout of it; install those of this version");
    if (::ftruncate(file_, sizeof(trammel_region)) != 0) fail(std::strerror(errno));
  }
  void* memory = ::mmap(nullptr, sizeof(trammel_region), PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory == MAP_FAILED) fail(std::strerror(errno));
  memory_ = static_cast<trammel_region*>(memory);
}

void Region::attach() {
  const bool hal = has_hal();
  const bool planner = has_planner();
  const auto other = [](std::uint32_t version) { return version != 0 && version != TRAMMEL_REGION_VERSION; };
  if ((hal && other(memory_->version_hal)) || (planner && other(memory_->version_planner))) {
    fail("LinuxCNC's modules have another version of it; install those of this version");
  }
  // A module that attaches at this moment keeps its own `head`, and stores it again in its next period.
  if (!hal && !planner) std::memset(static_cast<void*>(memory_), 0, sizeof(trammel_region));
  memory_->status_sequence += memory_->status_sequence & 1U;  // odd if an owner died while it wrote
  memory_->period_tail = __atomic_load_n(&memory_->period_head, __ATOMIC_ACQUIRE);
  woken_ = __atomic_load_n(&memory_->wake, __ATOMIC_ACQUIRE);
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  session_ = static_cast<std::uint64_t>(now.tv_sec) * kNanoseconds + static_cast<std::uint64_t>(now.tv_nsec);
  __atomic_store_n(&memory_->version_owner, TRAMMEL_REGION_VERSION, __ATOMIC_RELEASE);
}

bool Region::locked_by_another(int byte) const {
  struct flock lock = lock_of(byte);
  return ::fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

void Region::wait(std::chrono::nanoseconds longest) {
  const std::uint32_t now = __atomic_load_n(&memory_->wake, __ATOMIC_ACQUIRE);
  if (now == woken_ && longest.count() > 0) {
    const timespec time{static_cast<time_t>(longest.count() / kNanoseconds),
                        static_cast<long>(longest.count() % kNanoseconds)};
    ::syscall(SYS_futex, &memory_->wake, FUTEX_WAIT, now, &time, nullptr, 0);
  }
  woken_ = __atomic_load_n(&memory_->wake, __ATOMIC_ACQUIRE);
}

std::optional<trammel_period> Region::take_period() {
  const std::uint64_t head = __atomic_load_n(&memory_->period_head, __ATOMIC_ACQUIRE);
  std::uint64_t tail = memory_->period_tail;
  // A larger difference than the number of slots occurs only after a restart of the module.
  if (head - tail > TRAMMEL_PERIODS) tail = head - 1;
  if (head == tail) return std::nullopt;
  const trammel_period period = memory_->periods[tail % TRAMMEL_PERIODS];
  __atomic_store_n(&memory_->period_tail, tail + 1, __ATOMIC_RELEASE);
  return period;
}

std::optional<trammel_settings> Region::new_settings() {
  for (int tries = 0; tries < TRAMMEL_TRIES; ++tries) {
    const std::uint32_t before = __atomic_load_n(&memory_->settings_sequence, __ATOMIC_ACQUIRE);
    if (before == settings_seen_ || before == 0) return std::nullopt;
    if ((before & 1U) != 0) continue;
    const trammel_settings settings = memory_->settings;
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (__atomic_load_n(&memory_->settings_sequence, __ATOMIC_RELAXED) != before) continue;
    settings_seen_ = before;
    return settings;
  }
  return std::nullopt;
}

void Region::publish(const trammel_status& status) {
  const std::uint32_t sequence = memory_->status_sequence;
  __atomic_store_n(&memory_->status_sequence, sequence + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  memory_->status = status;
  memory_->status.session = session_;
  memory_->status.beat = ++beat_;
  __atomic_store_n(&memory_->status_sequence, sequence + 2, __ATOMIC_RELEASE);
}

}  // namespace trammel::linuxcnc
