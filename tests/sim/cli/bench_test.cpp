// `scree bench`, end to end: which benchmarks it finds, and what it hands on.
#include "tests/sim/cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree {
namespace {

class BenchTest : public ::testing::Test {
 protected:
  Finished bench(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "bench");
    return scree_in(folder_, arguments);
  }
  TemporaryFolder folder_;
};

TEST_F(BenchTest, ListsWhatThereIs) {
  for (const auto& arguments : {std::vector<std::string>{}, {"--help"}}) {
    const Finished list = bench(arguments);
    EXPECT_EQ(list.status, 0) << list.error;
    EXPECT_NE(list.out.find("\n  broadphase "), std::string::npos) << list.out;
  }
}

TEST_F(BenchTest, UnknownNamesAreRefusedWithTheNearestOne) {
  const Finished run = bench({"brodphase", "--n", "10"});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.error.find("brodphase (did you mean broadphase?)"), std::string::npos) << run.error;
}

TEST_F(BenchTest, HandsOnArgumentsAndStatus) {
  const Finished run = bench({"broadphase", "point", "--n", "100", "--check", "brute_force", "--repeats", "1",
                              "--copy", "1", "--csv", "rows.csv"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_NE(run.out.find("agrees with brute_force"), std::string::npos) << run.out;
  const std::string rows = text_of(folder_ / "rows.csv");
  EXPECT_EQ(std::ranges::count(rows, '\n'), 2) << rows;
  EXPECT_NE(rows.find("\npoint,100,random,hierarchical_grid,host,0,1,4950,"), std::string::npos) << rows;
}

TEST_F(BenchTest, HelpIsTheBenchmarksOwn) {
  const Finished help = bench({"broadphase", "--help"});
  EXPECT_EQ(help.status, 0) << help.error;
  EXPECT_NE(help.out.find("--check METHOD"), std::string::npos) << help.out;
}

TEST_F(BenchTest, BadArgumentsAreTheBenchmarksToRefuse) {
  for (const auto& [arguments, words] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"D"}, "data set D"},
           {{"A", "--n", "1e6"}, "--n 1e6: must be a whole number"},
           {{"A", "--method", "magic"}, "--method magic: must be one of"},
           {{"A", "--order", "random,rows"}, "--order random,rows: must be one of"},
           {{"A", "--space", "moon"}, "--space moon: must be one of"},
           {{"A", "--nonsense", "1"}, "--nonsense: not an option"},
           {{"A", "--n"}, "--n: not an option, or without a value"},
           {{"A", "--csv", "no/such/folder.csv"}, "cannot be written"},
           {{"lost.yaml"}, "lost.yaml"}}) {
    std::vector<std::string> all = {"broadphase"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Finished run = bench(all);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_NE(run.error.find(words), std::string::npos) << run.error;
  }
}

}  // namespace
}  // namespace scree
