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
  /// Returns the PCS of the bodies, each box extended along its path and enlarged by its margin (m). The view
  /// is valid until the next call.
  virtual ConstView<Pair> find(const Bodies<Space>& bodies, const Array<double, Space>& margin,
                               const BodyPaths& paths) = 0;
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

  /// Sets the contact margins of the bodies (m), and returns whether the candidates last made still include
  /// all pairs that may come as close as these within the foresight, for the bodies where they are now. Boxes
  /// that follow paths have the margins of approach speeds, and the candidates include all pairs that meet in
  /// free flight within the substep.
  bool cover(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
             Array<double, Space>& contact_margin);
  /// Makes the candidates anew, with room for the bodies' travel within one substep or more. They include all
  /// pairs that may come as close as the contact margins (m), which cover() has set before. If the boxes
  /// follow paths, the margins are raised to those of the approach speeds of the new pairs, and boxes that
  /// are too small for these are made a second time.
  void make(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
            Array<double, Space>& contact_margin);
  /// Returns the candidates last made. The view is valid until they are made the next time.
  ConstView<Pair> pairs() const { return candidates_.pairs(); }
  /// Must be called if impacts have sent bodies out of their boxes and are undone. Raises the margins (m) to
  /// those that boxes would need that are put around the bodies as they were then.
  void add_travel(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
                  Array<double, Space>& contact_margin) {
    boxes_.add_travel(bodies, time, parameters, contact_margin);
  }
  /// Must be called when the bodies have changed: the next call makes the pairs anew.
  void forget() {
    kept_ = false;
    boxes_.forget();
  }

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
  void make_in_boxes(const Bodies<Space>& bodies, const SearchTime& time,
                     const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                     const Array<double, Space>& contact_margin);

  std::unique_ptr<PairFinder<Space>> finder_;
  ApproachFinder<Space> approaches_;
  FatBoxes<Space> boxes_;
  Candidates<Space> candidates_;
  Array<double, Space>
      margin_of_new_pairs_;  // contact margins by the approach speeds of the pairs just made (m)
  std::int64_t pcs_size_ = 0;
  bool kept_ = false;
  std::int64_t times_made_ = 0;
};

}  // namespace scree
