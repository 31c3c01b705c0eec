// Tests of the accounts of wall time.
#include "core/timing.hpp"

#include "core/space.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace scree {
namespace {

class TimingTest : public ::testing::Test {
 protected:
  void SetUp() override { timing::reset(); }
  void TearDown() override { timing::reset(); }
};

TEST_F(TimingTest, AddsUpByLabelInOrderOfAppearance) {
  timing::add("b", 0.5);
  timing::add("a", 0.25);
  timing::add("b", 1.0);
  ASSERT_EQ(timing::entries().size(), 2u);
  EXPECT_EQ(timing::entries()[0].label, "b");
  EXPECT_EQ(timing::entries()[0].seconds, 1.5);
  EXPECT_EQ(timing::entries()[0].calls, 2);
  EXPECT_EQ(timing::entries()[1].label, "a");
  EXPECT_EQ(timing::seconds("a"), 0.25);
  EXPECT_EQ(timing::seconds("never ran"), 0.0);
}

// One literal has a different address in each library that contains it.
TEST_F(TimingTest, EqualTextAtTwoAddressesIsOneAccount) {
  const std::string first = "label", second = "label";
  timing::add(first.c_str(), 1);
  timing::add(second.c_str(), 1);
  ASSERT_EQ(timing::entries().size(), 1u);
  EXPECT_EQ(timing::seconds("label"), 2.0);
}

TEST_F(TimingTest, ResetForgets) {
  timing::add("a", 1);
  timing::reset();
  EXPECT_TRUE(timing::entries().empty());
  EXPECT_EQ(timing::seconds("a"), 0.0);
  timing::add("a", 2);
  EXPECT_EQ(timing::seconds("a"), 2.0);
}

TEST_F(TimingTest, CallsAreTimedOnlyWhenAskedFor) {
  { const timing::Call<Host> call("quiet"); }
  EXPECT_TRUE(timing::calls().empty());
  timing::time_calls(true);
  { const timing::Call<Host> call("timed"); }
  timing::time_calls(false);
  ASSERT_EQ(timing::calls().size(), 1u);
  EXPECT_EQ(timing::calls()[0].label, "timed");
  EXPECT_EQ(timing::calls()[0].calls, 1);
  EXPECT_TRUE(timing::entries().empty());
}

TEST_F(TimingTest, RegionTimesItsLifetime) {
  const auto start = std::chrono::steady_clock::now();
  {
    const timing::Region region("sleep");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GE(timing::seconds("sleep"), 0.020);
  EXPECT_LE(timing::seconds("sleep"), elapsed);
}

}  // namespace
}  // namespace scree
