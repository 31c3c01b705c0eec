#include "sim/scene/variations.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(Variations, ValuesAreSplitAtCommasOutsideBrackets) {
  const Variation plain = parse_variation("time.step=0.01, 0.02,1e-3");
  EXPECT_EQ(plain.key, "time.step");
  EXPECT_EQ(plain.values, (std::vector<std::string>{"0.01", "0.02", "1e-3"}));
  EXPECT_EQ(parse_variation("gravity=[[0, 0, -9.81], [0, 0, -1.62]]").values,
            (std::vector<std::string>{"[0, 0, -9.81]", "[0, 0, -1.62]"}));
  EXPECT_EQ(parse_variation("response=[{mode: default}, {mode: accurate, tolerance: 1e-9}]").values.size(),
            2u);
  EXPECT_EQ(parse_variation("seed=3").values, std::vector<std::string>{"3"});
}

TEST(Variations, WhatIsNoneIsRefused) {
  for (const char* text : {"time.step", "=1,2", "seed=", "seed=1,,2", "seed=1,", "seed=[]"})
    EXPECT_THROW(parse_variation(text), InputError) << text;
}

TEST(Variations, AreCombinedTheLastFastest) {
  const auto all = combinations({{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}});
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(describe(all[0]), "a=1 b=x");
  EXPECT_EQ(describe(all[1]), "a=1 b=y");
  EXPECT_EQ(describe(all[5]), "a=2 b=z");
  ASSERT_EQ(combinations({}).size(), 1u);
  EXPECT_EQ(describe(combinations({})[0]), "");
}

}  // namespace
}  // namespace scree
