// Tests that scalars that are the same by YAML 1.2 are the same to scree, and that a scene may be JSON.
#include "sim/scene/scalar.hpp"

#include "core/error.hpp"
#include "sim/scene/keys.hpp"
#include "sim/scene/scene.hpp"
#include "tests/sim/scene/json_of.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace scree {
namespace {

using namespace std::string_literals;

/// Returns a scene with one value of each kind left open.
std::string scene_with(const std::string& mode, const std::string& material, const std::string& step,
                       const std::string& fixed, const std::string& count, const std::string& iterations) {
  return "format: 1\ntime:\n  end: 1\n  step: " + step +
         "\nmaterials: {glass: {}}\nbodies:\n  - sphere: {radius: 1}\n    material: " + material +
         "\n    fixed: " + fixed + "\n    repeat:\n      spacing: [3, 0, 0]\n      count:\n        - " +
         count + "\n        - 1\n        - 1\nresponse:\n  mode: " + mode + "\n  iterations: " + iterations +
         "\n";
}

std::string resolved(const std::string& text) {
  try {
    return parse_scene(text, "test.yaml").resolved;
  } catch (const InputError& error) {
    return error.what();
  }
}

const std::string plain = resolved(scene_with("accurate", "glass", "0.1", "true", "16", "auto"));

// The styles are those of YAML 1.2, chapters 7 and 8, and the tags those of its core schema (10.3).
TEST(Scalars, TextIsTheSameInEveryStyle) {
  ASSERT_NE(plain.find("mode: accurate"), std::string::npos) << plain;
  const auto styles_of = [](const std::string& word) {
    return std::vector<std::string>{
        "\"" + word + "\"",
        "'" + word + "'",
        "!!str " + word,
        "! " + word,
        "!<tag:yaml.org,2002:str> " + word,
        "!!str \"" + word + "\"",
        "!!str '" + word + "'",
        ">-\n        " + word + "\n",
        "|-\n        " + word + "\n",
        "&a " + word,
        "&a \"" + word + "\"",
        "\n        " + word,
        "\"\\x" + std::string(word == "auto" || word == "accurate" ? "61" : "67") + word.substr(1) + "\"",
        "\"" + word.substr(0, 2) + "\\\n      " + word.substr(2) + "\""};
  };
  for (const std::string& style : styles_of("accurate"))
    EXPECT_EQ(resolved(scene_with(style, "glass", "0.1", "true", "16", "auto")), plain) << style;
  for (const std::string& style : styles_of("glass"))
    EXPECT_EQ(resolved(scene_with("accurate", style, "0.1", "true", "16", "auto")), plain) << style;
  for (const std::string& style : styles_of("auto"))
    EXPECT_EQ(resolved(scene_with("accurate", "glass", "0.1", "true", "16", style)), plain) << style;
}

TEST(Scalars, NumbersAndTruthAreTheSameInEveryForm) {
  for (const char* step : {"0.1", ".1", "+0.1", "1e-1", "1.E-1", "0.10", "1E-01", "10.0e-2", "!!float 0.1",
                           "!!float \"0.1\"", "!<tag:yaml.org,2002:float> .1", "00.1"})
    EXPECT_EQ(resolved(scene_with("accurate", "glass", step, "true", "16", "auto")), plain) << step;
  for (const char* count : {"0x10", "0o20", "+16", "016", "!!int 16", "!!int 0x10", "!!int '16'"})
    EXPECT_EQ(resolved(scene_with("accurate", "glass", "0.1", "true", count, "auto")), plain) << count;
  for (const char* truth : {"True", "TRUE", "on", "\"on\"", "!!bool true", "!!bool 'True'"})
    EXPECT_EQ(resolved(scene_with("accurate", "glass", "0.1", truth, "16", "auto")), plain) << truth;
  const std::string loose = resolved(scene_with("accurate", "glass", "0.1", "false", "16", "auto"));
  for (const char* truth : {"False", "FALSE", "off", "'off'", "!!bool FALSE"})
    EXPECT_EQ(resolved(scene_with("accurate", "glass", "0.1", truth, "16", "auto")), loose) << truth;
}

TEST(Scalars, ZeroHasASignWhereItIsNoWholeNumber) {
  const auto at = [](const char* x) {
    return parse_scene(
        "format: 1\ntime: {end: 1, step: 1}\nmaterials: {glass: {}}\nbodies: [{sphere: {radius: 1}, at: [" +
            std::string(x) + ", 0, 0], material: glass}]\n",
        "test.yaml");
  };
  for (const char* zero : {"-0", "0", "+0", "-00", "0.0", "+0.0"})
    EXPECT_FALSE(std::signbit(at(zero).bodies.position[0].x())) << zero;
  for (const char* zero : {"-0.0", "-0.", "-.0", "-0e5"})
    EXPECT_TRUE(std::signbit(at(zero).bodies.position[0].x())) << zero;
  const Scene negative = at("-0.0");
  EXPECT_TRUE(std::signbit(parse_scene(negative.resolved, "test.yaml").bodies.position[0].x()))
      << negative.resolved;
}

TEST(Scalars, WhatIsNotTheSameIsRefusedWithItsReason) {
  const auto of_step = [](const char* step) {
    return resolved(scene_with("accurate", "glass", step, "true", "16", "auto"));
  };
  for (const char* step : {"\"0.1\"", "'0.1'", "!!str 0.1", "! 0.1", "|-\n        0.1"})
    EXPECT_NE(of_step(step).find("which is text: take the quotes away"), std::string::npos) << of_step(step);
  for (const char* nothing : {"null", "~", "Null", "NULL", "", "!!null null", "!!null ''"})
    EXPECT_NE(of_step(nothing).find("must be a number > 0 (s), not nothing"), std::string::npos) << nothing;
  for (const char* text :
       {"\"null\"", "'~'", "!!str null", "nULL", "True", "0.1s", "1_0", "1,5", "0x", "0b1", "1:30"})
    EXPECT_NE(of_step(text).find("must be a number > 0 (s), not "), std::string::npos) << of_step(text);
  for (const char* word :
       {"\"Accurate\"", "ACCURATE", "\"accurate\\n\"", "|\n        accurate\n", "\"accurate \""})
    EXPECT_NE(resolved(scene_with(word, "glass", "0.1", "true", "16", "auto"))
                  .find("must be one of default, accurate"),
              std::string::npos)
        << word;
  for (const char* truth : {"\"true\"", "'False'", "yes", "1", "tRUE"})
    EXPECT_NE(resolved(scene_with("accurate", "glass", "0.1", truth, "16", "auto"))
                  .find("must be one of true, false, on, off"),
              std::string::npos)
        << truth;
  for (const char* wrong : {"!!int 1.5", "!!float x", "!!bool on", "!!null nothing", "!!int ''"})
    EXPECT_NE(of_step(wrong).find("the text is not what its tag"), std::string::npos) << of_step(wrong);
  for (const char* foreign : {"!step 0.1", "!!binary aGk=", "!!timestamp 2001-01-01"})
    EXPECT_NE(of_step(foreign).find("no tags but those of YAML"), std::string::npos) << of_step(foreign);
}

// The cases are those of the core schema's regular expressions (section 10.3.2).
TEST(Scalars, AreToldApartByTheCoreSchema) {
  for (const char* whole : {"0", "-0", "+12", "007", "0o17", "0xfF"})
    EXPECT_TRUE(is_whole_number(whole)) << whole;
  for (const char* none : {"", "-", "1.", "1e3", "0o8", "0xG", "-0x1", "1_000", "١"})
    EXPECT_FALSE(is_whole_number(none)) << none;
  for (const char* number :
       {"0", "1.", ".5", "-.5e+7", "1e3", "+1.E-3", ".inf", "-.Inf", "+.INF", ".nan", ".NaN", "0x1F"})
    EXPECT_TRUE(is_number(number)) << number;
  for (const char* none : {"", ".", "+", "e3", "1e", "1e+", "inf", "nan", "-.nan", "1.2.3", "1 2", ".e1"})
    EXPECT_FALSE(is_number(none)) << none;
}

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {SCREE_SOURCE_DIR "/configs", SCREE_SOURCE_DIR "/sim/cli/templates"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  return files;
}

std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Returns the JSON text with and without line breaks, indented with blanks or tabs, and with characters
/// beyond ASCII escaped.
std::vector<std::string> forms_of(const OrderedJson& json) {
  return {json.dump(), json.dump(2), json.dump(1, '\t'), json.dump(-1, ' ', true), json.dump(1, '\t', true)};
}

/// Returns what the keys of a scene say, with every default written out, without making the bodies.
std::string canonical(const std::string& text) {
  Reader reader("test", {});
  const Node root = parse_document(text);
  SceneEntry entry;
  scene_codec().read(entry, root, reader);
  reader.finish();
  return to_yaml(*scene_codec().write(entry));
}

TEST(JsonScenes, EveryShippedSceneIsTheSameScene) {
  const auto files = shipped_scenes();
  EXPECT_GT(files.size(), 100u);
  for (const std::filesystem::path& file : files) {
    const std::string text = text_in(file), expected = canonical(text);
    for (const std::string& form : forms_of(json_of(parse_document(text))))
      ASSERT_EQ(canonical(form), expected) << file << "\n" << form;
  }
}

TEST(JsonScenes, HaveTheSameBodies) {
  for (const char* name : {"01_bouncing_ball", "02_incline", "03_stack", "11_dominoes", "12_card_house"}) {
    const std::filesystem::path file = std::filesystem::path(SCREE_SOURCE_DIR "/configs") / name;
    const std::string text = text_in(file.string() + ".yaml");
    const Scene scene = parse_scene(text, file.string() + ".yaml");
    const Scene other = parse_scene(json_of(parse_document(text)).dump(), file.string() + ".json");
    EXPECT_EQ(other.resolved, scene.resolved) << file;
    EXPECT_EQ(hash_of(other.bodies), hash_of(scene.bodies)) << file;
  }
}

/// Expects no scalar that YAML 1.1 reads differently from YAML 1.2, since a scene may go through programs
/// that read either. Quotes are no part of a key in the tree, so that a quoted key is looked for in the text.
void expect_same_in_yaml_11(const Node& node, const std::string& text, const std::filesystem::path& file) {
  for (const std::string truth : {"on", "off", "yes", "no"})
    EXPECT_FALSE(node.key == truth && text.find('"' + truth + "\":") == std::string::npos) << file << truth;
  if (node.kind == Node::Kind::scalar && !node.quoted && is_number(node.text)) {
    const std::size_t exponent = node.text.find_first_of("eE");
    EXPECT_TRUE(exponent == std::string::npos ||
                (node.text.find('.') < exponent && "+-"s.find(node.text[exponent + 1]) != std::string::npos))
        << file << node.text;
  }
  for (const Node& item : node.items) expect_same_in_yaml_11(item, text, file);
}

TEST(ShippedScenes, AreTheSameToReadersOfYaml11) {
  for (const std::filesystem::path& file : shipped_scenes()) {
    const std::string text = text_in(file);
    expect_same_in_yaml_11(parse_document(text), text, file);
  }
}

TEST(JsonScenes, TakeWhatJsonWrites) {
  const auto name_of = [](const std::string& name) {
    return parse_scene("{\"format\":1,\"name\":\"" + name +
                           "\",\"time\":{\"end\":1E0,\"step\":1e-1},\"materials\":{\"glass\":{}},\"bodies\":["
                           "{\"sphere\":"
                           "{\"radius\":1},\"material\":\"glass\",\"fixed\":false}],\"model\":{\"rolling_"
                           "friction\":true}}",
                       "test.json")
        .name;
  };
  EXPECT_EQ(name_of("a\\u00e9b"), "a\u00e9b");
  EXPECT_EQ(name_of("\\ud83e\\udea8"), "\U0001FAA8") << "two escapes, one character";
  EXPECT_EQ(name_of("a\\\\ud83e"), "a\\ud83e") << "the backslash itself is escaped";
  EXPECT_EQ(name_of("\\\"quoted\\\""), "\"quoted\"");
  EXPECT_THROW(name_of("a\\/b"), InputError) << "an escaped slash is a slash, which no folder's name has";
  EXPECT_THROW(name_of("\\ud83e"), InputError) << "half a pair";
}

}  // namespace
}  // namespace scree
