#include "trammel/linuxcnc/refused_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace trammel::linuxcnc {
namespace {

const char* name_of_operation(std::uint32_t kind) {
  switch (kind) {
    case TRAMMEL_LINE:
      return "a line";
    case TRAMMEL_ARC:
      return "an arc";
    case TRAMMEL_PAUSE:
      return "a pause";
    case TRAMMEL_RESUME:
      return "a resume";
    case TRAMMEL_ABORT:
      return "an abort";
    case TRAMMEL_CLEAR:
      return "a clear";
    case TRAMMEL_SET_POSE:
      return "a pose";
    case TRAMMEL_SWITCH:
      return "outputs";
    default:
      return "an unknown operation";
  }
}

bool moves(std::uint32_t kind) { return kind == TRAMMEL_LINE || kind == TRAMMEL_ARC; }

class RefusedPaths final : public PathSide {
 public:
  explicit RefusedPaths(trammel_region& region) : region_(region) {}

  void serve(const std::function<bool()>& meanwhile) override {
    do {
      take_operations();
    } while (meanwhile());
  }

  void write_status(trammel_status& status) const override {
    status.operations_done = done_;
    status.refusals = refusals_;
    status.refusal = refusal_;
    if (refusals_ == 0) return;
    const std::size_t length = std::min(text_.size(), sizeof(status.text) - 1);
    std::fill(std::begin(status.text), std::end(status.text), '\0');
    std::copy_n(text_.begin(), length, std::begin(status.text));
  }

 private:
  void take_operations() {
    const std::uint64_t head = __atomic_load_n(&region_.operation_head, __ATOMIC_ACQUIRE);
    std::uint64_t tail = region_.operation_tail;
    for (; tail != head; ++tail) {
      const trammel_operation& operation = region_.operations[tail % TRAMMEL_OPERATIONS];
      ++done_;
      if (!moves(operation.kind)) continue;
      ++refusals_;
      refusal_ = operation.id;
      text_ = fmt::format("{} was refused: this program follows targets, and has no planner for paths",
                          name_of_operation(operation.kind));
    }
    __atomic_store_n(&region_.operation_tail, tail, __ATOMIC_RELEASE);
  }

  trammel_region& region_;
  std::uint64_t done_ = 0;
  std::uint64_t refusals_ = 0;
  std::int32_t refusal_ = 0;
  std::string text_;
};

}  // namespace

std::unique_ptr<PathSide> refuse_paths(trammel_region& region) { return std::make_unique<RefusedPaths>(region); }

}  // namespace trammel::linuxcnc
