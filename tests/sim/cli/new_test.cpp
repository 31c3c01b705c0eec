// Scenes to start from: each template is written, planned and run as a newcomer would, and its own checks
// judge it.
#include "sim/cli/templates.hpp"
#include "tests/sim/cli/falling_ball.hpp"

namespace scree {
namespace {

class NewTest : public ProgramTest {};

TEST_F(NewTest, EachTemplateIsCommentedAndRuns) {
  ASSERT_GE(cli::templates().size(), 5U);
  for (const cli::Template& scene : cli::templates()) {
    const std::string name(scene.name), file = name + ".yaml";
    SCOPED_TRACE(name);
    EXPECT_TRUE(scene.text.starts_with("# "));
    EXPECT_GE(std::ranges::count(scene.text, '#'), 8) << "it is for those who have not seen a scene";
    ASSERT_EQ(scree_in(folder_, {"new", name}).status, 0);
    EXPECT_EQ(text_of(folder_ / file), scene.text);
    EXPECT_EQ(scree_in(folder_, {"plan", file}).status, 0);
    EXPECT_EQ(scene.text, text_of(SCREE_SOURCE_DIR "/sim/cli/templates/" + file));
    // Not to the end, where its checks are: those are the test `templates`.
    const Finished run = scree_in(folder_, {"run", file, "--no-render", "--until", "0.02"});
    EXPECT_LE(run.status, 1) << run.error;
    const Json manifest = manifest_in(folder_ / ("output/" + name));
    EXPECT_GE(manifest["checks"].size(), 2U);
    EXPECT_GE(manifest["steps"], 5);
  }
}

TEST_F(NewTest, PicturesOfATemplateAreDrawn) {
  ASSERT_EQ(scree_in(folder_, {"new", "my_first", "--from", "minimal"}).status, 0);
  const Finished run =
      scree_in(folder_, {"run", "my_first.yaml", "--until", "0.1", "--set", "render.size=[64, 48]"});
  EXPECT_TRUE(run.status == 0 || run.status == 1) << run.error;  // checks of later times cannot be made
  const auto files = files_below(folder_ / "output/my_first");
  if (manifest_in(folder_ / "output/my_first")["warnings"].empty()) {
    EXPECT_EQ(std::ranges::count(files, "frames/00000.png"), 1);
  }
}

TEST_F(NewTest, ANameWithASpaceIsQuotedForTheShell) {
  const Finished spaced = scree_in(folder_, {"new", "my scene", "--from", "minimal"});
  EXPECT_TRUE(spaced.out.ends_with("\nNext: scree plan 'my scene.yaml', scree run 'my scene.yaml'\n"))
      << spaced.out;
  const Finished quoted = scree_in(folder_, {"new", "it's", "--from", "minimal"});
  EXPECT_TRUE(contains(quoted.out, "Next: scree plan 'it'\\''s.yaml', ")) << quoted.out;
  const Finished plain = scree_in(folder_, {"new", "plain", "--from", "minimal"});
  EXPECT_TRUE(contains(plain.out, "Next: scree plan plain.yaml, ")) << plain.out;
}

TEST_F(NewTest, ListsTheTemplatesWithWhatTheyAre) {
  const Finished list = scree_in(folder_, {"new"});
  EXPECT_EQ(list.status, 0);
  for (const cli::Template& scene : cli::templates()) {
    const std::string first_line(scene.text.substr(2, scene.text.find('\n') - 2));
    EXPECT_TRUE(contains(list.out, "  " + std::string(scene.name) + " ")) << list.out;
    EXPECT_TRUE(contains(list.out, first_line)) << list.out;
  }
  EXPECT_TRUE(files_below(folder_.path() / "").size() == 2) << "its streams alone";
}

TEST_F(NewTest, WhatIsThereStays) {
  write_text(folder_ / "pile.yaml", "mine\n");
  const Finished refused = scree_in(folder_, {"new", "pile"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.error, "scree: pile.yaml: is there already; nothing was written\n");
  EXPECT_EQ(text_of(folder_ / "pile.yaml"), "mine\n");
  fs::create_symlink("/nowhere/scree", folder_ / "drum.yaml");
  EXPECT_EQ(scree_in(folder_, {"new", "drum"}).status, 2) << "a link to nothing is there, too";
}

TEST_F(NewTest, WhatIsNotThereIsNamedWithTheNearest) {
  const Finished wrong = scree_in(folder_, {"new", "hoper"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.error,
            "scree: there is no template hoper (did you mean hopper?); --from takes one of drum, hopper, "
            "minimal, pile, validation\n");
  EXPECT_EQ(scree_in(folder_, {"new", "mine", "--from", "hoper"}).error, wrong.error);
  EXPECT_EQ(scree_in(folder_, {"new", "nowhere/mine", "--from", "pile"}).error,
            "scree: nowhere: there is no such folder\n");
  for (const char* name : {"", ".yaml", "..", "."})
    EXPECT_EQ(scree_in(folder_, {"new", name, "--from", "pile"}).status, std::string(name).empty() ? 0 : 2)
        << name;
  EXPECT_EQ(files_below(folder_.path()), (std::vector<std::string>{".error", ".out"}));
}

}  // namespace
}  // namespace scree
