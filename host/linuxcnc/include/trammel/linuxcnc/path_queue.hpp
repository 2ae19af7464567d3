// The owner's end of the ring of path operations: takes them from the shared memory at once, so that a pause or an
// abort behind a thousand lines is seen, and keeps the segments until the planner asks for them. One thread; the other
// end is the planner module's, in another process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "trammel/linuxcnc/shared_region.h"

namespace trammel::linuxcnc {

class PathQueue {
 public:
  // `region` must outlive it. What stands in the ring is dropped: it was meant for an owner before this one.
  explicit PathQueue(trammel_region& region);

  // Takes what has come, up to the first operation that needs the card at rest (abort, clear, set pose). Gives back
  // whether segments came. Those that come behind refuse() are dropped.
  bool take();

  // The last pause or resume: true from a pause on.
  bool paused() const { return paused_; }
  // The next segment, none before one has come; until the next call of pop() or drop().
  const trammel_operation* front() const { return segments_.empty() ? nullptr : &segments_.front(); }
  void pop() { segments_.pop_front(); }
  std::size_t size() const { return segments_.size(); }
  // The operation that needs the card at rest, behind all segments of the queue.
  const std::optional<trammel_operation>& barrier() const { return barrier_; }
  // Abort and clear end the motion at once; set pose waits for its end.
  bool wants_stop() const { return barrier_ && barrier_->kind != TRAMMEL_SET_POSE; }
  // It is in force. An abort and a clear end a pause and refuse() too.
  void finish_barrier();
  // Segments go; what comes until an abort or a clear is dropped as well.
  void refuse();
  void drop() { segments_.clear(); }

  // Operations dealt with since the ring began, for trammel_status.operations_done.
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
