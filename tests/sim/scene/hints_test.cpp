// Tests of the table of hints against the table of keys: the keys that a hint advises must exist.
#include "sim/scene/hints.hpp"

#include "core/error.hpp"
#include "sim/scene/body_column.hpp"
#include "sim/scene/keys.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace scree {
namespace {

std::vector<std::string> words_in(std::string_view list) {
  std::vector<std::string> words(1);
  for (const char c : list) {
    if (c == ' ') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

void collect(const Type& type, std::map<std::string, std::set<std::string>>& keys) {
  if (type.section)
    for (const KeyType& key : type.section->keys) {
      keys[type.section->name].insert(key.name);
      collect(key.type, keys);
    }
  for (const Type& part : type.parts) collect(part, keys);
}

/// Returns the keys of each section, and the columns of body files.
std::map<std::string, std::set<std::string>> known_keys() {
  std::map<std::string, std::set<std::string>> keys;
  collect(scene_codec().type, keys);
  for (int k = 0; k < body_columns; ++k) keys["column"].emplace(name_of(static_cast<BodyColumn>(k)));
  return keys;
}

/// Returns the names of keys between backticks: a word before a colon, or a word alone.
std::vector<std::string> keys_in(std::string_view advice) {
  std::vector<std::string> keys;
  for (std::size_t at = advice.find('`'); at != std::string_view::npos; at = advice.find('`', at + 1)) {
    const std::size_t end = advice.find('`', at + 1);
    const std::string_view code = advice.substr(at + 1, end - at - 1);
    keys.emplace_back(code.substr(0, code.find(':')));
    at = end;
  }
  return keys;
}

TEST(Hints, AdviseWhatThereIs) {
  const auto known = known_keys();
  std::set<std::string> all;
  for (const auto& [section, keys] : known) all.insert(keys.begin(), keys.end());
  for (const Hint& hint : hint_table())
    for (const std::string& key : keys_in(hint.advice)) EXPECT_TRUE(all.contains(key)) << hint.advice;
}

TEST(Hints, AreOfSectionsThatThereAreAndOfWordsThatTheyDoNotHave) {
  const auto known = known_keys();
  std::set<std::pair<std::string, std::string>> seen;
  for (const Hint& hint : hint_table())
    for (const std::string& section : words_in(hint.sections)) {
      ASSERT_TRUE(known.contains(section)) << section;
      for (const std::string& word : words_in(hint.words)) {
        EXPECT_FALSE(known.at(section).contains(word)) << section << ": " << word;
        EXPECT_TRUE(seen.emplace(section, word).second) << section << ": " << word << " is there twice";
        EXPECT_EQ(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789"), std::string::npos) << word;
        EXPECT_EQ(advice_for(section, word), hint.advice);
      }
    }
}

TEST(Hints, KnowEverySpelling) {
  for (const char* word : {"half_size", "halfSize", "half-size", "HALF_SIZE", "HalfSize"})
    EXPECT_EQ(advice_for("bodies[].box", word), advice_for("bodies[].box", "halfsize")) << word;
  EXPECT_TRUE(advice_for("bodies[].box", "colour").empty());
  EXPECT_TRUE(advice_for("nowhere", "diameter").empty());
}

/// Returns the message for a scene in which one line is wrong.
std::string message_of(const std::string& material, const std::string& body, const std::string& top,
                       const std::vector<Override>& overrides = {}) {
  try {
    parse_scene("format: 1\ntime: {end: 1, step: 0.1" + top + "}\nmaterials: {glass: {" + material +
                    "}}\nbodies:\n  - {material: glass, " + body + "}\n",
                "test.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Hints, AreInTheMessages) {
  for (const char* word : {"mu", "static_friction", "dynamicFriction", "coefficient_of_friction"})
    EXPECT_NE(message_of(std::string(word) + ": 0.5", "sphere: {radius: 1}", "")
                  .find("unknown key; write `friction`"),
              std::string::npos)
        << word;
  for (const char* word : {"restitution_coefficient", "cor", "e", "bounciness"})
    EXPECT_NE(message_of(std::string(word) + ": 0.5", "sphere: {radius: 1}", "").find("write `restitution`"),
              std::string::npos)
        << word;
  for (const char* word : {"youngs_modulus", "YoungsModulus", "poisson_ratio", "damping", "kn"})
    EXPECT_NE(message_of(std::string(word) + ": 5", "sphere: {radius: 1}", "").find("bodies are rigid"),
              std::string::npos)
        << word;
  for (const char* word : {"quaternion", "quat"})
    EXPECT_NE(
        message_of("", "sphere: {radius: 1}, " + std::string(word) + ": [1, 0, 0, 0]", "").find("w first"),
        std::string::npos)
        << word;
  for (const char* word : {"angular_velocity", "omega"})
    EXPECT_NE(
        message_of("", "sphere: {radius: 1}, " + std::string(word) + ": [1, 0, 0]", "").find("write `spin`"),
        std::string::npos)
        << word;
  EXPECT_NE(message_of("", "sphere: {radius: 1}", ", duration: 5").find("write `end`"), std::string::npos);
  EXPECT_NE(message_of("", "cylinder: {radius: 1, height: 1}", "").find("write `length`"), std::string::npos);
  EXPECT_NE(message_of("", "sphere: {radius: 1}", "", {{"bodies[0].sphere.diameter", "2"}})
                .find("bodies[0].sphere has no diameter; write `radius`, half of it"),
            std::string::npos);
}

}  // namespace
}  // namespace scree
