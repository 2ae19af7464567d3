// The owner's end of the memory that it shares with LinuxCNC's realtime modules (shared_region.h). Linux only: it needs
// open-file-description locks and a futex.
//
// Thread-safety: one thread. The other ends live in other processes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

// The memory cannot be had. what() names the file and says what to do.
class RegionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Region {
 public:
  // Opens or creates the file of `name` (letters, digits, '-', '_'; at most 64) and becomes its owner. Periods and
  // operations of before are dropped. Throws RegionError where another owner lives, where LinuxCNC's modules have
  // another version, and for a name or a file that cannot be used.
  explicit Region(const std::string& name, const std::string& folder = TRAMMEL_REGION_FOLDER);
  ~Region();
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

  trammel_region& memory() { return *memory_; }
  const std::string& path() const { return path_; }

  // Until the realtime side has woken this one since the last call, or for at most `longest` of the host's time.
  void wait(std::chrono::nanoseconds longest);
  // The oldest period that was not taken yet.
  std::optional<trammel_period> take_period();
  // Settings of the HAL component, when they differ from those of the last call; none before there are any.
  std::optional<trammel_settings> new_settings();
  // Fills in session and beat.
  void publish(const trammel_status& status);

  // Whether a process has attached as the HAL component, by its lock.
  bool has_hal() const { return locked_by_another(TRAMMEL_LOCK_HAL); }
  bool has_planner() const { return locked_by_another(TRAMMEL_LOCK_PLANNER); }

 private:
  void open_file();
  void attach();
  bool locked_by_another(int byte) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::string path_;
  int file_ = -1;
  trammel_region* memory_ = nullptr;
  std::uint64_t session_ = 0;
  std::uint64_t beat_ = 0;
  std::uint32_t woken_ = 0;
  std::uint32_t settings_seen_ = 0;
};

}  // namespace trammel::linuxcnc
