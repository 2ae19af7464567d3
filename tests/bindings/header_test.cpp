// trammel.h in C++: it compiles, and an exception that a callback throws against the rules does not leave the library.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <type_traits>

#include "trammel.h"

namespace {

static_assert(std::is_trivially_copyable_v<trammel_command> && std::is_standard_layout_v<trammel_command>);
static_assert(TRAMMEL_OK == 0);
// 32 bits: one for each input that a card may have.
static_assert(std::is_same_v<decltype(trammel_simulated_set_inputs), trammel_result(trammel_card*, std::uint32_t)>);

template <class Thrown>
std::size_t throwing_transfer(void* context, trammel_access*, std::size_t) {
  throw *static_cast<Thrown*>(context);
}

template <class Thrown>
trammel_result open_throwing(Thrown thrown) {
  trammel_bus bus{};
  bus.context = &thrown;
  bus.transfer = throwing_transfer<Thrown>;
  trammel_card* card = nullptr;
  const trammel_result result = trammel_open_bus(&bus, &card);
  EXPECT_EQ(card, nullptr);
  return result;
}

TEST(Header, CallsFromCpp) {
  trammel_card* card = nullptr;
  ASSERT_EQ(trammel_open("sim:", &card), TRAMMEL_OK);
  trammel_identification is{};
  EXPECT_EQ(trammel_identify(card, &is), TRAMMEL_OK);
  EXPECT_EQ(is.axes, 4U);
  trammel_close(card);
}

TEST(Header, NothingIsThrown) {
  EXPECT_EQ(open_throwing(std::runtime_error("a callback of C++")), TRAMMEL_INTERNAL);
  EXPECT_STREQ(trammel_last_error()->text, "a callback of C++");
  EXPECT_EQ(open_throwing(7), TRAMMEL_INTERNAL);
  EXPECT_STREQ(trammel_last_error()->text, "an exception of an unknown type");
}

}  // namespace
