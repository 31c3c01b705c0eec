// What the readers of OBJ, STL and PLY share: lines, words and numbers of a file, and the mesh that it gives.
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

/// Words of one line, between blanks.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  /// Empty at the end of the line.
  std::string_view next();

 private:
  std::string_view rest_;
};

/// The bytes of a file, and how far they are read.
class MeshSource {
 public:
  /// `name` stands for the file in messages. A byte-order mark of UTF-8 is skipped.
  MeshSource(const std::filesystem::path& name, std::string_view bytes);

  [[noreturn]] void fail(std::string_view what) const;
  /// Names the line that was taken last.
  [[noreturn]] void fail_in_line(std::string_view what) const;

  /// The bytes that are left.
  std::string_view rest() const { return bytes_.substr(at_); }
  void skip(std::size_t bytes) { at_ += bytes; }
  /// Takes a line, whatever ends it: \n, \r\n or \r. False at the end.
  bool next_line(std::string_view& line);
  /// The same where lines end with `end` alone.
  bool next_line(std::string_view& line, std::string_view end);
  int line() const { return line_; }

  /// Of the line taken last; throws unless the word is a finite number.
  double number(std::string_view word) const;
  Vec3 place(Words& words) const;

 private:
  std::filesystem::path name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// What ends the first line of a text; empty if nothing does.
std::string_view line_end(std::string_view text);

/// The start of a word, for messages: without what a terminal would not show.
std::string excerpt(std::string_view word);

/// Collects vertices, of which those of equal place are one, and triangles.
class MeshMaker {
 public:
  MeshMaker(const MeshSource& source, const Vec3& scale) : source_(source), scale_(scale) {}

  /// Its number among the vertices.
  int vertex(const Vec3& given);
  /// Turned round where the scale mirrors.
  void triangle(int a, int b, int c);
  /// Any polygon, by its vertices. Throws, in the line taken last, if there are too many.
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
  std::int64_t crossed_ = 0;  ///< polygons that cross themselves
};

void read_obj(MeshSource& source, MeshMaker& mesh);
void read_stl(MeshSource& source, MeshMaker& mesh);
void read_ply(MeshSource& source, MeshMaker& mesh);

}  // namespace scree
