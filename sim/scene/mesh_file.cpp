#include "sim/scene/mesh_file.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>

namespace scree {
namespace {

namespace fs = std::filesystem;

/// Words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  /// Empty at the end of the line.
  std::string_view next() {
    constexpr const char* blanks = " \t\r";
    const std::size_t first = rest_.find_first_not_of(blanks);
    if (first == std::string_view::npos) return rest_ = {};
    const std::size_t end = std::min(rest_.find_first_of(blanks, first), rest_.size());
    const std::string_view word = rest_.substr(first, end - first);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

class MeshReader {
 public:
  MeshReader(const fs::path& file, double scale) : file_(file), scale_(scale) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code error;
    if (fs::is_directory(file, error)) fail("is a folder, not a mesh");
    if (fs::exists(file, error) && !fs::is_regular_file(file, error)) fail("is no regular file");
    if (!stream) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    text_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  TriangleMesh read() {
    std::string suffix = file_.extension().string();
    std::ranges::transform(suffix, suffix.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (suffix == ".obj")
      read_obj();
    else if (suffix == ".stl")
      is_binary() ? read_binary() : read_text();
    else
      fail("is neither .obj nor .stl");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw InputError(fmt::format("{}: {}", file_.string(), what));
  }
  [[noreturn]] void fail_in_line(std::string_view what) const {
    throw InputError(fmt::format("{}:{}: {}", file_.string(), line_, what));
  }

  template <class F>
  void for_each_line(F&& f) {
    for (std::size_t start = 0; start < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', start), text_.size());
      ++line_;
      f(std::string_view(text_).substr(start, end - start));
      start = end + 1;
    }
  }

  double number(std::string_view word) const {
    double value = 0;
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
      fail_in_line(fmt::format("needs three finite numbers, not `{}`", word.substr(0, 40)));
    return value;
  }
  Vec3 place(Words& words) const {
    Vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = number(words.next());
    return at;
  }

  /// Its number among the vertices: that of the one there already, if there is one.
  int vertex(const Vec3& given) {
    const Vec3 at = scale_ * given + Vec3::Zero();  // no -0
    if (!at.allFinite()) fail("has a place that is beyond what numbers can hold");
    const auto [found, fresh] =
        known_.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(at);
    return found->second;
  }

  /// `a/b/c` means the vertex a; negative ones count from the last.
  int corner(std::string_view word, const std::vector<int>& vertices) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const auto count = static_cast<std::int64_t>(vertices.size());
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || index == 0 ||
        index > count || index < -count)
      fail_in_line(fmt::format("`{}` is none of the {} vertices so far", word.substr(0, 40), count));
    return vertices[static_cast<std::size_t>(index > 0 ? index - 1 : count + index)];
  }

  void read_obj() {
    std::vector<int> vertices;
    for_each_line([&](std::string_view line) {
      Words words(line);
      const std::string_view kind = words.next();
      if (kind == "v") {
        vertices.push_back(vertex(place(words)));
      } else if (kind == "f") {
        std::vector<int> corners;
        for (std::string_view word = words.next(); !word.empty(); word = words.next())
          corners.push_back(corner(word, vertices));
        if (corners.size() < 3) fail_in_line("a face needs three vertices at least");
        for (std::size_t k = 1; k + 1 < corners.size(); ++k)
          mesh_.triangles.push_back({corners[0], corners[k], corners[k + 1]});
      }
    });
  }

  void read_text() {
    std::vector<int> corners;
    bool any = false;
    for_each_line([&](std::string_view line) {
      Words words(line);
      const std::string_view kind = words.next();
      static constexpr std::array known = {"solid", "facet", "outer", "endloop", "endfacet", "endsolid"};
      any = any || !kind.empty();
      if (kind == "vertex")
        corners.push_back(vertex(place(words)));
      else if (!kind.empty() && std::ranges::find(known, kind) == known.end())
        fail_in_line(fmt::format("`{}` is no word of an STL file, and its size is not that of a binary one",
                                 printable(kind)));
      if (kind != "endloop") return;
      if (corners.size() != 3)
        fail_in_line(fmt::format("the facet has {} vertices, not three", corners.size()));
      mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
      corners.clear();
    });
    if (!any) fail("is empty");
    if (!corners.empty()) fail("ends within a facet");
  }

  static std::string printable(std::string_view word) {
    std::string text;
    for (const char c : word.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
    return text;
  }

  static constexpr std::size_t header = 84, record = 50;

  template <class T>
  T at(std::size_t place) const {
    T value;
    std::memcpy(&value, text_.data() + place, sizeof value);
    return value;
  }
  bool is_binary() const {
    static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");
    return text_.size() >= header &&
           text_.size() == header + record * std::size_t{at<std::uint32_t>(header - 4)};
  }
  void read_binary() {
    for (std::size_t start = header; start < text_.size(); start += record) {
      std::array<int, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto number = [&](std::size_t c) { return at<float>(start + 12 * (k + 1) + 4 * c); };
        const Vec3 place(number(0), number(1), number(2));
        if (!place.allFinite())
          fail(fmt::format("triangle {} has a vertex that is no number", (start - header) / record + 1));
        corners[k] = vertex(place);
      }
      mesh_.triangles.push_back(corners);
    }
  }

  fs::path file_;
  double scale_;
  std::string text_;
  int line_ = 0;
  TriangleMesh mesh_;
  std::map<std::tuple<double, double, double>, int> known_;
};

}  // namespace

TriangleMesh read_mesh_file(const fs::path& file, double scale) { return MeshReader(file, scale).read(); }

SceneMesh read_scene_mesh(const fs::path& file, double scale) {
  SceneMesh scene;
  scene.mesh = read_mesh_file(file, scale);
  std::set<std::array<int, 3>> known;
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    std::array<int, 3> sorted = scene.mesh.triangles[t];
    std::ranges::sort(sorted);
    PlacedTriangle placed;
    if (place_triangle(scene.mesh, t, placed) && known.insert(sorted).second)
      scene.triangles.push_back(placed);
    else
      ++scene.mesh.left_out;
  }
  if (scene.triangles.empty())
    throw InputError(fmt::format("{}: has no triangle with an area", file.string()));
  return scene;
}

}  // namespace scree
