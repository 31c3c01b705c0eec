// The line under a table of checks.
#include "sim/cli/check_table.hpp"

#include <gtest/gtest.h>

namespace scree::cli {
namespace {

CheckResult with(Verdict verdict) {
  CheckResult result;
  result.verdict = verdict;
  return result;
}

TEST(CheckTable, CountsTheVerdicts) {
  EXPECT_EQ(check_counts({with(Verdict::passed), with(Verdict::failed), with(Verdict::not_evaluated)}),
            "1 passed, 2 failed");
  EXPECT_EQ(check_counts({with(Verdict::not_reached), with(Verdict::of_seeds)}),
            "0 passed, 0 failed, 1 not reached, 1 needs all seeds: use scree verify");
  EXPECT_EQ(check_counts({with(Verdict::of_seeds), with(Verdict::of_seeds)}),
            "0 passed, 0 failed, 2 need all seeds: use scree verify");
}

TEST(CheckTable, ACheckThatWasNotReachedIsNoError) {
  CheckResult result = with(Verdict::not_reached);
  result.check = "speed.max at 7";
  result.problem = "the run stopped before that";
  const std::string line = check_lines({result}).at(0);
  EXPECT_TRUE(line.starts_with("  -      speed.max at 7 ")) << line;
  EXPECT_TRUE(line.ends_with("  the run stopped before that")) << line;
}

}  // namespace
}  // namespace scree::cli
