#include "trammel/transport/system_calls.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace trammel::transport {
namespace {

class LinuxCalls final : public SystemCalls {
 public:
  int open(const char* path, int flags) override { return ::open(path, flags); }
  int close(int file) override { return ::close(file); }
  int ioctl(int file, unsigned long request, void* argument) override { return ::ioctl(file, request, argument); }
  ssize_t read(int file, void* bytes, std::size_t count) override { return ::read(file, bytes, count); }
  ssize_t write(int file, const void* bytes, std::size_t count) override { return ::write(file, bytes, count); }
  int poll(pollfd* file, int milliseconds) override { return ::poll(file, 1, milliseconds); }
  void* mmap(std::size_t length, int protection, int flags, int file, off_t offset) override {
    return ::mmap(nullptr, length, protection, flags, file, offset);
  }
  int munmap(void* address, std::size_t length) override { return ::munmap(address, length); }
  std::uint32_t load(const volatile std::uint32_t* word) override { return *word; }
  void store(volatile std::uint32_t* word, std::uint32_t value) override { *word = value; }
};

}  // namespace

SystemCalls& linux_calls() {
  static LinuxCalls calls;
  return calls;
}

}  // namespace trammel::transport
