// `scree verify`, end to end.
#include "tests/sim/cli/falling_ball.hpp"

namespace scree {
namespace {

class VerifyTest : public ProgramTest {
 protected:
  Finished verify(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"verify", "scenes", "--json", "table.json"});
    return scree_in(folder_, more);
  }
  void add(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / "scenes" / name).parent_path());
    write_text(folder_ / "scenes" / name, text);
  }
  Json table() { return Json::parse(text_of(folder_ / "table.json")); }
};

TEST_F(VerifyTest, ShowsEveryCheckAndWritesNoRunFolder) {
  add("a.yaml", falling_ball(good_check));
  add("deeper/b.yaml", falling_ball("checks: [{measure: speed.max, above: 0.5, below: 2}]\n"));
  add("c.yaml", falling_ball());
  const Finished run = verify();
  EXPECT_EQ(run.status, 0) << run.out << run.error;
  EXPECT_TRUE(contains(run.out, "pass   ball.position.z at the end")) << run.out;
  EXPECT_TRUE(contains(run.out, "above 0.5, below 2")) << run.out;
  EXPECT_TRUE(contains(run.out, "c.yaml  left out: has no checks")) << run.out;
  EXPECT_TRUE(contains(run.out, "2 passed, 0 failed")) << run.out;
  EXPECT_EQ(table()["passed"], 2);
  EXPECT_NEAR(table()["scenes"][0]["checks"][0]["measured"].get<double>(), 9.95, 1e-12);
  EXPECT_FALSE(fs::exists(folder_ / "output"));
}

TEST_F(VerifyTest, TheWorstStatusWins) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball(bad_check));
  EXPECT_EQ(verify().status, 1);
  add("c.yaml", falling_ball("gravitty: 1\n"));
  EXPECT_EQ(verify().status, 2);
  const std::string bodies = "at: [0, 0, 10], ";
  std::string overflow = falling_ball(good_check);
  overflow.insert(overflow.find(bodies), "velocity: [1e200, 0, 0], ");
  add("d.yaml", overflow);
  const Finished run = verify();
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(contains(run.out, "1 passed, 3 failed")) << run.out;
}

TEST_F(VerifyTest, LongScenesAreLeftOutUnlessAsked) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball("label: long\n" + bad_check));
  const Finished usual = verify();
  EXPECT_EQ(usual.status, 0);
  EXPECT_TRUE(contains(usual.out, "scenes left out: 1")) << usual.out;
  EXPECT_EQ(verify({"--label", "long"}).status, 1);
  const Finished misspelt = verify({"--label", "lnog"});
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_EQ(misspelt.error, "scree: no scene was run: none with checks has the label lnog\n");
  EXPECT_EQ(verify({"--label", "long"}).status, 1);
  EXPECT_EQ(table()["passed"], 0);
  EXPECT_EQ(verify({"--all"}).status, 1);
  EXPECT_EQ(table()["passed"], 1);
}

/// Balls thrown to random places: their centre is 5 m high, give or take 5 / sqrt(3 * 20) m, and of 12 seeds
/// the mean a twelfth of that squared; so the interval is some 0.8 m wide.
TEST_F(VerifyTest, JudgesEnsemblesByTheirMeanAndRunsOfOneSeedNot) {
  const auto ensemble = [](const std::string& tolerance) {
    return "format: 1\nseeds: 12\ntime: {end: 0.01, step: 0.01}\nmaterials: {glass: {}}\nrender: "
           "false\nbodies:\n"
           "  - {sphere: {radius: 0.01}, scatter: {count: 20, from: [0, 0, 0], to: [10, 10, 10]}, material: "
           "glass}\n"
           "checks:\n  - {measure: centre.z, at: 0, expect: 5, tolerance: " +
           tolerance + ", confidence: 0.95}\n  - {measure: bodies.count, expect: 20, tolerance: 0}\n";
  };
  add("a.yaml", ensemble("1.5"));
  const Finished run = verify();
  EXPECT_EQ(run.status, 0) << run.out;
  EXPECT_TRUE(contains(run.out, "+-")) << run.out;
  EXPECT_TRUE(contains(run.out, "2 passed, 0 failed")) << run.out;
  add("a.yaml", ensemble("0.1"));
  EXPECT_EQ(verify().status, 1) << "so few seeds do not tell so much";
  const Finished one = scree_in(folder_, {"run", "scenes/a.yaml"});
  EXPECT_EQ(one.status, 0) << one.out;
  EXPECT_TRUE(contains(one.out, "1 passed, 0 failed, 1 needs all seeds: use scree verify")) << one.out;
}

TEST_F(VerifyTest, VariesSettingsAndCountsThemApart) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball("checks: [{measure: energy.total, below: -1e9, in_default_mode: 1e9}]\n"));
  const Finished run = verify({"--vary", "response.mode=default,accurate", "--vary", "time.substeps=1,2"});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.out, "6 passed, 2 failed")) << run.out;
  EXPECT_TRUE(contains(run.out, "response.mode=default time.substeps=2\n")) << run.out;
  ASSERT_EQ(table()["scenes"].size(), 8u);
  EXPECT_EQ(table()["scenes"][7]["settings"], "response.mode=accurate time.substeps=2");
  EXPECT_EQ(table()["scenes"][7]["status"], 1);
  EXPECT_EQ(table()["scenes"][5]["status"], 0);
  EXPECT_EQ(verify({"--vary", "time.step"}).status, 2);
}

TEST_F(VerifyTest, ATableThatCannotBeWrittenIsToldBeforeTheFirstScene) {
  add("a.yaml", falling_ball(good_check));
  const Finished run = scree_in(folder_, {"verify", "scenes", "--json", "nowhere/table.json"});
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.error, "scree: --json: nowhere: there is no such folder\n");
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(scree_in(folder_, {"verify", "scenes", "--json", "scenes"}).status, 2);
}

TEST_F(VerifyTest, NoScenesAreAnErrorNotAPass) {
  fs::create_directories(folder_ / "scenes");
  EXPECT_EQ(verify().status, 2);
  add("a.yaml", falling_ball());
  const Finished none = verify();
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.error, "scree: no scene was run: all were left out\n");
  EXPECT_EQ(scree_in(folder_, {"verify", "nowhere"}).status, 2);
}

}  // namespace
}  // namespace scree
