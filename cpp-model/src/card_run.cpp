#include "trammel/model/card_model.hpp"

namespace trammel::model {

void CardModel::run(std::uint64_t clocks) {
  const Inputs none;
  for (; clocks != 0; --clocks) clock(none);
}

}  // namespace trammel::model
