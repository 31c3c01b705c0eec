// Classes that the readers of OBJ, STL and PLY share: lines, words and numbers of a file, and the mesh that
// the file gives.
#pragma once

#include "sim/scene/mesh_file.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace scree {

/// The words of one line, which are separated by blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  /// Returns the next word; empty at the end of the line.
  std::string_view next();

 private:
  std::string_view rest_;
};

/// The bytes of a file, and the position up to which they have been read.
class MeshSource {
 public:
  /// `name` is the name of the file in messages. A byte-order mark of UTF-8 is skipped.
  MeshSource(const std::filesystem::path& name, std::string_view bytes);

  [[noreturn]] void fail(std::string_view what) const;
  /// Throws InputError that names the last line read.
  [[noreturn]] void fail_in_line(std::string_view what) const;

  /// Returns the bytes that are not read yet.
  std::string_view rest() const { return bytes_.substr(at_); }
  void skip(std::size_t bytes) { at_ += bytes; }
  /// Reads a line, which may end with \n, \r\n or \r. Returns false at the end of the file.
  bool next_line(std::string_view& line);
  /// Reads a line of a file whose lines all end with `end`. Returns false at the end of the file.
  bool next_line(std::string_view& line, std::string_view end);
  int line() const { return line_; }

  /// Returns the number that a word of the last line read is. Throws InputError unless it is a finite number.
  double number(std::string_view word) const;
  Vec3 place(Words& words) const;

 private:
  std::filesystem::path name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// Returns the characters that end the first line of a text; empty if nothing ends it.
std::string_view line_end(std::string_view text);

/// Returns the start of a word for messages, with ? for characters that a terminal may not show.
std::string excerpt(std::string_view word);

/// Collects vertices and triangles. Vertices at equal positions are one vertex.
class MeshMaker {
 public:
  MeshMaker(const MeshSource& source, const Vec3& scale) : source_(source), scale_(scale) {}

  /// Adds a vertex, multiplied by the scale, and returns its number among the vertices.
  int vertex(const Vec3& given);
  /// Adds a triangle. If the scale mirrors, the order of its corners is reversed.
  void triangle(int a, int b, int c);
  /// Adds any polygon by its vertices, cut into triangles. Throws InputError, with the last line read, if
  /// there are too few or too many vertices.
  void polygon(const std::vector<int>& corners);
  void warn(std::string text) { mesh_.warnings.push_back(std::move(text)); }

  MeshFile finish();

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& place) const;
  };

  const MeshSource& source_;
  Vec3 scale_;
  MeshFile mesh_;
  std::unordered_map<std::array<double, 3>, int, Hash> known_;
  std::int64_t crossed_ = 0;  ///< number of polygons that cross themselves
};

void read_obj(MeshSource& source, MeshMaker& mesh);
void read_stl(MeshSource& source, MeshMaker& mesh);
void read_ply(MeshSource& source, MeshMaker& mesh);

}  // namespace scree
