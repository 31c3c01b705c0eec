#include "sim/record/report/report.hpp"

#include "core/error.hpp"
#include "sim/record/report/charts.hpp"
#include "sim/record/report/page.hpp"
#include "sim/record/report/plots.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace scree {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(RowsToDraw, AreAllWhereThereAreFew) {
  EXPECT_EQ(report::rows_to_draw({3, 1, 2}, 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(report::rows_to_draw({}, 3).empty());
}

TEST(RowsToDraw, HoldEverySpike) {
  report::Column values(10007, nan);
  for (std::size_t k = 100; k < values.size(); ++k) values[k] = std::sin(1e-3 * static_cast<double>(k));
  values[7777] = 50;
  values[3333] = -50;
  const std::vector<std::size_t> rows = report::rows_to_draw(values, 100);
  EXPECT_LE(rows.size(), 100u);
  EXPECT_TRUE(std::ranges::is_sorted(rows));
  EXPECT_TRUE(std::ranges::binary_search(rows, 7777u));
  EXPECT_TRUE(std::ranges::binary_search(rows, 3333u));
  // Half of the first run of rows has no number; the other half is drawn.
  EXPECT_GE(rows.front(), 100u);
}

TEST(Chapters, AreOfWhatTheSceneHas) {
  const report::Columns metrics{{"time", "energy_kinetic", "energy_potential", "energy_work",
                                 "penetration_max", "region_bin_count", "ball_position_z", "wall_position_z"},
                                {{"time", {0, 1, 2}},
                                 {"energy_kinetic", {0, 1, 2}},
                                 {"energy_potential", {7, 6, 5}},
                                 {"energy_work", {0, 0, 1e-12}},
                                 {"penetration_max", {0, 0, 0}},
                                 {"region_bin_count", {0, 3, 4}},
                                 {"ball_position_z", {1, 0.5, 0}},
                                 {"wall_position_z", {1, nan, 1}}}};
  const auto chapters = report::chapters_of(metrics, {});
  ASSERT_EQ(chapters.size(), 3u);  // no contacts, no motion, no cost
  EXPECT_EQ(chapters[0].title, "Energy");
  ASSERT_EQ(chapters[0].charts.size(), 1u);
  const auto& curves = chapters[0].charts[0].plot.curves;
  ASSERT_EQ(curves.size(), 2u);  // the work is rounding
  EXPECT_EQ(curves[1].values, (report::Column{0, -1, -2}));
  EXPECT_EQ(chapters[1].charts[0].plot.curves[0].title, "bin");
  ASSERT_EQ(chapters[2].charts.size(), 1u);
  ASSERT_EQ(chapters[2].charts[0].plot.curves.size(), 1u);
  EXPECT_EQ(chapters[2].charts[0].plot.curves[0].title, "ball");
}

TEST(Drawing, OneForEachPlotWhateverTheNames) {
  const report::Plot plain{
      .title = "a", .unit = "it's a unit", .curves = {{"it's `a` curve\\n", {1, nan, 3}}}, .time = {0, 1, 2}};
  report::Plot logarithmic = plain;
  logarithmic.is_logarithmic = true;
  logarithmic.curves.push_back({"flat", {0, 1, 1}});
  const std::vector<std::string> drawn = report::draw({plain, logarithmic});
  ASSERT_EQ(drawn.size(), 2u);
  for (const std::string& svg : drawn) {
    EXPECT_TRUE(svg.starts_with("<svg") && svg.ends_with("</svg>"));
    EXPECT_NE(svg.find("it's `a` curve\\n"), std::string::npos) << svg;
  }
}

TEST(Page, WritesOutWhatHtmlWouldTakeForItsOwn) {
  EXPECT_EQ(report::escaped("<b a=\"1\">&"), "&lt;b a=&quot;1&quot;&gt;&amp;");
  EXPECT_EQ(report::section("Empty", ""), "");
}

// RFC 4648, section 10.
TEST(Page, HasPicturesInIt) {
  const TemporaryFolder folder;
  for (const auto& [bytes, text] : {std::pair("f", "Zg=="),
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"\xff\xfe\x01", "//4B"}}) {
    write_text(folder / "a.png", bytes);
    EXPECT_NE(report::picture(folder / "a.png", "it").find(std::string("base64,") + text + "\""),
              std::string::npos);
  }
  EXPECT_THROW(report::picture(folder / "none.png", "it"), RunError);
}

class Report : public testing::Test {
 protected:
  Report() {
    write_text(folder_ / "metrics.csv",
               "time,step,energy_kinetic,penetration_max,energy_unexplained\n0,0,0,0,0\n1,5,2,0.001,1e-9\n");
    write_text(folder_ / "timing.csv",
               "time,wall,stage,seconds,calls\n0,0.5,response,0.1,1\n1,1.5,response,0.2,5\n");
    write_text(folder_ / "scene.yaml", "name: a<b\n");
  }
  void write_manifest(const std::string& status, const std::string& more = "") const {
    write_text(folder_ / "manifest.json",
               R"({"status": ")" + status + R"(",)" + more +
                   R"("scene": {"name": "a<b", "source": "a.yaml", "hash": "0f", "seed": 1},
      "program": {"version": "1", "commit": "abc", "build": "Release", "compiler": "GNU"}, "machine": {"cpu": "one", "cores": 2},
      "space": "host", "precision": "double", "model": {"friction": {"on": true, "reason": "some"}}, "steps": 1234567, "steps_total": 1234567, "time": 1,
      "state_hash": "ff", "checks": [{"check": "x at 1", "measured": 2, "expected": "1", "margin": -1, "error": 1, "verdict": "failed"}],
      "observation": {"bodies": 3}, "frames": 0, "warnings": ["the <disk> is small"], "wall_s": 1.5,
      "guards": {"sweeps": {"count": 12, "what": "substeps that used all their sweeps", "setting": "more", "effect": "the deepest overlap was 20 %", "matters": true},
                 "gjk": {"count": 34, "what": "calls", "setting": "y", "effect": "none", "matters": false}, "left": {"count": 0, "what": "bodies", "setting": "x", "effect": "", "matters": true}},
      "counters": {"sweeps": 7, "crosscheck": {}}, "stages": {"response": {"seconds": 0.3, "calls": 6}}})");
  }
  std::string page() const {
    write_report(folder_ / ".");
    return text_of(folder_ / "report.html");
  }
  TemporaryFolder folder_;
};

TEST_F(Report, SaysFirstWhatWentWrong) {
  write_manifest("failed", R"("error": "no <room>",)");
  const std::string html = page();
  const std::size_t pictures = html.find("<h2>Checks");
  for (const char* words :
       {"a&lt;b", "The run failed: no &lt;room&gt;", "Check failed: x at 1", "the &lt;disk&gt; is small",
        "substeps that used all their sweeps: 12; the deepest overlap was 20 %. To have fewer: more."})
    EXPECT_LT(html.find(words), pictures) << words;
  EXPECT_GT(html.find("<td>34</td><td>calls</td><td>none</td>"), pictures)
      << "what does not matter comes later";
  EXPECT_EQ(html.find("0 bodies"), std::string::npos);
  EXPECT_EQ(html.find("<disk>"), std::string::npos);
}

TEST_F(Report, HasEveryPartAndNothingFromElsewhere) {
  write_manifest("done");
  const std::string html = page();
  for (const char* words : {"1\u202f234\u202f567", "on the processor: one, double precision", "<h2>Energy",
                            "<h2>Contacts", "<h2>Cost", "<h2>Stages", "<h2>What was modelled",
                            "<h2>Limits that were reached", "commit abc", "name: a&lt;b", "0.001 m", "1e-09"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  for (const char* source : {"src=\"http", "href=\"http", "@import", "<script"})
    EXPECT_EQ(html.find(source), std::string::npos) << source;
}

TEST_F(Report, ChecksThatWereNotReachedAreNoFailures) {
  write_manifest("interrupted");
  std::string manifest = text_of(folder_ / "manifest.json");
  const std::string verdict = "\"verdict\": \"failed\"";
  manifest.replace(manifest.find(verdict), verdict.size(),
                   "\"verdict\": \"not reached\", \"problem\": \"the run stopped before that\"");
  write_text(folder_ / "manifest.json", manifest);
  const std::string html = page();
  EXPECT_NE(html.find("<p class=\"notice \">Check not reached: x at 1: the run stopped before that</p>"),
            std::string::npos);
  EXPECT_NE(html.find("run the same command with <code>--resume</code> to continue it"), std::string::npos);
  EXPECT_EQ(html.find("Check failed"), std::string::npos);
}

TEST_F(Report, WithoutGnuplotItHasNoPlotsAndSaysSo) {
  write_manifest("done");
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const std::string html = page();
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(html.find("the program gnuplot is not installed"), std::string::npos);
  EXPECT_EQ(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("<h2>Stages"), std::string::npos);
}

TEST_F(Report, AFolderWithoutARunIsRefused) {
  EXPECT_THROW(page(), InputError);
  write_text(folder_ / "manifest.json", "{\"status\": 5}");
  try {
    page();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).ends_with("/manifest.json: is not the manifest of a run"))
        << error.what();
  }
  write_manifest("done");
  std::filesystem::remove(folder_ / "metrics.csv");
  EXPECT_THROW(page(), InputError);
}

}  // namespace
}  // namespace scree
