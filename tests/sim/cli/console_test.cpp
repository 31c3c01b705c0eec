// What a run says, where it depends on the room for it.
#include "sim/cli/console.hpp"

#include <gtest/gtest.h>

namespace scree::cli {
namespace {

TEST(Console, ProgressHasThePartsThatFit) {
  const std::vector<std::string> parts = {"t 1.2/2.5 s", "7.4 s left", "1315 contacts"};
  EXPECT_EQ(parts_within(parts, 38), "t 1.2/2.5 s, 7.4 s left, 1315 contacts");
  EXPECT_EQ(parts_within(parts, 37), "t 1.2/2.5 s, 7.4 s left");
  EXPECT_EQ(parts_within(parts, 11), "t 1.2/2.5 s");
  EXPECT_EQ(parts_within(parts, 10), "") << "no part is cut";
  EXPECT_EQ(parts_within({}, 10), "");
}

TEST(Console, DurationsHaveTheirUnits) {
  EXPECT_EQ(duration_words(7.4), "7.4 s");
  EXPECT_EQ(duration_words(62.9), "1 min 2 s");
  EXPECT_EQ(duration_words(7500), "2 h 5 min");
  EXPECT_EQ(duration_words(3600), "1 h 0 min");
}

}  // namespace
}  // namespace scree::cli
