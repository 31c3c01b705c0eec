// Contact margins of bodies, and boxes with room for the bodies' motion.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/pairs/approach.hpp"
#include "sim/pairs/box_life.hpp"
#include "sim/pairs/new_pairs.hpp"

#include <cstdint>

namespace scree {

/// When pairs are searched.
struct SearchTime {
  double now = 0;        ///< time of the run at which the bodies are where they are (s)
  double substep = 0;    ///< length of the substep of which this is the midpoint (s); 0: the bodies are only
                         ///< looked at
  double foresight = 0;  ///< time within which contacts are searched (s)
};

/// Sets for each body the contact margin, within which contacts must be searched so that nothing that the
/// body can meet within dt (s) is missed (m): its travel, plus a slack as a share of its smallest_size.
///
/// In a heap that falls or flows, a body comes nearer to others only by the difference of their velocities,
/// which is much smaller than its travel. If approach speeds are given, the margin of a free body is at most
/// its travel at twice that speed, or by its turn alone if that is more: a contact with the other body can
/// change its velocity by up to twice as much, if the other is heavy and the restitution is 1. So two bodies
/// with equal velocities have room to meet if something else may stop one of them. Such margins do not
/// include the motion of the body itself.
template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, const ApproachSpeeds& approaches,
                     Array<double, Space>& margin);

/// Raises each margin to at least another (m).
template <class Space>
void raise_margins(const Array<double, Space>& least, Array<double, Space>& margin);

/// Returns the largest margin, and at least 0 (m).
template <class Space>
double largest_margin(const Array<double, Space>& margin);

/// Boxes around the bodies, fat enough that the pairs found with them stay valid while no body moves far.
///
/// Where bodies are fast, a box is around a path: straight, and at the velocity that the body had when the
/// box was put around it. Then bodies that move together are near each other on their paths, and need room
/// only for what makes them leave these.
template <class Space>
class FatBoxes {
 public:
  /// Returns whether boxes put around the bodies now shall follow their paths. That pays unless the bodies
  /// hardly move, and it must not take them farther than their period lets them look. The accurate mode
  /// searches contacts within the whole travel of each body.
  bool shall_follow_paths(const Bodies<Space>& bodies, const SearchTime& time,
                          const ResponseParameters& parameters);
  /// Puts the boxes around the bodies where they are, and around their paths if approach speeds are given,
  /// with room for contacts within the given margins (m), and for the bodies' travel in as many substeps as
  /// pays (BoxLife), as far as their period lets them look. There is always room for one substep.
  void put_around(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
                  const ApproachSpeeds& approaches, const Array<double, Space>& contact_margin);
  /// Must be called when bodies have changed other than by their motion.
  void forget() { life_.forget(); }
  /// Returns whether the boxes follow paths. Then approach speeds must be given to pairs_last().
  bool follow_paths() const { return paths().exist(); }
  /// Sets the contact_margins() within the foresight (m), and returns whether the pairs found with the boxes
  /// still include all pairs of bodies that may be in contact within these, wherever the bodies are now, or
  /// that meet in free flight within the substep: all bodies are in their boxes, or those outside are few and
  /// have no NewPairs.
  bool pairs_last(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
                  const ApproachSpeeds& approaches, Array<double, Space>& contact_margin);
  /// Returns how many bodies were outside their boxes when pairs_last() was last called.
  std::int64_t outside() const { return new_pairs_.outside(); }
  /// Must be called if impacts have sent bodies out of their boxes and are undone. Raises the margins (m) to
  /// those that boxes would need that are put around the bodies as they were then.
  void add_travel(const Bodies<Space>& bodies, const SearchTime& time, const ResponseParameters& parameters,
                  Array<double, Space>& contact_margin);
  const Array<double, Space>& margin() const { return margin_; }  ///< margins of the boxes (m)
  /// Returns the paths that the boxes are around.
  BodyPaths paths() const { return {velocity_.view(), from_, until_}; }
  void archive(Archive& archive) {
    archive("margin", margin_);
    archive("position", position_);
    archive("orientation", orientation_);
    archive("velocity", velocity_);
    archive("made", made_);
    archive("from", from_);
    archive("until", until_);
    archive.part("life", life_);
  }

 private:
  auto deviation(const Bodies<Space>& bodies, const SearchTime& time) const;

  BoxLife life_;
  double made_ = 0;              // time of the run when the boxes were put around the bodies (s)
  double from_ = 0, until_ = 0;  // start and end of the paths after that (s)
  Array<double, Space> margin_;
  // The bodies' state when the boxes were put around them. There are no velocities if these follow no paths.
  Array<Vec3, Space> position_;
  Array<Quat, Space> orientation_;
  Array<Vec3, Space> velocity_;
  NewPairs<Space> new_pairs_;
};

}  // namespace scree
