// The system calls that the transports make on devices, one function per call, so that a test can replace them.
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>

namespace trammel::transport {

// Each function behaves as the call of its name: a failure returns -1 (mmap: MAP_FAILED) and sets errno.
class SystemCalls {
 public:
  virtual ~SystemCalls() = default;

  virtual int open(const char* path, int flags) = 0;
  virtual int close(int file) = 0;
  virtual int ioctl(int file, unsigned long request, void* argument) = 0;
  virtual ssize_t read(int file, void* bytes, std::size_t count) = 0;
  virtual ssize_t write(int file, const void* bytes, std::size_t count) = 0;
  virtual int poll(pollfd* file, int milliseconds) = 0;  // polls one file
  virtual void* mmap(std::size_t length, int protection, int flags, int file, off_t offset) = 0;
  virtual int munmap(void* address, std::size_t length) = 0;

  // A 32-bit access to mapped memory.
  virtual std::uint32_t load(const volatile std::uint32_t* word) = 0;
  virtual void store(volatile std::uint32_t* word, std::uint32_t value) = 0;

 protected:
  SystemCalls() = default;
  SystemCalls(const SystemCalls&) = default;
  SystemCalls& operator=(const SystemCalls&) = default;
};

// The calls of Linux.
SystemCalls& linux_calls();

}  // namespace trammel::transport
