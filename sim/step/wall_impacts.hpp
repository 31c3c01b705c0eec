// The impulses that impacts give to bodies that are not free ("walls").
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/impacts/impact.hpp"
#include "sim/response/wall_sums.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace scree {

/// Sums these impulses over a step, by the numbers of the bodies.
class WallImpacts {
 public:
  /// Learns which bodies are walls. `mobility`: of the bodies with these numbers.
  void find_walls(const std::vector<BodyNumber>& numbers, const std::vector<Mobility>& mobility);
  bool is_wall(BodyNumber number) const { return is_wall_[index_of(number)] != 0; }

  void clear() { impulses_.clear(); }
  /// Adds an impact. `arm(number)` returns the arm of its impulse about the centre of a wall (m).
  template <class Arm>
  void add(const Impact& impact, const Arm& arm) {
    add(BodyNumber{impact.i}, -impact.impulse, arm);
    add(BodyNumber{impact.j}, impact.impulse, arm);
  }
  /// Returns the sums of a body; zero if nothing has struck it.
  solver::WallImpulse of(BodyNumber number) const;

  /// Saves or loads the impulses on walls, for those that have any. `of_contacts`: impulses by contacts, by
  /// the numbers of the bodies, which are saved in the same sums; not read when loading.
  void archive(Archive& archive, std::vector<solver::WallImpulse> of_contacts);

 private:
  template <class Arm>
  void add(BodyNumber number, const Vec3& impulse, const Arm& arm) {
    if (!is_wall(number)) return;
    solver::WallImpulse& on = impulses_[number];
    on = on + solver::WallImpulse{impulse, arm(number).cross(impulse)};
  }

  std::vector<std::uint8_t> is_wall_;  // by number
  std::map<BodyNumber, solver::WallImpulse> impulses_;
};

}  // namespace scree
