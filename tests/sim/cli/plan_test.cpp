// What `scree plan` says of a scene, row by row: each where the scene has what it is about, and nowhere else.
#include "tests/sim/cli/falling_ball.hpp"

#include <sstream>

namespace scree {
namespace {

/// A part of a scene, and the rows that tell of it: what each begins with, and what is in it.
struct Feature {
  const char* name;
  std::string top;   ///< of the scene
  std::string body;  ///< one more item of `bodies`
  std::vector<std::pair<std::string, std::string>> rows;
};

std::string of_stone(const std::string& body) { return "  - {" + body + ", material: stone}\n"; }

const std::vector<Feature> features = {
    {"a period",
     "periodic: {y: [-4, 4]}\n",
     "",
     {{"periodic", "y: -4 m to 4 m"}, {"", "no image is missed up to"}}},
    {"a servo",
     "",
     of_stone("box: {size: 1}, at: [3, 0, 0], servo: {axis: [0, 0, 1], force: 5}"),
     {{"servos", "1 that hold a force: steps are taken on the processor"}}},
    {"a mesh",
     "",
     of_stone("mesh: {file: two.obj}, fixed: true"),
     {{"", "fixed triangles: 2"},
      {"narrow phase", "2 triangles of meshes"},
      {"mesh", "two.obj: 2 triangles (1 triangles without area"}}},
    {"a capsule",
     "",
     of_stone("capsule: {radius: 0.1, length: 1}, at: [5, 0, 0]"),
     {{"", "free capsules: 1"},
      {"narrow phase", "capsules, cylinders and polyhedra by separating axes and GJK"}}},
    {"a polyhedron",
     "",
     of_stone("polyhedron: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}, at: [7, 0, 0]"),
     {{"", "free polyhedra: 1"},
      {"narrow phase", "capsules, cylinders and polyhedra by separating axes and GJK"}}},
    {"an emitter",
     "",
     of_stone(
         "sphere: {radius: 0.1}, from: 0.02, emit: {count: 5, rate: 100, from: [0, 0, 8], to: [1, 1, 9]}"),
     {{"", "5 one after another, 100 a second, from 0.02 s to 0.06 s"}}},
    {"an emitter that is late",
     "",
     of_stone("sphere: {radius: 0.1}, emit: {count: 50, rate: 100, from: [0, 0, 6], to: [1, 1, 7]}"),
     {{"", "50 one after another, 100 a second, from 0 s past the end: the last ones never appear"}}},
    {"a swing",
     "",
     of_stone(
         "box: {size: 1}, at: [0, 0, -3], motion: {oscillate: {displacement: [0, 0, 1], frequency: 10}}"),
     {{"", "prescribed boxes: 1"}, {"motion", "10 steps to the shortest swing: few; try step <= 0.005"}}},
    {"a path",
     "",
     of_stone("sphere: {radius: 1}, motion: {keyframes: [{at: 0, position: [0, 0, -6]}, {at: 1, position: "
              "[1, 0, -6]}]}"),
     {{"", "prescribed spheres: 1"}}},
    {"a lifetime",
     "",
     of_stone("sphere: {radius: 0.1}, at: [9, 0, 0], from: 0.03, until: 0.05"),
     {{"", "1 there from 0.03 s until 0.05 s"}}},
};

class PlanTest : public ProgramTest {
 protected:
  /// Pairs of what a row begins with, and the rest of it.
  std::vector<std::pair<std::string, std::string>> rows_of(const std::string& top,
                                                           const std::string& bodies) {
    constexpr std::size_t width = 13;
    write_text(folder_ / "two.obj", "v 0 0 -2\nv 1 0 -2\nv 1 1 -2\nv 0 1 -2\nf 1 2 3\nf 1 3 4\nf 1 2 3\n");
    write_text(folder_ / "plan.yaml",
               "format: 1\ngravity: [0, 0, -10]\ntime: {end: 0.1, step: 0.01}\nmaterials: {stone: {}}\n" +
                   top + "bodies:\n  - {sphere: {radius: 0.1}, at: [0, 0, 10], material: stone}\n" + bodies);
    const Finished run = scree_in(folder_, {"plan", "plan.yaml"});
    EXPECT_EQ(run.status, 0) << run.error;
    std::vector<std::pair<std::string, std::string>> rows;
    std::istringstream lines(run.out);
    for (std::string line; std::getline(lines, line);) {
      const std::string subject = line.substr(0, width);
      rows.emplace_back(subject.substr(0, subject.find_last_not_of(' ') + 1), line.substr(width));
    }
    return rows;
  }
};

bool has(const std::vector<std::pair<std::string, std::string>>& rows, const std::string& subject,
         const std::string& words) {
  return std::ranges::any_of(
      rows, [&](const auto& row) { return row.first == subject && contains(row.second, words); });
}

TEST_F(PlanTest, EachFeatureHasItsRowsAndNoOthers) {
  for (const Feature& feature : features) {
    const auto rows = rows_of(feature.top, feature.body);
    for (const Feature& other : features) {
      for (const auto& row : other.rows) {
        const bool expected = std::ranges::count(feature.rows, row) > 0;
        EXPECT_EQ(has(rows, row.first, row.second), expected)
            << "with " << feature.name << ": " << row.first << " | " << row.second;
      }
    }
  }
}

TEST_F(PlanTest, AllTogetherHaveAllRows) {
  std::string top, bodies;
  for (const Feature& feature : features) {
    top += feature.top;
    bodies += feature.body;
  }
  const auto rows = rows_of(top, bodies);
  for (const Feature& feature : features)
    for (const auto& [subject, words] : feature.rows) EXPECT_TRUE(has(rows, subject, words)) << words;
}

TEST_F(PlanTest, ConvexShapesGoTheWayThatIsChosen) {
  const std::string capsule = of_stone("capsule: {radius: 0.1, length: 1}, at: [5, 0, 0]");
  const std::string by = "capsules, cylinders and polyhedra by ";
  for (const auto& [way, words] : std::vector<std::pair<std::string, std::string>>{
           {"auto", "separating axes and GJK"},
           {"axes", "separating axes and GJK"},
           {"ccd_gjk", "libccd's GJK and EPA where they overlap"},
           {"ccd_mpr", "libccd's MPR where they overlap"}})
    EXPECT_TRUE(has(rows_of("narrowphase: {convex: " + way + "}\n", capsule), "narrow phase", by + words));
}

TEST_F(PlanTest, ABallAloneHasNoneOfThem) {
  const auto rows = rows_of("", "");
  EXPECT_TRUE(has(rows, "bodies", "1"));
  EXPECT_TRUE(has(rows, "", "free spheres: 1"));
  for (const Feature& feature : features)
    for (const auto& [subject, words] : feature.rows) EXPECT_FALSE(has(rows, subject, words)) << words;
  for (const char* subject : {"periodic", "servos", "motion"})
    EXPECT_FALSE(has(rows, subject, "")) << subject;
}

TEST_F(PlanTest, BodiesHaveToFitWithEachSeed) {
  // With the seeds 0 to 10 they do.
  const auto scene = [](int seeds) {
    return "format: 1\nseeds: " + std::to_string(seeds) + R"(
gravity: [0, 0, -9.81]
time: {end: 0.02, step: 0.01}
materials: {stone: {density: 2000}}
bodies:
  - {sphere: {radius: {uniform: [0.09, 0.11]}}, scatter: {count: 110, from: [0, 0, 0], to: [1, 1, 1]}, material: stone}
checks:
  - {measure: centre.z, at: 0.02, above: 0, confidence: 0.95}
)";
  };
  write_text(folder_ / "eleven.yaml", scene(11));
  write_text(folder_ / "twelve.yaml", scene(12));
  for (const char* command : {"plan", "verify"}) {
    EXPECT_EQ(scree_in(folder_, {command, "eleven.yaml"}).status, 0) << command;
    const Finished run = scree_in(folder_, {command, "twelve.yaml"});
    EXPECT_EQ(run.status, 2) << command;
    EXPECT_TRUE(contains(run.out + run.error, "only 109 of 110 bodies fit without overlap")) << run.error;
    EXPECT_TRUE(contains(run.out + run.error, "(with seed 11)")) << run.error;
  }
}

TEST_F(ProgramTest, PlanSaysWhatWillBeModelledAndRunsNothing) {
  write_text(folder_ / "fall.yaml", falling_ball(good_check));
  const Finished plan = scree_in(folder_, {"plan", "fall.yaml"});
  EXPECT_EQ(plan.status, 0) << plan.error;
  EXPECT_TRUE(contains(plan.out, "free spheres: 1")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "friction         off")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "in 10 steps")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "6 rows of metrics, 4 frames of 1280 x 720")) << plan.out;
  EXPECT_FALSE(fs::exists(folder_ / "output"));
  EXPECT_TRUE(Json::accept(scree_in(folder_, {"plan", "--schema"}).out));
  EXPECT_TRUE(contains(scree_in(folder_, {"plan", "--reference"}).out, "restitution"));
  EXPECT_EQ(scree_in(folder_, {"plan"}).status, 2);
}

TEST_F(ProgramTest, PlanSaysWhatIsHardInWordsForNewcomers) {
  write_text(folder_ / "fall.yaml", falling_ball());
  Finished plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "bodies[0].velocity=[1, 0, 0]"});
  EXPECT_TRUE(contains(plan.out, "v dt / smallest size = 0.1: small enough")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "this machine has ")) << plan.out;
  plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "bodies[0].velocity=[80, 0, 0]"});
  EXPECT_TRUE(contains(plan.out, "bodies may pass through each other; try step <= 0.0012")) << plan.out;
  plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "bodies[0].velocity=[1e200, 0, 0]"});
  EXPECT_EQ(plan.status, 0) << plan.error;
  EXPECT_TRUE(contains(plan.out, "speed        too large to compute with: check velocities")) << plan.out;
  EXPECT_FALSE(contains(plan.out, "inf") || contains(plan.out, "nan")) << plan.out;
}

TEST_F(ProgramTest, PlanSaysHowFarTheSweepsGo) {
  write_text(folder_ / "fall.yaml", falling_ball());
  const auto response = [this](const std::string& settings) {
    const Finished plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "response=" + settings});
    const std::string label = "response     ";
    const std::size_t begin = plan.out.find("\n" + label) + 1 + label.size();
    return plan.out.substr(begin, plan.out.find('\n', begin) - begin);
  };
  EXPECT_EQ(
      response("{mode: default}"),
      "sweeps until the impulses change by less than 1e-10 of their size; from 2500 contact points on, by "
      "less than 0.003 (0.02 where they flow)");
  EXPECT_EQ(response("{mode: accurate, iterations: 50}"),
            "at most 50 sweeps, until the impulses change by less than 1e-10 of their size");
  EXPECT_EQ(response("{tolerance: 1.0e-4}"),
            "sweeps until the impulses change by less than 0.0001 of their size");
}

}  // namespace
}  // namespace scree
