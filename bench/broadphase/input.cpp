#include "bench/broadphase/input.hpp"

#include "bench/broadphase/data_sets.hpp"
#include "sim/step/simulation.hpp"

#include <algorithm>

namespace scree::bench {

bool names_scene(const std::string& word) { return word.ends_with(".yaml") || word.ends_with(".yml"); }

Objects<Host> objects_of_scene(const std::string& file) {
  Simulation simulation(read_scene(file, {}), {.space = SpaceChoice::host});
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  simulation.step();
  std::vector<Aabb> bounds;
  for (const BodyBox& box : simulation.boxes()) {
    bounds.emplace_back();
    std::ranges::copy(box.lo, bounds.back().lo);
    std::ranges::copy(box.hi, bounds.back().hi);
  }
  Objects<Host> objects;
  copy(objects.bounds, bounds);
  copy(objects.mobility, snapshot.bodies.mobility);
  return objects;
}

Objects<Host> objects_of_data_set(const std::string& name, std::int64_t n) {
  Objects<Host> objects;
  copy(objects.bounds, make_data_set(name, n));
  objects.mobility.resize(n);
  std::ranges::fill(objects.mobility.view(), Mobility::free);
  return objects;
}

}  // namespace scree::bench
