// The broad phase for bodies in a space: in that space, or for bodies on Host in the other, to which their
// bounds go and from which the pairs come back.
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
  /// The PCS of the bodies, each box fat by its margin (m). Valid until the next call.
  virtual ConstView<Pair> find(const Bodies<Space>& bodies, const Array<double, Space>& margin) = 0;
  virtual const char* space_name() const = 0;
  /// Of the last call of find().
  virtual std::vector<BodyBox> boxes() const = 0;
  virtual GridOccupancy grid_occupancy() const = 0;
  /// The boxes.
  virtual void archive(Archive& archive) = 0;
};

/// `on_device`: the PCS of bodies on Host is made on the GPU too; throws InputError if there is none.
/// `origin`: the local origin to which the float bounds are relative (m).
template <class Space>
std::unique_ptr<PairFinder<Space>> make_pair_finder(const BroadPhaseSettings& settings, bool on_device,
                                                    const Vec3& origin);

/// The PCS and the candidates for contacts. They are made anew only when so many bodies have left their boxes
/// that it does not pay to look at each for what it may touch, or when one of them may touch what it is not
/// paired with.
template <class Space>
class KeptPairs {
 public:
  KeptPairs(const BroadPhaseSettings& settings, bool on_device, const Vec3& origin)
      : finder_(make_pair_finder<Space>(settings, on_device, origin)) {}

  /// Candidates among which are all pairs that may come as close as their contact margins (m). Where they
  /// have to be made anew, they have room for the bodies' travel within `reach` (s). Valid until they are
  /// made the next time.
  ConstView<Pair> covering(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin,
                           double reach, const ResponseParameters& parameters);
  /// Candidates made anew, likewise.
  ConstView<Pair> make(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin, double reach,
                       const ResponseParameters& parameters);
  /// Those last made.
  ConstView<Pair> pairs() const { return candidates_.pairs(); }
  /// Whether they still do, for the bodies where they are now.
  bool cover(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin) {
    return kept_ && boxes_.pairs_last(bodies, contact_margin);
  }
  /// The same with the margins (m) of contacts within `foresight` (s), which are set.
  bool cover(const Bodies<Space>& bodies, double foresight, const ResponseParameters& parameters,
             Array<double, Space>& contact_margin) {
    if (kept_) return boxes_.pairs_last(bodies, foresight, parameters, contact_margin);
    contact_margins<Space>(bodies, foresight, tolerance::contact_slack, parameters, contact_margin);
    return false;
  }
  /// Raises the margins (m) by what each body has moved since the pairs were made.
  void add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) const {
    boxes_.add_travel(bodies, contact_margin);
  }
  /// The bodies are others: the next call makes the pairs anew.
  void forget() { kept_ = false; }

  std::vector<BodyBox> boxes() const { return finder_->boxes(); }
  GridOccupancy grid_occupancy() const { return finder_->grid_occupancy(); }
  /// Of the PCS.
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
