#include "trammel/linuxcnc/path_queue.hpp"

namespace trammel::linuxcnc {
namespace {

std::uint64_t head_of(const trammel_region& region) {
  return __atomic_load_n(&region.operation_head, __ATOMIC_ACQUIRE);
}

}  // namespace

PathQueue::PathQueue(trammel_region& region) : region_(region), taken_(head_of(region)) {
  __atomic_store_n(&region_.operation_tail, taken_, __ATOMIC_RELEASE);
}

bool PathQueue::take() {
  const std::uint64_t head = head_of(region_);
  const std::size_t before = segments_.size();
  while (taken_ != head && !barrier_) {
    take_one(region_.operations[taken_ % TRAMMEL_OPERATIONS]);
    ++taken_;
    __atomic_store_n(&region_.operation_tail, taken_, __ATOMIC_RELEASE);
  }
  return segments_.size() != before;
}

void PathQueue::take_one(const trammel_operation& operation) {
  switch (operation.kind) {
    case TRAMMEL_LINE:
    case TRAMMEL_ARC:
    case TRAMMEL_SWITCH:
      if (!refusing_) segments_.push_back(operation);
      return;
    case TRAMMEL_PAUSE:
      paused_ = true;
      return;
    case TRAMMEL_RESUME:
      paused_ = false;
      return;
    case TRAMMEL_ABORT:
    case TRAMMEL_CLEAR:
    case TRAMMEL_SET_POSE:
      barrier_ = operation;
      return;
    default:  // an operation of a later version: ignored
      return;
  }
}

void PathQueue::finish_barrier() {
  if (wants_stop()) {
    segments_.clear();
    paused_ = false;
    refusing_ = false;
  }
  barrier_.reset();
}

void PathQueue::refuse() {
  segments_.clear();
  refusing_ = true;
}

}  // namespace trammel::linuxcnc
