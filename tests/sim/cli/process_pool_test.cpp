#include "sim/cli/process_pool.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <unistd.h>
#include <vector>

namespace scree::cli {
namespace {

TEST(ProcessPool, HandsResultsOverInOrderWhateverTheOrderOfTheirEnds) {
  std::vector<int> order;
  in_processes(
      5, 3,
      [](int k) {
        usleep(static_cast<useconds_t>(5 - k) * 10'000);
        return std::string(static_cast<std::size_t>(k) * 100'000, 'x');  // more than a pipe holds
      },
      [&](int k, const ProcessResult& result) {
        order.push_back(k);
        EXPECT_EQ(result.text.size(), static_cast<std::size_t>(k) * 100'000);
        EXPECT_TRUE(result.death.empty());
      });
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(ProcessPool, ADeadChildIsReportedAndTakesNothingWithIt) {
  std::vector<ProcessResult> results;
  in_processes(
      3, 2,
      [](int k) {
        if (k == 1) raise(SIGKILL);
        if (k == 2) _exit(7);
        return std::string("fine");
      },
      [&](int, const ProcessResult& result) { results.push_back(result); });
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[0].text, "fine");
  EXPECT_NE(results[1].death.find("Killed"), std::string::npos) << results[1].death;
  EXPECT_NE(results[2].death.find('7'), std::string::npos) << results[2].death;
}

TEST(ProcessPool, WithNothingToDoReturnsAtOnce) {
  in_processes(
      0, 4, [](int) { return std::string(); }, [](int, const ProcessResult&) { FAIL(); });
}

}  // namespace
}  // namespace scree::cli
