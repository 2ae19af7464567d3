#include "trammel/model/halfword_queue.hpp"

#include <stdexcept>

namespace trammel::model {

HalfwordQueue::HalfwordQueue(std::size_t depth) {
  if (depth < 2 || depth > 8191) throw std::invalid_argument("HalfwordQueue: depth must be 2 .. 8191 halfwords");
  memory_.resize(depth);
  forget_all();
}

}  // namespace trammel::model
