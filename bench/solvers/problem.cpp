#include "bench/solvers/problem.hpp"

#include <algorithm>

namespace scree::bench {

namespace {

Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A contact point as seen from one of its bodies: its arm, its frame, and its sign.
struct Grip {
  std::int32_t point;
  double sign;  // sign of this body's velocity in the point's relative velocity
  Mat3 frame;
  Vec3 arm;
};

/// Returns the matrix from an impulse at one grip to the change of the relative velocity at another grip of
/// the same body.
Mat3 coupling(const ContactProblem::Body& body, const Grip& to, const Grip& from) {
  const Mat3 change = body.inverse_mass * Mat3::Identity() -
                      cross_matrix(to.arm) * body.inverse_inertia * cross_matrix(from.arm);
  return to.sign * from.sign * to.frame.transpose() * change * from.frame;
}

/// Returns the grips of each body, ordered by point. Bodies that are not free have none.
std::vector<std::vector<Grip>> grips_of(const ContactProblem& scene) {
  std::vector<std::vector<Grip>> grips(scene.bodies.size());
  const auto add = [&](std::int32_t body, std::int64_t point, double sign, const Mat3& frame,
                       const Vec3& arm) {
    const auto b = static_cast<std::size_t>(body);
    if (scene.bodies[b].inverse_mass > 0)
      grips[b].push_back({static_cast<std::int32_t>(point), sign, frame, arm});
  };
  for (const ContactProblem::Contact& c : scene.contacts) {
    const Mat3 frame = frame_of(c);
    for (std::int64_t p = c.first_point; p < c.first_point + c.count; ++p) {
      const ContactProblem::Point& point = scene.points[static_cast<std::size_t>(p)];
      add(c.i, p, -1, frame, point.arm_i);
      add(c.j, p, 1, frame, point.arm_j);
    }
  }
  return grips;
}

/// Adds a block to a row whose blocks are not sorted yet.
void add_block(std::vector<BlockMatrix::Block>& row, std::int32_t column, const Mat3& value) {
  const auto at = std::ranges::find(row, column, &BlockMatrix::Block::column);
  if (at == row.end()) {
    row.push_back({column, value});
  } else {
    at->value += value;
  }
}

BlockMatrix delassus_of(const ContactProblem& scene) {
  BlockMatrix::Rows lower(scene.points.size());
  const std::vector<std::vector<Grip>> grips = grips_of(scene);
  for (std::size_t b = 0; b < grips.size(); ++b) {
    for (const Grip& to : grips[b]) {
      for (const Grip& from : grips[b]) {
        if (from.point > to.point) break;
        Mat3 block = coupling(scene.bodies[b], to, from);
        if (from.point == to.point) block = (0.5 * (block + block.transpose())).eval();
        add_block(lower[static_cast<std::size_t>(to.point)], from.point, block);
      }
    }
  }
  for (auto& row : lower) std::ranges::sort(row, {}, &BlockMatrix::Block::column);
  return BlockMatrix(lower);
}

}  // namespace

BlockMatrix::BlockMatrix(const Rows& lower) {
  begin_.assign(lower.size() + 1, 0);
  for (std::size_t row = 0; row < lower.size(); ++row) {
    for (const Block& block : lower[row]) {
      const auto column = static_cast<std::size_t>(block.column);
      ++begin_[row + 1];
      if (column != row) ++begin_[column + 1];
    }
    diagonal_.push_back(lower[row].back().value);
  }
  for (std::size_t row = 0; row < lower.size(); ++row) begin_[row + 1] += begin_[row];
  blocks_.resize(begin_.back());
  // The rows are visited in order. So the columns of each row ascend: first the row's own blocks, then the
  // transposed blocks of later rows.
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t row = 0; row < lower.size(); ++row) {
    for (const Block& block : lower[row]) {
      const auto column = static_cast<std::size_t>(block.column);
      blocks_[next[row]++] = block;
      if (column != row) blocks_[next[column]++] = {static_cast<std::int32_t>(row), block.value.transpose()};
    }
  }
}

Mat3 frame_of(const ContactProblem::Contact& contact) {
  Mat3 frame;
  frame.col(0) = contact.normal;
  frame.col(1) = tangent_of(contact.normal);
  frame.col(2) = contact.normal.cross(frame.col(1));
  return frame;
}

Problem assemble(const ContactProblem& scene) {
  Problem problem{delassus_of(scene), PointVectors(scene.points.size()),
                  std::vector<double>(scene.points.size())};
  for (const ContactProblem::Contact& c : scene.contacts) {
    const ContactProblem::Body& i = scene.bodies[static_cast<std::size_t>(c.i)];
    const ContactProblem::Body& j = scene.bodies[static_cast<std::size_t>(c.j)];
    const Mat3 frame = frame_of(c);
    for (std::int64_t p = c.first_point; p < c.first_point + c.count; ++p) {
      const auto k = static_cast<std::size_t>(p);
      const ContactProblem::Point& point = scene.points[k];
      const Vec3 velocity = j.velocity + j.spin.cross(point.arm_j) - (i.velocity + i.spin.cross(point.arm_i));
      problem.free_velocity[k] = frame.transpose() * velocity - point.target * Vec3::UnitX();
      problem.friction[k] = c.friction;
    }
  }
  return problem;
}

PointVectors impulses_of(const ContactProblem& scene) {
  PointVectors impulses(scene.points.size());
  for (const ContactProblem::Contact& c : scene.contacts) {
    for (std::int64_t p = c.first_point; p < c.first_point + c.count; ++p) {
      const auto k = static_cast<std::size_t>(p);
      impulses[k] = frame_of(c).transpose() * scene.points[k].impulse;
    }
  }
  return impulses;
}

}  // namespace scree::bench
