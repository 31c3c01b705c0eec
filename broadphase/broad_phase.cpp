#include "broadphase/broad_phase.hpp"

#include "broadphase/alternative_grid.hpp"
#include "broadphase/brute_force.hpp"
#include "broadphase/hierarchical_grid.hpp"
#include "broadphase/lbvh.hpp"
#include "broadphase/sweep_and_prune.hpp"
#include "broadphase/uniform_grid.hpp"
#include "core/error.hpp"

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_broad_phase(const BroadPhaseSettings& settings) {
  switch (settings.method) {
    case BroadPhaseMethod::hierarchical_grid:
      return make_hierarchical_grid<Space>(settings.levels);
    case BroadPhaseMethod::alternative_grid:
      return make_alternative_grid<Space>(settings.levels);
    case BroadPhaseMethod::uniform_grid:
      return make_uniform_grid<Space>();
    case BroadPhaseMethod::sweep_and_prune:
      return make_sweep_and_prune<Space>();
    case BroadPhaseMethod::lbvh:
      return make_lbvh<Space>();
    case BroadPhaseMethod::brute_force:
      return make_brute_force<Space>();
  }
  throw RunError("unknown broad-phase method");
}

#define SCREE_INSTANTIATE(Space) \
  template std::unique_ptr<BroadPhase<Space>> make_broad_phase<Space>(const BroadPhaseSettings&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
