// Tests of the rule that refuses too many pairs before memory is allocated. It is tested alone, since it
// cannot be tried at full size.
#include "broadphase/pair_list.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(RequireMemory, LetsPassWhatFits) {
  EXPECT_NO_THROW(require_memory(0, 0));
  EXPECT_NO_THROW(require_memory(10, 80));
}

TEST(RequireMemory, RefusesTheRestWithTheNumbers) {
  EXPECT_THROW(require_memory(11, 87), RunError);
  try {
    require_memory(5'000'000'000, 30'000'000'000);
    FAIL();
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("5000000000 pairs"), std::string::npos) << text;
    EXPECT_NE(text.find("40000000000 bytes"), std::string::npos) << text;
    EXPECT_NE(text.find("30000000000 bytes are free"), std::string::npos) << text;
  }
}

TEST(RequireMemory, DoesNotOverflow) {
  EXPECT_THROW(require_memory(std::int64_t{1} << 60, 1 << 20), RunError);
}

}  // namespace
}  // namespace scree
