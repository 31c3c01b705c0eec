#include "sim/scene/mesh_source.hpp"

#include "core/error.hpp"
#include "core/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace scree {

std::string_view Words::next() {
  constexpr const char* blanks = " \t";
  const std::size_t first = rest_.find_first_not_of(blanks);
  if (first == std::string_view::npos) return rest_ = {};
  const std::size_t end = std::min(rest_.find_first_of(blanks, first), rest_.size());
  const std::string_view word = rest_.substr(first, end - first);
  rest_.remove_prefix(end);
  return word;
}

MeshSource::MeshSource(const std::filesystem::path& name, std::string_view bytes)
    : name_(name), bytes_(bytes) {
  if (bytes_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  if (bytes_.starts_with("\xFF\xFE") || bytes_.starts_with("\xFE\xFF"))
    fail("is in UTF-16; save it as UTF-8 or ASCII");
}

void MeshSource::fail(std::string_view what) const {
  throw InputError(fmt::format("{}: {}", name_.string(), what));
}
void MeshSource::fail_in_line(std::string_view what) const {
  throw InputError(fmt::format("{}:{}: {}", name_.string(), line_, what));
}

bool MeshSource::next_line(std::string_view& line) { return next_line(line, line_end(rest())); }

bool MeshSource::next_line(std::string_view& line, std::string_view end) {
  if (at_ >= bytes_.size()) return false;
  line = rest().substr(0, end.empty() ? std::string_view::npos : rest().find(end));
  at_ = std::min(at_ + line.size() + end.size(), bytes_.size());
  ++line_;
  return true;
}

std::string_view line_end(std::string_view text) {
  const std::size_t end = text.find_first_of("\r\n");
  return end == std::string_view::npos ? std::string_view()
                                       : text.substr(end, text.substr(end).starts_with("\r\n") ? 2 : 1);
}

double MeshSource::number(std::string_view word) const {
  double value = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A number that is too small for a double is read as 0.
  if (error == std::errc::result_out_of_range && std::abs(value) < 1) value = 0;
  const bool whole = end == word.data() + word.size() && (error == std::errc{} || value == 0);
  if (word.empty() || !whole || !std::isfinite(value))
    fail_in_line(fmt::format("needs three finite numbers, not `{}`", excerpt(word)));
  return value;
}

Vec3 MeshSource::place(Words& words) const {
  Vec3 at;
  for (int k = 0; k < 3; ++k) at[k] = number(words.next());
  return at;
}

std::string excerpt(std::string_view word) {
  std::string text;
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return text;
}

std::size_t MeshMaker::Hash::operator()(const std::array<double, 3>& place) const {
  std::uint64_t hash = 0;
  for (const double x : place) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &x, sizeof bits);
    // The finaliser of SplitMix64 (Steele et al. 2014).
    hash += bits + 0x9E3779B97F4A7C15;
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EB;
    hash ^= hash >> 31;
  }
  return hash;
}

int MeshMaker::vertex(const Vec3& given) {
  const Vec3 at = scale_.cwiseProduct(given) + Vec3::Zero();  // -0 becomes 0
  if (!at.allFinite()) source_.fail("has a place that is beyond what numbers can hold");
  const auto [found, fresh] =
      known_.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(mesh_.vertices.size()));
  if (fresh) mesh_.vertices.push_back(at);
  return found->second;
}

void MeshMaker::triangle(int a, int b, int c) {
  const bool mirrored = (scale_.array() < 0).count() % 2 == 1;
  mesh_.triangles.push_back({a, mirrored ? c : b, mirrored ? b : c});
}

void MeshMaker::polygon(const std::vector<int>& corners) {
  if (corners.size() < 3) source_.fail_in_line("a face needs three vertices at least");
  // Cutting ears takes a time that grows as the square of the number of corners, or faster.
  constexpr std::size_t most = 10000;
  if (corners.size() > most)
    source_.fail_in_line(fmt::format("a face has {} vertices; {} at most", corners.size(), most));
  std::vector<Vec3> places;
  for (const int v : corners) places.push_back(mesh_.vertices[static_cast<std::size_t>(v)]);
  std::vector<std::array<int, 3>> parts;
  if (!cut_polygon(places, parts)) ++crossed_;
  for (const auto& [a, b, c] : parts)
    triangle(corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)],
             corners[static_cast<std::size_t>(c)]);
}

MeshFile MeshMaker::finish() {
  if (crossed_ > 0)
    warn(fmt::format("{} of its polygons cross themselves, and are taken as fans of triangles", crossed_));
  return std::move(mesh_);
}

}  // namespace scree
