// Prints the dictionary of pieces that libFuzzer may put into a scene: every key and word of the table of
// keys, and pieces that readers of numbers and of YAML are likely to misread.
#include "sim/scene/body_file.hpp"
#include "sim/scene/keys.hpp"
#include "sim/scene/measure.hpp"

#include <iostream>
#include <iterator>
#include <set>
#include <string>

namespace scree {
namespace {

using Words = std::set<std::string>;

// Backslashes that belong to YAML are doubled.
// clang-format off
constexpr const char* misleading[] = {
    "--set ", "- ", "? ", "&a ", "*a", "<<: ", "! ", "| ", "---", "...", "[0]", "null", "glass", "ball", "region.",
    "-0.0", "1e308", "1e-308", "1e999", ".nan", ".inf", "2147483648", "9223372036854775807",
    "18446744073709551616", "0x1F", "!!str ", "!!int ", "!!float ", "!!null ", "\\\\ud83e\\\\udea8", "ITEM: TIMESTEP",
    "ITEM: NUMBER OF ATOMS", "ITEM: BOX BOUNDS pp pp pp", "ITEM: ATOMS ", "xs ys zs ", "shapex shapey shapez ",
    "Properties=", "pos:R:3", "types=", "mobility", "\\\\n", "\\\\x1b", "\\\\u2028", "\\xef\\xbb\\xbf"};
// clang-format on

void collect(const Type& type, Words& words) {
  words.insert(type.words.begin(), type.words.end());
  for (const Type& part : type.parts) collect(part, words);
  if (!type.section) return;
  for (const KeyType& key : type.section->keys) {
    words.insert(key.name + ": ");
    collect(key.type, words);
  }
}

Words pieces() {
  Words words(std::begin(misleading), std::end(misleading));
  for (const MeasureInfo& measure : measure_table()) words.emplace(measure.name);
  for (int column = 0; column < body_columns; ++column)
    words.emplace(name_of(static_cast<BodyColumn>(column)));
  collect(scene_codec().type, words);
  return words;
}

}  // namespace
}  // namespace scree

int main() {
  for (const std::string& word : scree::pieces()) std::cout << '"' << word << "\"\n";
}
