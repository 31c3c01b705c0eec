// Tests that every method refuses more pairs than 2^32, and than there is memory for, and names their number.
// Most methods count them one by one, which takes some seconds each.
#include "core/error.hpp"
#include "tests/broadphase/boxes.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

using namespace test;

TEST(Refusal, NamesTheNumberOfPairsOfManyBodiesAtOnePoint) {
  constexpr std::int64_t n = 100000;
  constexpr std::int64_t pairs = n * (n - 1) / 2;
  if (Host::free_memory() >= pairs * sizeof(Pair)) GTEST_SKIP() << "there is memory for all pairs";
  // All bodies are in one cell: the alternative grid tests each pair once, and not in eight cells.
  const Boxes boxes(n, ball(0.5, 0.5, 0.5, 0.5));
  for (const auto& [name, settings] : every_method()) {
    if (settings.levels > 0) continue;  // bodies of one size have one level
    try {
      found<Host>(settings, boxes, all_free(boxes));
      FAIL() << name;
    } catch (const RunError& error) {
      EXPECT_NE(std::string(error.what()).find(std::to_string(pairs) + " pairs"), std::string::npos)
          << name << ": " << error.what();
    }
  }
}

}  // namespace
}  // namespace scree
