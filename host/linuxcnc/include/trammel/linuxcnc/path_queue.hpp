// The owner's end of the ring of path operations. It takes operations from the shared memory at once, so that a pause
// or an abort after a thousand lines is seen, and keeps the segments until the planner asks for them. Used by one
// thread; the other end is the planner module's, in another process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

class PathQueue {
 public:
  // `region` must outlive the queue. Operations already in the ring are dropped, because they were meant for an earlier
  // owner.
  explicit PathQueue(trammel_region& region);

  // Takes the operations that have arrived, up to the first one that needs the card at rest (abort, clear, set pose).
  // Returns whether it took segments. Segments after refuse() are dropped.
  bool take();

  // The state after the last pause or resume: true after a pause.
  bool paused() const { return paused_; }
  // The next segment, or null if there is none; valid until the next call of pop() or drop().
  const trammel_operation* front() const { return segments_.empty() ? nullptr : &segments_.front(); }
  void pop() { segments_.pop_front(); }
  std::size_t size() const { return segments_.size(); }
  // The operation that needs the card at rest, after all segments of the queue.
  const std::optional<trammel_operation>& barrier() const { return barrier_; }
  // Whether the motion must stop: abort and clear end it at once; set pose waits for its end.
  bool wants_stop() const { return barrier_ && barrier_->kind != TRAMMEL_SET_POSE; }
  // Call when the barrier operation is executed. An abort or a clear also ends a pause and the effect of refuse().
  void finish_barrier();
  // Drops all segments, and also those that arrive before the next abort or clear.
  void refuse();
  void drop() { segments_.clear(); }

  // Number of operations processed since the ring began, for trammel_status.operations_done.
  std::uint64_t done() const { return taken_ - (barrier_ ? 1 : 0); }
  bool empty() const { return segments_.empty() && !barrier_; }

 private:
  void take_one(const trammel_operation& operation);

  trammel_region& region_;
  std::deque<trammel_operation> segments_;
  std::optional<trammel_operation> barrier_;
  std::uint64_t taken_ = 0;
  bool paused_ = false;
  bool refusing_ = false;
};

}  // namespace trammel::linuxcnc
