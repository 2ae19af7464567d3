// Sums of the RTL's coverage counts over all models of a process.
#include "trammel/sim/lockstep.hpp"

#if VM_COVERAGE
#include <fmt/format.h>
#include <verilated_cov.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>

namespace trammel::lockstep {

namespace {

// The file name to which a symbolic link leads: the program's name, or the process's number.
std::string linked(const char* path) { return std::filesystem::read_symlink(path).filename().string(); }

// Sums the counts, because a test may create hundreds of models: a file for each would take gigabytes with toggle
// points.
class CoverageSums {
 public:
  explicit CoverageSums(const std::string& folder)
      : path_(fmt::format("{}/{}.{}.dat", folder, linked("/proc/self/exe"), linked("/proc/self"))) {}
  CoverageSums(const CoverageSums&) = delete;
  CoverageSums& operator=(const CoverageSums&) = delete;
  // Runs at the process's end, where nothing can catch an exception. scripts/coverage reports a missing file.
  ~CoverageSums() {
    std::ofstream file(path_);
    file << "# SystemC::Coverage-3\n";
    for (const auto& [point, count] : sums_) file << point << ' ' << count << '\n';
    if (!file.flush()) fmt::print(stderr, "{}: cannot be written\n", path_);
  }

  void add(VerilatedContext& context) {
    const std::lock_guard lock(mutex_);
    const std::string part = path_ + ".part";
    context.coveragep()->write(part.c_str());
    std::ifstream file(part);
    for (std::string line; std::getline(file, line);) {
      const std::size_t count = line.rfind(' ');
      if (line.compare(0, 2, "C ") == 0) sums_[line.substr(0, count)] += std::stoull(line.substr(count));
    }
    std::remove(part.c_str());
  }

 private:
  std::string path_;
  std::mutex mutex_;
  std::map<std::string, std::uint64_t> sums_;  // by the text of a point: "C 'keys and values'"
};

}  // namespace

void count_coverage(VerilatedContext& context) {
  const char* const folder = std::getenv("TRAMMEL_RTL_COVERAGE");
  if (!folder) return;
  static CoverageSums sums(folder);
  sums.add(context);
}

}  // namespace trammel::lockstep
#else
namespace trammel::lockstep {

void count_coverage(VerilatedContext&) {}

}  // namespace trammel::lockstep
#endif
