// The reader of Wavefront OBJ files: vertices and faces.
#include "sim/scene/mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

namespace scree {
namespace {

/// First words of lines that do not change the surface: colours, normals, groups.
constexpr std::array ignored_keywords = {"vt",       "vn",     "g",          "o",        "s",     "usemtl",
                                         "mtllib",   "usemap", "maplib",     "mg",       "bevel", "c_interp",
                                         "d_interp", "lod",    "shadow_obj", "trace_obj"};

/// Reads a line, and the lines that follow while each ends with a backslash, without comments, which begin
/// with #. Returns false at the end of the file.
bool next_statement(MeshSource& source, std::string& statement) {
  std::string_view line;
  if (!source.next_line(line)) return false;
  statement.clear();
  for (;;) {
    const bool comments = line.find('#') != std::string_view::npos;
    line = line.substr(0, line.find('#'));
    const std::size_t last = line.find_last_not_of(" \t");
    const bool goes_on = !comments && last != std::string_view::npos && line[last] == '\\';
    statement += goes_on ? line.substr(0, last) : line;
    statement += ' ';
    if (!goes_on || !source.next_line(line)) return true;
  }
}

/// Returns the vertex that a word of a face means: in `a/b/c` the vertex a. Negative numbers count back from
/// the last vertex.
int corner(std::string_view word, const std::vector<int>& vertices, const MeshSource& source) {
  const std::string_view digits = word.substr(0, word.find('/'));
  std::int64_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const auto count = static_cast<std::int64_t>(vertices.size());
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || index == 0 ||
      index > count || index < -count)
    source.fail_in_line(fmt::format("`{}` is none of the {} vertices so far", excerpt(word), count));
  return vertices[static_cast<std::size_t>(index > 0 ? index - 1 : count + index)];
}

std::string skipped_words(const std::map<std::string, std::int64_t>& skipped) {
  std::string words;
  std::int64_t sum = 0;
  for (const auto& [kind, count] : skipped) {
    words += fmt::format("{}{} of `{}`", words.empty() ? "" : ", ", count, kind);
    sum += count;
  }
  return fmt::format("{} lines are skipped, which are neither vertices nor faces: {}", sum, words);
}

}  // namespace

void read_obj(MeshSource& source, MeshMaker& mesh) {
  std::vector<int> vertices, corners;
  std::map<std::string, std::int64_t> skipped;
  constexpr std::size_t most_kinds = 8;
  std::string statement;
  while (next_statement(source, statement)) {
    Words words(statement);
    const std::string_view kind = words.next();
    if (kind == "v") {
      vertices.push_back(mesh.vertex(source.place(words)));
    } else if (kind == "f" || kind == "fo") {
      corners.clear();
      for (std::string_view word = words.next(); !word.empty(); word = words.next())
        corners.push_back(corner(word, vertices, source));
      mesh.polygon(corners);
    } else if (!kind.empty() && std::ranges::find(ignored_keywords, kind) == ignored_keywords.end()) {
      const std::string word = excerpt(kind);
      ++skipped[skipped.size() < most_kinds || skipped.contains(word) ? word : "..."];
    }
  }
  if (!skipped.empty()) mesh.warn(skipped_words(skipped));
}

}  // namespace scree
