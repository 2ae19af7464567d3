// Tokens that a server generates, and tokens that a user may choose.
#include <gtest/gtest.h>

#include <string>

#include "trammel/serve/card_server.hpp"

namespace trammel::serve {
namespace {

TEST(Token, IsRandomAndFitsAUrl) {
  EXPECT_NE(random_token(), random_token());
  EXPECT_TRUE(is_token(random_token()));
  EXPECT_EQ(random_token().size(), 32U);
  EXPECT_FALSE(is_token(""));
  EXPECT_FALSE(is_token("a b"));
  EXPECT_FALSE(is_token("a&b"));
  EXPECT_FALSE(is_token(std::string(65, 'a')));
}

}  // namespace
}  // namespace trammel::serve
