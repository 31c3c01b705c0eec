// The reader of STL files, as text or binary.
#include "sim/scene/mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>

namespace scree {
namespace {

constexpr std::size_t header = 84, record = 50;

template <class T>
T at(std::string_view bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

std::size_t binary_size(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
  return header + record * std::size_t{at<std::uint32_t>(bytes, header - 4)};
}

/// Returns whether a file is binary. A binary file has the size that its number of facets demands or, if
/// bytes are missing or extra, a zero byte: the number of facets has some, and text has none.
bool is_binary(std::string_view bytes) {
  constexpr std::size_t looked_at = 1024;
  if (bytes.size() < header) return false;
  return bytes.size() == binary_size(bytes) ||
         bytes.substr(0, looked_at).find('\0') != std::string_view::npos;
}

void read_binary(const MeshSource& source, MeshMaker& mesh) {
  const std::string_view bytes = source.rest();
  const std::size_t end = binary_size(bytes), facets = (end - header) / record;
  if (bytes.size() < end)
    source.fail(fmt::format("is cut off: it should have {} facets, and has {}", facets,
                            (bytes.size() - header) / record));
  for (std::size_t facet = 0; facet < facets; ++facet) {
    std::array<int, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto number = [&](std::size_t c) {
        return at<float>(bytes, header + record * facet + 12 * (k + 1) + 4 * c);
      };
      const Vec3 place(number(0), number(1), number(2));
      if (!place.allFinite())
        source.fail(fmt::format("triangle {} has a vertex that is no number", facet + 1));
      corners[k] = mesh.vertex(place);
    }
    mesh.triangle(corners[0], corners[1], corners[2]);
  }
  if (bytes.size() > end)
    mesh.warn(
        fmt::format("{} bytes after the last of its {} facets are skipped", bytes.size() - end, facets));
}

std::string lower(std::string_view word) {
  std::string text(word);
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Returns whether a word, in upper or lower case, is a keyword of STL.
bool is_keyword(std::string_view word) {
  static constexpr std::array known = {"solid",   "facet",    "outer",   "vertex",
                                       "endloop", "endfacet", "endsolid"};
  return std::ranges::find(known, lower(word)) != known.end();
}

bool has_more_facets(MeshSource source) {
  std::string_view line;
  while (source.next_line(line))
    if (is_keyword(Words(line).next())) return true;
  return false;
}

void read_text(MeshSource& source, MeshMaker& mesh) {
  std::vector<int> corners;
  bool any = false, within = false;
  std::int64_t facets = 0;
  std::string_view line;
  for (std::size_t left = source.rest().size(); source.next_line(line); left = source.rest().size()) {
    Words words(line);
    const std::string_view word = words.next();
    if (word.empty()) continue;
    any = true;
    const std::string kind = lower(word);
    if (!is_keyword(word)) {
      if (within || facets == 0 || has_more_facets(source))
        source.fail_in_line(fmt::format(
            "`{}` is no word of an STL file, and its size is not that of a binary one", excerpt(word)));
      mesh.warn(
          fmt::format("{} bytes after its last facet, from line {} on, are skipped", left, source.line()));
      break;
    }
    if (kind == "facet") within = true;
    if (kind == "vertex") corners.push_back(mesh.vertex(source.place(words)));
    if (kind != "endloop") continue;
    if (corners.size() != 3)
      source.fail_in_line(fmt::format("the facet has {} vertices, not three", corners.size()));
    mesh.triangle(corners[0], corners[1], corners[2]);
    corners.clear();
    within = false;
    ++facets;
  }
  if (!any) source.fail("is empty");
  if (!corners.empty() || within) source.fail("ends within a facet");
}

}  // namespace

void read_stl(MeshSource& source, MeshMaker& mesh) {
  is_binary(source.rest()) ? read_binary(source, mesh) : read_text(source, mesh);
}

}  // namespace scree
