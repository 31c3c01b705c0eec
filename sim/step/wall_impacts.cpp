#include "sim/step/wall_impacts.hpp"

#include <cstddef>

namespace scree {

void WallImpacts::find_walls(const std::vector<BodyNumber>& numbers, const std::vector<Mobility>& mobility) {
  is_wall_.resize(numbers.size());
  for (std::size_t k = 0; k < numbers.size(); ++k)
    is_wall_[index_of(numbers[k])] = mobility[k] != Mobility::free && mobility[k] != Mobility::absent;
}

solver::WallImpulse WallImpacts::of(BodyNumber number) const {
  const auto on = impulses_.find(number);
  return on == impulses_.end() ? solver::WallImpulse{} : on->second;
}

void WallImpacts::archive(Archive& archive, std::vector<solver::WallImpulse> of_contacts) {
  std::vector<BodyNumber> walls;
  std::vector<Vec3> impulses;
  if (!archive.is_loading()) {
    of_contacts.resize(is_wall_.size());
    for (const auto& [number, on] : impulses_)
      of_contacts[index_of(number)] = of_contacts[index_of(number)] + on;
    for (std::size_t k = 0; k < of_contacts.size(); ++k) {
      if (of_contacts[k].impulse.isZero(0) && of_contacts[k].moment.isZero(0)) continue;
      walls.push_back(BodyNumber{static_cast<std::int32_t>(k)});
      impulses.insert(impulses.end(), {of_contacts[k].impulse, of_contacts[k].moment});
    }
  }
  archive("walls", walls);
  archive("on_walls", impulses);
  archive.expect(impulses.size() == 2 * walls.size(), "on_walls");
  if (!archive.is_loading()) return;
  clear();
  for (std::size_t k = 0; k < walls.size(); ++k) impulses_[walls[k]] = {impulses[2 * k], impulses[2 * k + 1]};
}

}  // namespace scree
