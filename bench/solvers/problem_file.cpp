#include "bench/solvers/problem_file.hpp"

#include "core/error.hpp"
#include "sim/record/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>

namespace scree::bench {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view array_header = "%%MatrixMarket matrix array real general\n";
constexpr std::string_view coordinate_header = "%%MatrixMarket matrix coordinate real symmetric\n";

/// A table of numbers, stored by rows; the file format stores them by columns.
struct Table {
  std::string name;
  std::size_t columns;
  std::vector<double> values = {};

  std::size_t rows() const { return values.size() / columns; }
  double at(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
  Vec3 vector_at(std::size_t row, std::size_t column) const {
    return {at(row, column), at(row, column + 1), at(row, column + 2)};
  }
  template <class... Numbers>
  void add(Numbers... numbers) {
    (values.push_back(static_cast<double>(numbers)), ...);
  }
  void add_vector(const Vec3& v) { add(v.x(), v.y(), v.z()); }
};

void append(const Table& table, std::string& text) {
  text += array_header;
  fmt::format_to(std::back_inserter(text), "% {}\n{} {}\n", table.name, table.rows(), table.columns);
  for (std::size_t column = 0; column < table.columns; ++column) {
    for (std::size_t row = 0; row < table.rows(); ++row)
      fmt::format_to(std::back_inserter(text), "{}\n", table.at(row, column));
  }
}

/// Appends the lower triangle of a matrix.
void append(const BlockMatrix& matrix, std::string& text) {
  std::string entries;
  std::size_t count = 0;
  for (std::size_t row = 0; row < matrix.size(); ++row) {
    for (const BlockMatrix::Block* block = matrix.begin(row); block != matrix.end(row); ++block) {
      const auto column = static_cast<std::size_t>(block->column);
      if (column > row) break;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c <= (column == row ? r : 2); ++c) {
          fmt::format_to(std::back_inserter(entries), "{} {} {}\n", 3 * row + r + 1, 3 * column + c + 1,
                         block->value(static_cast<int>(r), static_cast<int>(c)));
          ++count;
        }
      }
    }
  }
  text += coordinate_header;
  fmt::format_to(std::back_inserter(text), "% W\n{} {} {}\n", 3 * matrix.size(), 3 * matrix.size(), count);
  text += entries;
}

/// Parses a file from front to back.
class Source {
 public:
  explicit Source(const fs::path& file) : name_(file.string()) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(name_ + ": cannot be opened");
    text_.assign(std::istreambuf_iterator<char>(stream), {});
    left_ = text_;
  }

  BlockMatrix matrix() {
    header(coordinate_header, "W");
    const std::size_t rows = size(std::numeric_limits<std::int32_t>::max());
    if (rows % 3 != 0 || size(rows) != rows) fail("W has not three rows and columns for each point");
    const std::size_t points = rows / 3;
    const std::size_t count = size(left_.size());
    BlockMatrix::Rows lower(points);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t r = index(rows);
      const std::size_t c = index(rows);
      auto& row = lower[r / 3];
      const auto column = static_cast<std::int32_t>(c / 3);
      const auto at = std::ranges::find(row, column, &BlockMatrix::Block::column);
      Mat3& block =
          at == row.end() ? row.emplace_back(BlockMatrix::Block{column, Mat3::Zero()}).value : at->value;
      block(static_cast<int>(r % 3), static_cast<int>(c % 3)) = number();
    }
    for (std::size_t r = 0; r < points; ++r) {
      std::ranges::sort(lower[r], {}, &BlockMatrix::Block::column);
      if (lower[r].empty() || lower[r].back().column != static_cast<std::int32_t>(r)) fail("W has a gap");
      Mat3& diagonal = lower[r].back().value;
      diagonal = Mat3(diagonal.selfadjointView<Eigen::Lower>());
    }
    return BlockMatrix(lower);
  }

  Table table(std::string name, std::size_t columns) {
    header(array_header, name);
    const std::size_t rows = size(left_.size());
    if (size(columns) != columns) fail("another number of columns of " + name);
    Table table{std::move(name), columns};
    table.values.resize(rows * columns);
    for (std::size_t column = 0; column < columns; ++column) {
      for (std::size_t row = 0; row < rows; ++row) table.values[row * columns + column] = number();
    }
    return table;
  }

  [[noreturn]] void fail(const std::string& problem) const {
    const auto read = static_cast<std::ptrdiff_t>(text_.size() - left_.size());
    const auto line = 1 + std::count(text_.begin(), text_.begin() + read, '\n');
    throw InputError(fmt::format("{}:{}: {}", name_, line, problem));
  }

 private:
  void header(std::string_view kind, const std::string& name) {
    skip_space();
    const std::string expected = fmt::format("{}% {}\n", kind, name);
    if (!left_.starts_with(expected)) fail("expected the matrix " + name);
    left_.remove_prefix(expected.size());
  }
  void skip_space() { left_.remove_prefix(std::min(left_.find_first_not_of(" \n"), left_.size())); }
  template <class Number>
  Number parse() {
    skip_space();
    Number value{};
    const auto [end, problem] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
    if (problem != std::errc()) fail("expected a number");
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return value;
  }
  double number() { return parse<double>(); }
  std::size_t size(std::size_t most) {
    const auto value = parse<std::size_t>();
    if (value > most) fail("too large a size");
    return value;
  }
  /// Returns an index that counts from 0; in the file it counts from 1.
  std::size_t index(std::size_t most) {
    const std::size_t value = size(most);
    if (value == 0) fail("expected an index");
    return value - 1;
  }

  std::string name_;
  std::string text_;
  std::string_view left_;
};

Table table_of(const PointVectors& vectors, std::string name) {
  Table table{std::move(name), 1};
  for (const Vec3& v : vectors) table.add_vector(v);
  return table;
}

Table bodies_of(const ContactProblem& scene) {
  Table table{"bodies", 13};
  for (const ContactProblem::Body& body : scene.bodies) {
    const Mat3& inertia = body.inverse_inertia;
    table.add(body.inverse_mass, inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2),
              inertia(2, 2));
    table.add_vector(body.velocity);
    table.add_vector(body.spin);
  }
  return table;
}

Table contacts_of(const ContactProblem& scene) {
  Table table{"contacts", 9};
  for (const ContactProblem::Contact& c : scene.contacts) {
    table.add(c.i, c.j, c.first_point, c.count);
    table.add_vector(c.normal);
    table.add(c.friction, c.balls);
  }
  return table;
}

Table points_of(const ContactProblem& scene) {
  Table table{"points", 10};
  for (const ContactProblem::Point& point : scene.points) {
    table.add_vector(point.arm_i);
    table.add_vector(point.arm_j);
    table.add(point.target);
    table.add_vector(point.impulse);
  }
  return table;
}

ContactProblem scene_of(const Table& bodies, const Table& contacts, const Table& points) {
  ContactProblem scene;
  for (std::size_t k = 0; k < bodies.rows(); ++k) {
    Mat3 inertia;
    inertia << bodies.at(k, 1), bodies.at(k, 2), bodies.at(k, 3), bodies.at(k, 2), bodies.at(k, 4),
        bodies.at(k, 5), bodies.at(k, 3), bodies.at(k, 5), bodies.at(k, 6);
    scene.bodies.push_back({bodies.at(k, 0), inertia, bodies.vector_at(k, 7), bodies.vector_at(k, 10)});
  }
  for (std::size_t k = 0; k < contacts.rows(); ++k) {
    scene.contacts.push_back({.i = static_cast<std::int32_t>(contacts.at(k, 0)),
                              .j = static_cast<std::int32_t>(contacts.at(k, 1)),
                              .first_point = static_cast<std::int64_t>(contacts.at(k, 2)),
                              .count = static_cast<std::int32_t>(contacts.at(k, 3)),
                              .normal = contacts.vector_at(k, 4),
                              .friction = contacts.at(k, 7),
                              .balls = contacts.at(k, 8) != 0});
  }
  for (std::size_t k = 0; k < points.rows(); ++k) {
    scene.points.push_back(
        {points.vector_at(k, 0), points.vector_at(k, 3), points.at(k, 6), points.vector_at(k, 7)});
  }
  return scene;
}

/// Returns whether the contacts refer only to bodies and points that exist.
bool is_whole(const ContactProblem& scene) {
  const auto bodies = static_cast<std::int32_t>(scene.bodies.size());
  std::int64_t next = 0;
  for (const ContactProblem::Contact& c : scene.contacts) {
    if (c.i < 0 || c.j < 0 || c.i >= bodies || c.j >= bodies || c.first_point != next || c.count < 1)
      return false;
    next += c.count;
  }
  return next == static_cast<std::int64_t>(scene.points.size());
}

}  // namespace

void write_problem(const fs::path& file, const ProblemFile& content) {
  std::string text;
  append(content.problem.delassus, text);
  append(table_of(content.problem.free_velocity, "q"), text);
  append(Table{"mu", 1, content.problem.friction}, text);
  append(bodies_of(content.scene), text);
  append(contacts_of(content.scene), text);
  append(points_of(content.scene), text);
  write_file(file, text);
}

ProblemFile read_problem(const fs::path& file) {
  Source source(file);
  ProblemFile content;
  content.problem.delassus = source.matrix();
  const std::size_t points = content.problem.delassus.size();
  const Table q = source.table("q", 1);
  content.problem.friction = source.table("mu", 1).values;
  const Table bodies = source.table("bodies", 13);
  const Table contacts = source.table("contacts", 9);
  content.scene = scene_of(bodies, contacts, source.table("points", 10));
  if (q.rows() != 3 * points || content.problem.size() != points || content.scene.points.size() != points ||
      !is_whole(content.scene))
    source.fail("the matrices are of different problems");
  for (std::size_t k = 0; k < points; ++k) {
    content.problem.free_velocity.emplace_back(q.at(3 * k, 0), q.at(3 * k + 1, 0), q.at(3 * k + 2, 0));
  }
  return content;
}

}  // namespace scree::bench
