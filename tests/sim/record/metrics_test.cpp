#include "sim/record/metrics.hpp"

#include "core/timing.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace scree {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

Scene scene_with_bodies() {
  Scene scene;
  scene.body_names = {{"alpha", 7}, {"puck", 2}, {"bed[0]", 3}, {"bed[1]", 4}};
  return scene;
}

TEST(Metrics, ColumnsAreGlobalMeasuresThenSingleBodiesInTheOrderOfTheScene) {
  const std::vector<std::string> names = metric_names(scene_with_bodies());
  for (const char* name : {"energy.total", "energy.dissipated.restitution", "momentum.x",
                           "angular_momentum.z", "penetration.relative_max", "contacts.count", "speed.rms"}) {
    EXPECT_EQ(std::ranges::count(names, name), 1) << name;
  }
  const std::vector<std::string> last(names.end() - 18, names.end());
  EXPECT_EQ(last.front(), "puck.position.x");
  EXPECT_EQ(last[8], "puck.spin.z");
  EXPECT_EQ(last[9], "alpha.position.x");
  EXPECT_TRUE(std::ranges::none_of(names, [](const std::string& name) { return name.starts_with("bed"); }));
}

TEST(Metrics, RowsReadBackToTheSameDoubles) {
  const TemporaryFolder folder;
  Observation now;
  now.time = 0.1;
  now.step = 3;
  now.kinetic_linear = 0.1 + 0.2;
  now.penetration.max = 1e-300;
  now.contacts = 12;
  const Probe probe{.observe = [&](bool) -> const Observation& { return now; },
                    .body =
                        [](std::int32_t id) {
                          BodyState body = {};
                          body.velocity = Vec3(id, 1.0 / 3, 0);
                          return body;
                        }};
  MetricsFile file(scene_with_bodies(), folder / "metrics.csv");
  file.write_row(probe);
  file.write_row(probe);
  file.commit();

  const auto lines = split(text_of(folder / "metrics.csv"), '\n');
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1], lines[2]);
  const auto header = split(lines[0], ',');
  const auto row = split(lines[1], ',');
  ASSERT_EQ(header.size(), row.size());
  std::map<std::string, std::string> cells;
  for (std::size_t k = 0; k < row.size(); ++k) cells[header[k]] = row[k];
  EXPECT_EQ(cells["time"], "0.1");
  EXPECT_EQ(cells["step"], "3");
  EXPECT_EQ(cells["energy_linear"], "0.30000000000000004");
  EXPECT_EQ(cells["penetration_max"], "1e-300");
  EXPECT_EQ(cells["contacts_count"], "12");
  EXPECT_EQ(cells["puck_velocity_x"], "2");
  EXPECT_EQ(std::strtod(cells["alpha_velocity_y"].c_str(), nullptr), 1.0 / 3);
}

TEST(Timing, RowsHoldWhatEachStageTookSinceTheRowBefore) {
  const TemporaryFolder folder;
  timing::reset();
  timing::add("narrowphase", 0.25);
  timing::add("narrowphase", 0.25);
  TimingFile file(folder / "timing.csv");
  file.write_rows(0.5);
  timing::add("response", 0.125);
  file.write_rows(1);
  file.commit();
  timing::reset();

  const auto lines = split(text_of(folder / "timing.csv"), '\n');
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "time,wall,stage,seconds,calls");
  const auto first = split(lines[1], ','), second = split(lines[2], ',');
  EXPECT_EQ(first[0], "0.5");
  EXPECT_EQ(first[2], "narrowphase");
  EXPECT_EQ(first[3], "0.500000000");
  EXPECT_EQ(first[4], "2");
  EXPECT_EQ(second[2], "response") << "stages that did not run have no row";
}

}  // namespace
}  // namespace scree
