#include "trammel/linuxcnc/path_bus.hpp"

#include <algorithm>

namespace trammel::linuxcnc {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kSlice = 1ms;  // a servo period of LinuxCNC's

}  // namespace

void PathBus::sleep(std::chrono::nanoseconds time) {
  do {
    const std::chrono::nanoseconds part = std::min(time, kSlice);
    bus_.sleep(part);
    time -= part;
    if (!meanwhile_ || inside_) continue;
    inside_ = true;
    try {
      meanwhile_();
    } catch (...) {
      inside_ = false;
      throw;
    }
    inside_ = false;
  } while (time > 0ns);
}

}  // namespace trammel::linuxcnc
