// A card whose window is mapped from a file: /dev/mem at an offset, a UIO device, a PCI device's resource. Writes are
// posted: only the card's REFUSAL register shows a refusal. One thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "trammel/driver/bus.hpp"
#include "trammel/transport/system_calls.hpp"

namespace trammel::transport {

class MemoryBus final : public driver::Bus {
 public:
  // Maps the window at `offset` of the file. `interrupt`: use the interrupt of a UIO device (/dev/uio...) that has one.
  // Throws driver::LinkError. `calls` must outlive the object.
  MemoryBus(const std::string& path, std::uint64_t offset, bool interrupt, SystemCalls& calls = linux_calls());
  ~MemoryBus() override;
  MemoryBus(const MemoryBus&) = delete;
  MemoryBus& operator=(const MemoryBus&) = delete;

  std::size_t transfer(driver::Access* accesses, std::size_t count) override;
  void sleep(std::chrono::nanoseconds time) override;
  bool reports_refusals() const override { return false; }
  bool has_interrupt() const override { return interrupt_; }
  bool wait_for_interrupt(std::chrono::nanoseconds longest) override;

 private:
  bool enable_interrupt();
  [[noreturn]] void fail(const char* what) const;

  std::string path_;
  SystemCalls& calls_;
  int file_ = -1;
  void* mapped_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  volatile std::uint32_t* window_ = nullptr;
  bool interrupt_ = false;
};

}  // namespace trammel::transport
