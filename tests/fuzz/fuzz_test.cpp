// Tests that small random scenes obey the laws that hold for any scene. SCREE_FUZZ_SCENES is the number of
// scenes (default: 100); --gtest_filter='*/seed_17' runs a single one. A scene that breaks a law is printed;
// it can be saved as a file and run by itself.
#include "tests/fuzz/ledger_watch.hpp"
#include "tests/fuzz/random_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace scree {
namespace {

std::uint64_t number_of_scenes() {
  const char* number = std::getenv("SCREE_FUZZ_SCENES");
  return number ? std::strtoull(number, nullptr, 10) : 100;
}

class Fuzz : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Fuzz, ObeysTheLawsOfAnyScene) {
  const RandomScene random = random_scene(GetParam());
  const Scene scene = parse_scene(random.yaml, fmt::format("seed_{}.yaml", GetParam()));
  std::string broken;
  for (const auto& [law, breach] : watch(scene, random)) {
    broken += fmt::format("  {}: first in step {}, at worst {:.3g} (step {}), allowed {:.3g}\n", law,
                          breach.first_step, breach.worst, breach.worst_step, breach.bound);
  }
  EXPECT_TRUE(broken.empty()) << "seed " << GetParam() << " breaks\n" << broken << random.yaml;
}

TEST(RandomScene, IsTheSameForTheSameSeed) {
  EXPECT_EQ(random_scene(7).yaml, random_scene(7).yaml);
  EXPECT_NE(random_scene(7).yaml, random_scene(8).yaml);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Fuzz, testing::Range(std::uint64_t{0}, number_of_scenes()),
                         [](const testing::TestParamInfo<std::uint64_t>& seed) {
                           return "seed_" + std::to_string(seed.param);
                         });

}  // namespace
}  // namespace scree
