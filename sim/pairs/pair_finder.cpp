#include "sim/pairs/pair_finder.hpp"

#include "broadphase/bounds.hpp"
#include "broadphase/grid_plan.hpp"
#include "broadphase/periodic_images.hpp"
#include "core/error.hpp"
#include "core/space_chosen.hpp"
#include "core/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

namespace scree {

namespace {

template <class BodySpace, class Space>
class PairFinderIn final : public PairFinder<BodySpace> {
 public:
  PairFinderIn(const BroadPhaseSettings& settings, const Vec3& origin)
      : settings_(settings), broad_phase_(make_broad_phase<Space>(settings)), origin_(origin) {}

  ConstView<Pair> find(const Bodies<BodySpace>& bodies, const Array<double, BodySpace>& margin,
                       const BodyPaths& paths) override {
    body_bounds_.resize(bodies.count());
    compute_bounds<BodySpace>(view_of(bodies), margin.view(), paths, origin_, body_bounds_.view());
    if (!bodies.period.exists) return find_among(body_bounds_, bodies.mobility);
    images_.take(std::as_const(body_bounds_).view(), bodies.mobility.view(), bodies.period);
    return images_.pairs_of(find_among(images_.bounds(), images_.mobility()));
  }

  const char* space_name() const override { return Space::name; }
  void archive(Archive& archive) override { archive("bounds", body_bounds_); }

  std::vector<BodyBox> boxes() const override {
    std::vector<BodyBox> boxes;
    for (const Aabb& box : to_vector(body_bounds_))
      boxes.push_back({std::to_array(box.lo), std::to_array(box.hi)});
    return boxes;
  }

  GridOccupancy grid_occupancy() const override {
    GridOccupancy grid;
    if (settings_.method != BroadPhaseMethod::hierarchical_grid) return grid;
    Array<Aabb, Host> host_bounds;
    copy(host_bounds, body_bounds_);
    const ConstView<Aabb> boxes = std::as_const(host_bounds).view();
    const Census census = take_census<Host>(boxes);
    const std::vector<GridLevel> levels = plan_grid(census, count_sizes<Host>(boxes, census),
                                                    grid_costs_for<Space>(settings_.levels), settings_.levels)
                                              .levels;
    if (levels.empty()) return grid;
    for (const GridLevel& level : levels) grid.width.push_back(level.cell);
    for (const Aabb& box : boxes) {
      grid.level.push_back(is_absent(box) ? 0 : level_of_extent(levels.data(), extent_of(box)));
      if (!is_absent(box)) grid.cells.push_back(cell_around(box, levels, grid.level.back()));
    }
    const auto key = [](const OccupiedCell& c) {
      return std::tuple(c.level, c.low.z(), c.low.y(), c.low.x());
    };
    std::ranges::sort(grid.cells, {}, key);
    grid.cells.erase(std::unique(grid.cells.begin(), grid.cells.end()), grid.cells.end());
    return grid;
  }

 private:
  ConstView<Pair> find_among(const Array<Aabb, BodySpace>& bounds,
                             const Array<Mobility, BodySpace>& mobility) {
    if constexpr (std::is_same_v<Space, BodySpace>) {
      return broad_phase_->find(bounds.view(), mobility.view());
    } else {
      copy(bounds_, bounds);
      copy(mobility_, mobility);
      const ConstView<Pair> found =
          broad_phase_->find(std::as_const(bounds_).view(), std::as_const(mobility_).view());
      pairs_.resize(found.size());
      copy_bytes<BodySpace, Space>(pairs_.data(), found.data(),
                                   static_cast<std::size_t>(found.size()) * sizeof(Pair));
      return std::as_const(pairs_).view();
    }
  }

  OccupiedCell cell_around(const Aabb& box, const std::vector<GridLevel>& levels, int number) const {
    const GridLevel& level = levels[static_cast<std::size_t>(number)];
    OccupiedCell cell{number, Vec3::Zero(), level.cell};
    for (int a = 0; a < 3; ++a) {
      cell.low[a] = level.cell * (level.cell_of(centre_of(box, a), a) + level.first[a]) + origin_[a];
    }
    return cell;
  }

  BroadPhaseSettings settings_;
  std::unique_ptr<BroadPhase<Space>> broad_phase_;
  Vec3 origin_;
  Array<Aabb, BodySpace> body_bounds_;
  PeriodicImages<BodySpace> images_;
  // Copies on the way to the other space and back, if the PCS is found there.
  Array<Aabb, Space> bounds_;
  Array<Mobility, Space> mobility_;
  Array<Pair, BodySpace> pairs_;
};

/// Throws RunError if contact margins are so large that two bodies may meet through two images: only the
/// nearest image would be found.
template <class Space>
void require_one_image(const Period& period, const Array<double, Space>& contact_margin) {
  if (!period.exists) return;
  const double margin = largest_margin<Space>(contact_margin);
  if (margin <= period.most_margin) return;
  throw RunError(
      fmt::format("a body may travel {:.3g} m within a substep, but the periodic cell is so short that at "
                  "most {:.3g} m is "
                  "allowed: farther, it could meet one body through two images; try a smaller time.step or a "
                  "longer period",
                  margin, period.most_margin));
}

}  // namespace

template <class Space>
bool KeptPairs<Space>::cover(const Bodies<Space>& bodies, const SearchTime& time,
                             const ResponseParameters& parameters, Array<double, Space>& contact_margin) {
  if (!kept_) {
    contact_margins<Space>(bodies, time.foresight, tolerance::contact_slack, parameters, {}, contact_margin);
    return false;
  }
  const ApproachSpeeds approaches =
      boxes_.follow_paths() ? approaches_.find(bodies, pairs()) : ApproachSpeeds{};
  return boxes_.pairs_last(bodies, time, parameters, approaches, contact_margin);
}

template <class Space>
void KeptPairs<Space>::make(const Bodies<Space>& bodies, const SearchTime& time,
                            const ResponseParameters& parameters, Array<double, Space>& contact_margin) {
  const timing::Region region("broadphase");
  const bool along_paths = boxes_.shall_follow_paths(bodies, time, parameters);
  const bool had_paths = kept_ && boxes_.follow_paths();
  // Approach speeds need pairs.
  if (along_paths && !kept_) make_in_boxes(bodies, time, parameters, {}, contact_margin);
  const auto approaches = [&] { return along_paths ? approaches_.find(bodies, pairs()) : ApproachSpeeds{}; };
  if (along_paths != had_paths) {
    contact_margins<Space>(bodies, time.foresight, tolerance::contact_slack, parameters, approaches(),
                           contact_margin);
  }
  make_in_boxes(bodies, time, parameters, approaches(), contact_margin);
  if (!along_paths) return;
  // Bodies that are newly paired with others may need more room for contacts with these.
  const bool covered = cover(bodies, time, parameters, margin_of_new_pairs_);
  raise_margins<Space>(margin_of_new_pairs_, contact_margin);
  if (!covered) make_in_boxes(bodies, time, parameters, approaches(), contact_margin);
}

template <class Space>
void KeptPairs<Space>::make_in_boxes(const Bodies<Space>& bodies, const SearchTime& time,
                                     const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                                     const Array<double, Space>& contact_margin) {
  require_one_image<Space>(bodies.period, contact_margin);
  boxes_.put_around(bodies, time, parameters, approaches, contact_margin);
  const ConstView<Pair> pcs = finder_->find(bodies, boxes_.margin(), boxes_.paths());
  pcs_size_ = pcs.size();
  candidates_.list({view_of(bodies), boxes_.margin().view(), boxes_.paths()}, pcs);
  kept_ = true;
  ++times_made_;
}

template <class Space>
std::unique_ptr<PairFinder<Space>> make_pair_finder(const BroadPhaseSettings& settings, bool on_device,
                                                    const Vec3& origin) {
  if constexpr (std::is_same_v<Space, Host>) {
    return in_chosen_space(on_device, [&](auto finding) -> std::unique_ptr<PairFinder<Space>> {
      return std::make_unique<PairFinderIn<Host, decltype(finding)>>(settings, origin);
    });
  } else {
    return std::make_unique<PairFinderIn<Space, Space>>(settings, origin);
  }
}

#define SCREE_INSTANTIATE(Space)                                                                       \
  template class KeptPairs<Space>;                                                                     \
  template std::unique_ptr<PairFinder<Space>> make_pair_finder<Space>(const BroadPhaseSettings&, bool, \
                                                                      const Vec3&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
