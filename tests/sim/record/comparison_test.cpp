#include "sim/record/comparison.hpp"

#include "core/error.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

class CompareRuns : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "a");
    std::filesystem::create_directories(folder_ / "b");
  }
  Comparison compare(const std::string& a, const std::string& b) const {
    write_text(folder_ / "a/metrics.csv", a);
    write_text(folder_ / "b/metrics.csv", b);
    return compare_runs(folder_ / "a", folder_ / "b");
  }
  TemporaryFolder folder_;
};

TEST_F(CompareRuns, FindsTheLargestDifferenceOfEachColumnAndWhere) {
  const Comparison found = compare("time,x,y,z\n0,1,nan,5\n0.5,-4,-nan,5\n1,2,inf,5\n",
                                   "time,z,x,y\n0,5,1.5,nan\n0.5,5,-4.25,nan\n1,5,2,inf\n");
  EXPECT_EQ(found.columns, 4);
  EXPECT_EQ(found.rows, 3);
  ASSERT_EQ(found.differences.size(), 1u);
  const ColumnDifference& x = found.differences[0];
  EXPECT_EQ(x.column, "metrics.csv x");
  EXPECT_EQ(x.largest, 0.5);
  EXPECT_EQ(x.relative, 0.5 / 4.25);
  EXPECT_EQ(x.row, 1);
  EXPECT_EQ(x.key, "0");
  EXPECT_TRUE(found.is_within(0.12));
  EXPECT_FALSE(found.is_within(0.11));
}

TEST_F(CompareRuns, WhatIsNoTableIsRefused) {
  EXPECT_THROW(compare("", ""), InputError);
  EXPECT_THROW(compare("time,x,x\n0,1,2\n", "time,x,x\n0,1,3\n"), InputError)
      << "which of the two would be compared?";
  EXPECT_THROW(compare("time,x\n0\n", "time,x\n0\n"), InputError);
}

TEST_F(CompareRuns, WhatOneLacksIsNeverWithinATolerance) {
  EXPECT_FALSE(compare("time,x\n0,1\n", "time\n0\n").is_within(1e9));
  EXPECT_FALSE(compare("time\n0\n", "time,x\n0,1\n").is_within(1e9));
  EXPECT_FALSE(compare("time\n0\n1\n", "time\n0\n").is_within(1e9));
  EXPECT_FALSE(compare("time,x\n0,1\n", "time,x\n0,nan\n").is_within(1e9));
  write_text(folder_ / "a/final.csv", "shape,x\nsphere,1\n");
  EXPECT_FALSE(compare("time\n0\n", "time\n0\n").is_within(1e9));
  write_text(folder_ / "b/final.csv", "shape,x\nbox,1\n");
  EXPECT_FALSE(compare("time\n0\n", "time\n0\n").is_within(1e9)) << "text has to be the same";
  write_text(folder_ / "b/final.csv", "shape,x\nsphere,1\n");
  EXPECT_TRUE(compare("time\n0\n", "time\n0\n").is_within(0));
}

TEST_F(CompareRuns, SaysWhatOnlyOneRunHas) {
  const Comparison found = compare("time,x\n0,1\n1,1\n", "time,y\n0,1\n");
  EXPECT_EQ(found.unlike, (std::vector<std::string>{"metrics.csv x: only in the first run",
                                                    "metrics.csv y: only in the second run",
                                                    "metrics.csv: the first run has more rows than 1"}));
  EXPECT_TRUE(found.differences_are_within(0, 0));
  EXPECT_FALSE(found.is_within(0));
}

TEST_F(CompareRuns, RefusesWhatIsNoTable) {
  EXPECT_THROW(compare("time,x\n0,1\n0\n", "time,x\n0,1\n0,1\n"), InputError);
  EXPECT_THROW(compare_runs(folder_ / "a", folder_ / "nowhere"), InputError);
}

}  // namespace
}  // namespace scree
