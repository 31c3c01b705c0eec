// Completion offers what help tells of: both are read as a user gets them, as text.
#include "tests/sim/cli/falling_ball.hpp"

#include <regex>
#include <sstream>

namespace scree {
namespace {

using Words = std::vector<std::string>;

class CompletionTest : public ProgramTest {
 protected:
  std::string help(const Words& arguments) { return scree_in(folder_, arguments).out; }

  /// What the first group of the pattern finds, line by line.
  static Words found(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    Words words;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      for (std::sregex_iterator at(line.begin(), line.end(), expression), end; at != end; ++at)
        words.push_back((*at)[1]);
    std::ranges::sort(words);
    return words;
  }

  Words commands() {
    return found(help({"--help"}).substr(help({"--help"}).find("Subcommands:")), "^  ([a-z]+) ");
  }

  /// The words that are offered; the line of files before them in `files`.
  Words offered(Words typed, std::string* files = nullptr) {
    typed.insert(typed.begin(), "complete");
    std::istringstream lines(help(typed));
    std::string line;
    std::getline(lines, line);
    if (files != nullptr) *files = line;
    Words words;
    while (std::getline(lines, line)) words.push_back(line.substr(0, line.find('\t')));
    std::ranges::sort(words);
    return words;
  }
  std::string files(const Words& typed) {
    std::string what;
    EXPECT_EQ(offered(typed, &what), Words{});
    return what;
  }

  /// What bash would offer, by the script that is installed.
  Words bash(const std::string& line) {
    write_text(folder_ / "ask.sh",
               "PATH=" + fs::path(SCREE_PROGRAM).parent_path().string() +
                   ":$PATH\n. " SCREE_SOURCE_DIR "/packaging/scree.bash\ncd '" + folder_.path().string() +
                   "'\nCOMP_WORDS=(" + line +
                   ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_scree\n"
                   "[[ $(complete -p scree) == *_scree* ]] && printf '%s\\n' \"${COMPREPLY[@]}\" >answer\n");
    EXPECT_EQ(std::system(("bash " + (folder_ / "ask.sh").string()).c_str()), 0);
    return found(text_of(folder_ / "answer"), "^(.+)$");
  }
};

TEST_F(CompletionTest, EveryCommandOfTheHelp) {
  EXPECT_GE(commands().size(), 11U);
  EXPECT_EQ(offered({""}), commands());
  EXPECT_EQ(offered({"re"}), (Words{"render", "report"}));
  EXPECT_EQ(offered({"-"}), (Words{"--help", "--help-all", "--version", "-h"}));
}

TEST_F(CompletionTest, EveryOptionOfTheHelpOfEachCommand) {
  for (const std::string& command : commands()) {
    if (command == "bench") continue;  // its options are the benchmark's
    SCOPED_TRACE(command);
    // Names of options stand before two spaces; what comes after is prose.
    const Words told = found(help({command, "--help"}), "(?:^  |^  -[a-z], )(--?[a-z-]+)");
    EXPECT_GE(told.size(), 1U);
    Words both = offered({command, "-"});
    for (const std::string& name : told) EXPECT_EQ(std::ranges::count(both, name), 1) << name;
    std::erase_if(both, [](const std::string& name) { return name.size() == 2; });
    EXPECT_EQ(both, found(help({command, "--help"}), "^  (?:-[a-z], )?(--[a-z-]+)"));
  }
}

TEST_F(CompletionTest, ValuesByWhatTheyAre) {
  EXPECT_EQ(offered({"run", "--device", ""}), (Words{"auto", "cuda", "host"}));
  EXPECT_EQ(offered({"run", "--device=h"}), (Words{"--device=host"}));
  EXPECT_EQ(offered({"export", "DIR", "--to", ""}), (Words{"csv", "lammps", "vtp", "xyz"}));
  EXPECT_EQ(offered({"new", "p"}), (Words{"pile"}));
  EXPECT_EQ(offered({"new", "mine", "--from", "v"}), (Words{"validation"}));
  EXPECT_EQ(files({"run", ""}), "files yaml");
  EXPECT_EQ(files({"run", "--threads", "2", ""}), "files yaml");
  EXPECT_EQ(files({"run", "a.yaml", ""}), "none");
  EXPECT_EQ(files({"run", "--reproduce", ""}), "files json");
  EXPECT_EQ(files({"run", "a.yaml", "-o", ""}), "folders");
  EXPECT_EQ(files({"verify", "a.yaml", "b.yaml", ""}), "files yaml");
  EXPECT_EQ(files({"compare", "a", ""}), "folders");
  EXPECT_EQ(files({"compare", "a", "b", ""}), "none");
  EXPECT_EQ(files({"nonsense", ""}), "none");
}

TEST_F(CompletionTest, KeysOfTheSceneLanguage) {
  std::string first;
  EXPECT_EQ(offered({"run", "a.yaml", "--set", "ti"}, &first), Words{"time."});
  EXPECT_EQ(first, "keys");
  EXPECT_EQ(offered({"plan", "--set", "time."}), (Words{"time.end=", "time.step=", "time.substeps="}));
  EXPECT_EQ(offered({"plan", "--set", "bodies[0].sphere.r"}),
            (Words{"bodies[0].sphere.radius.", "bodies[0].sphere.radius="}));
  EXPECT_EQ(offered({"plan", "--set", "materials.glass.fr"}), Words{"materials.glass.friction="});
  EXPECT_EQ(offered({"plan", "--set", "regions"}), Words{"regions."});
  EXPECT_EQ(offered({"study", "--vary", "response.mode=a"}), Words{"response.mode=accurate"});
  EXPECT_EQ(offered({"study", "--vary=response.mode=a"}), Words{"--vary=response.mode=accurate"});
  for (const char* nowhere :
       {"tim.e", "gravity.x", "bodies[", "bodies[0", "[0]", ".", "=", "time.=", "crosscheck"})
    EXPECT_EQ(offered({"plan", "--set", nowhere}), Words{}) << nowhere;

  // All that the schema has, at the top and below a section.
  const Json schema = Json::parse(help({"plan", "--schema"}));
  const auto names_in = [](const Json& section) {
    Words names;
    for (const auto& [name, value] : section["properties"].items()) names.push_back(name);
    std::ranges::sort(names);
    return names;
  };
  const auto keys_after = [this](const std::string& path) {
    Words keys;
    for (const std::string& word : offered({"plan", "--set", path}))
      keys.push_back(word.substr(path.size(), word.size() - path.size() - 1));
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  };
  EXPECT_EQ(keys_after(""), names_in(schema));
  EXPECT_EQ(keys_after("response."), names_in(schema["properties"]["response"]));
}

TEST_F(CompletionTest, ItIsNoCommandForPeople) {
  EXPECT_FALSE(contains(help({"--help-all"}), "scree complete")) << "nor is it completed";
}

TEST_F(CompletionTest, InBash) {
  write_text(folder_ / "scene one.yaml", "");
  write_text(folder_ / "notes.txt", "");
  fs::create_directory(folder_ / "output");
  EXPECT_EQ(bash("scree v"), Words{"verify"});
  EXPECT_EQ(bash("scree run --dev"), Words{"--device"});
  EXPECT_EQ(bash("scree run --device = c"), Words{"cuda"}) << "as bash cuts --device=c";
  EXPECT_EQ(bash("scree run --set gra"), (Words{"gravity.", "gravity=", "gravity["}));
  EXPECT_EQ(bash("scree run --set precision = m"), Words{"mixed"});
  EXPECT_EQ(bash("scree run ''"), (Words{"output", "scene one.yaml"}));
  EXPECT_EQ(bash("scree render ''"), Words{"output"});
}

}  // namespace
}  // namespace scree
