// Contact margins of bodies, and boxes with room for the bodies' motion.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/pairs/box_life.hpp"
#include "sim/pairs/new_pairs.hpp"

#include <cstdint>

namespace scree {

/// Sets for each body the contact margin, within which contacts must be searched so that nothing that the
/// body can meet within dt (s) is missed (m): its travel, plus a slack as a share of its smallest_size.
template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Space>& margin);

/// Returns the largest margin, and at least 0 (m).
template <class Space>
double largest_margin(const Array<double, Space>& margin);

/// Boxes around the bodies, fat enough that the pairs found with them stay valid while no body moves far.
template <class Space>
class FatBoxes {
 public:
  /// Puts the boxes around the bodies where they are, with room for contacts within the given margins (m),
  /// and for the bodies' travel in as many substeps as pays (BoxLife), as far as their period lets them look.
  /// `now`: time of the run (s); `substep`: length of a substep (s), for which there is always room.
  void put_around(const Bodies<Space>& bodies, double now, double substep,
                  const ResponseParameters& parameters, const Array<double, Space>& contact_margin);
  /// Must be called when bodies have changed other than by their motion.
  void forget() { life_.forget(); }
  /// Returns whether the pairs found with the boxes still include all pairs of bodies that may be in contact
  /// within the given margins (m), wherever the bodies are now: all bodies are in their boxes, or those
  /// outside are few and have no NewPairs.
  bool pairs_last(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin);
  /// Returns the same for contact_margins() within dt (s), which it sets.
  bool pairs_last(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                  Array<double, Space>& contact_margin);
  /// Returns how many bodies were outside their boxes when pairs_last() was last called.
  std::int64_t outside() const { return new_pairs_.outside(); }
  /// Must be called if impacts have sent bodies out of their boxes and are undone. Raises the margins (m) by
  /// the distance that each body has moved since the boxes were put around it.
  void add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin);
  const Array<double, Space>& margin() const { return margin_; }  ///< margins of the boxes (m)
  /// Returns how far the bodies travelled within dt (s), on average and in their smallest_size, when the
  /// boxes were put around them.
  double mean_travel(double dt) const { return rate_ * dt; }
  void archive(Archive& archive) {
    archive("margin", margin_);
    archive("rate", rate_);
    archive("position", position_);
    archive("orientation", orientation_);
    archive.part("life", life_);
  }

 private:
  bool pairs_last_now(const ConstBodyView& now, const Array<double, Space>& contact_margin);

  BoxLife life_;
  double rate_ = 0;  // mean speed of the bodies, in their smallest_size, when the boxes were made (1/s)
  Array<double, Space> margin_;
  Array<Vec3, Space> position_;
  Array<Quat, Space> orientation_;
  NewPairs<Space> new_pairs_;
};

}  // namespace scree
