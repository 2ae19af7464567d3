#include "trammel/model/halfword_queue.hpp"

#include <stdexcept>

namespace trammel::model {

HalfwordQueue::HalfwordQueue(std::size_t depth) {
  if (depth < 2 || depth > 32768) throw std::invalid_argument("HalfwordQueue: depth must be 2 .. 32768 halfwords");
  state_.memory.resize(depth);
  forget_all();
}

}  // namespace trammel::model
