// The owner's end of the memory shared with LinuxCNC's realtime modules (shared_region.h). Linux only: it needs
// open-file-description locks and a futex.
//
// Thread safety: one thread. The other ends are in other processes.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

// The shared memory is not available. what() names the file and the remedy.
class RegionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Region {
 public:
  // Opens or creates the file for `name` (letters, digits, '-', '_'; at most 64) and becomes its owner. Old periods and
  // operations are dropped. Throws RegionError if another owner is alive, if LinuxCNC's modules have another version,
  // and for a name or a file that cannot be used.
  explicit Region(const std::string& name, const std::string& folder = TRAMMEL_REGION_FOLDER);
  ~Region();
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

  trammel_region& memory() { return *memory_; }
  const std::string& path() const { return path_; }

  // Waits until the realtime side has woken the owner since the last call, or for at most `longest` of the host's time.
  void wait(std::chrono::nanoseconds longest);
  // The oldest period not yet taken.
  std::optional<trammel_period> take_period();
  // Settings of the HAL component, if they differ from those of the last call; none before the component has written
  // any.
  std::optional<trammel_settings> new_settings();
  // Publishes the status, with session and beat filled in.
  void publish(const trammel_status& status);

  // Whether a process is attached as the HAL component; its lock shows it.
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
