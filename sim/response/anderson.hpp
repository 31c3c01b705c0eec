// Anderson's acceleration of fixed-point iterations.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace scree {

/// Accelerates an iteration x <- G(x). It extrapolates from the last steps to the point that, if G were
/// linear, would change least (Walker and Ni 2011, "Anderson acceleration for fixed-point iterations",
/// algorithm AA).
///
/// Products of vectors are weighted by row. Without a square root anywhere, numbers in other units (scaled by
/// a power of two) give the same result.
class AndersonAcceleration {
 public:
  using Vector = Eigen::VectorXd;

  /// Returns the point to take after `point`, whose image is G(point). Rows of weight 0 do not matter to the
  /// extrapolation, but follow it.
  Vector next(const Vector& point, const Vector& image, const Vector& weights) {
    const Step now{.change = image - point, .image = image};
    if (last_) differences_.push_front({now.change - last_->change, now.image - last_->image});
    last_ = now;
    if (differences_.size() > most_differences) differences_.pop_back();
    // The newest difference comes first: what two of them have in common is taken from the newer one.
    Vector next = image;
    std::vector<Orthogonal> basis;
    for (const Step& difference : differences_) {
      Step step = difference;
      for (const Orthogonal& other : basis) {
        const double share = dot(other.step.change, step.change, weights) / other.square;
        step.change -= share * other.step.change;
        step.image -= share * other.step.image;
      }
      const double square = dot(step.change, step.change, weights);
      const double before = dot(difference.change, difference.change, weights);
      if (!(square > least_new * least_new * before)) continue;
      next -= (dot(step.change, now.change, weights) / square) * step.image;
      basis.push_back({std::move(step), square});
    }
    return next;
  }

  /// Forgets the steps taken so far.
  void forget() {
    differences_.clear();
    last_.reset();
  }

 private:
  static constexpr std::size_t most_differences = 10;
  /// Least part of a difference, relative to its length, that no newer one may have: less is rounding.
  static constexpr double least_new = 1e-6;

  struct Step {
    Vector change;  ///< G(x) - x
    Vector image;   ///< G(x)
  };
  struct Orthogonal {
    Step step;
    double square;
  };

  static double dot(const Vector& a, const Vector& b, const Vector& weights) {
    return (a.array() * b.array() * weights.array()).sum();
  }

  std::optional<Step> last_;
  std::deque<Step> differences_;  // of each two steps that follow each other, the newest first
};

}  // namespace scree
