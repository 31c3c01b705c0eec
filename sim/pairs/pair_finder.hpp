// The broad phase for bodies in a space. It runs in that space, or for bodies on Host also on Device: then
// bounds are copied there, and the pairs are copied back.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/candidates.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/pairs/fat_boxes.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

template <class Space>
class PairFinder {
 public:
  virtual ~PairFinder() = default;
  /// Returns the PCS of the bodies, each box enlarged by its margin (m). The view is valid until the next
  /// call.
  virtual ConstView<Pair> find(const Bodies<Space>& bodies, const Array<double, Space>& margin) = 0;
  virtual const char* space_name() const = 0;
  /// Returns the boxes of the last call of find().
  virtual std::vector<BodyBox> boxes() const = 0;
  virtual GridOccupancy grid_occupancy() const = 0;
  /// Saves or loads the boxes.
  virtual void archive(Archive& archive) = 0;
};

/// Makes a pair finder. `on_device`: the PCS of bodies on Host is found on the GPU too; throws InputError if
/// there is none. `origin`: the local origin to which the float bounds are relative (m).
template <class Space>
std::unique_ptr<PairFinder<Space>> make_pair_finder(const BroadPhaseSettings& settings, bool on_device,
                                                    const Vec3& origin);

/// The PCS and the candidate pairs for contacts. They are made anew only if so many bodies have left their
/// boxes that it does not pay to look at each for what it may touch, or if one of them may touch a body with
/// which it is not paired.
template <class Space>
class KeptPairs {
 public:
  KeptPairs(const BroadPhaseSettings& settings, bool on_device, const Vec3& origin)
      : finder_(make_pair_finder<Space>(settings, on_device, origin)) {}

  /// Returns candidates that include all pairs which may come as close as their contact margins (m). If they
  /// have to be made anew, they have room for the bodies' travel within one substep or more. `now`: time of
  /// the run (s); `substep`: length of a substep (s). The view is valid until they are made the next time.
  ConstView<Pair> covering(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin,
                           double now, double substep, const ResponseParameters& parameters);
  /// Makes the candidates of covering() anew, and returns them.
  ConstView<Pair> make(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin, double now,
                       double substep, const ResponseParameters& parameters);
  /// Returns the candidates last made.
  ConstView<Pair> pairs() const { return candidates_.pairs(); }
  /// Returns whether the candidates last made still include all pairs that may come that close, for the
  /// bodies where they are now.
  bool cover(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin) {
    return kept_ && boxes_.pairs_last(bodies, contact_margin);
  }
  /// Returns the same for the margins (m) of contacts within `foresight` (s), which it sets.
  bool cover(const Bodies<Space>& bodies, double foresight, const ResponseParameters& parameters,
             Array<double, Space>& contact_margin) {
    if (kept_) return boxes_.pairs_last(bodies, foresight, parameters, contact_margin);
    contact_margins<Space>(bodies, foresight, tolerance::contact_slack, parameters, contact_margin);
    return false;
  }
  /// Must be called if impacts have sent bodies out of their boxes and are undone. Raises the margins (m) by
  /// the distance that each body has moved since the pairs were made.
  void add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) {
    boxes_.add_travel(bodies, contact_margin);
  }
  /// Must be called when the bodies have changed: the next call makes the pairs anew.
  void forget() {
    kept_ = false;
    boxes_.forget();
  }

  /// Returns how far the bodies travelled within dt (s), on average and in their smallest_size, when the
  /// pairs were last made.
  double mean_travel(double dt) const { return boxes_.mean_travel(dt); }
  std::vector<BodyBox> boxes() const { return finder_->boxes(); }
  GridOccupancy grid_occupancy() const { return finder_->grid_occupancy(); }
  /// Returns the number of pairs in the PCS.
  std::int64_t size() const { return pcs_size_; }
  std::int64_t times_made() const { return times_made_; }
  const char* space_name() const { return finder_->space_name(); }
  void archive(Archive& archive) {
    archive.part("finder", *finder_);
    archive.part("boxes", boxes_);
    archive.part("candidates", candidates_);
    archive("pcs_size", pcs_size_);
    archive("kept", kept_);
    archive("times_made", times_made_);
  }

 private:
  std::unique_ptr<PairFinder<Space>> finder_;
  FatBoxes<Space> boxes_;
  Candidates<Space> candidates_;
  std::int64_t pcs_size_ = 0;
  bool kept_ = false;
  std::int64_t times_made_ = 0;
};

}  // namespace scree
