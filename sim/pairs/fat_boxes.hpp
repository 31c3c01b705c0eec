// How far the contacts of bodies reach, and boxes with room for their motion.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/pairs/new_pairs.hpp"

#include <cstdint>

namespace scree {

/// How far contacts of each body must reach so that nothing it can meet within dt is missed (m):
/// its travel, and a slack as a share of its smallest_size.
template <class Space>
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Space>& margin);

/// The largest of them, and at least 0 (m).
template <class Space>
double largest_margin(const Array<double, Space>& margin);

/// Boxes around the bodies, fat enough that pairs found with them last while nobody moves far.
template <class Space>
class FatBoxes {
 public:
  /// Around the bodies where they are, with room for their travel within dt (s), as far as their period lets
  /// them look, and for contacts that reach as far as given (m).
  void put_around(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                  const Array<double, Space>& contact_margin);
  /// Whether all bodies that may be in contact, wherever they are now, and with contacts that reach as far as
  /// given (m), are among the pairs that were found with the boxes: all are in their boxes, or those outside
  /// are few and have no NewPairs.
  bool pairs_last(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin);
  /// The same with contact_margins() within dt (s), which are set.
  bool pairs_last(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                  Array<double, Space>& contact_margin);
  /// How many bodies were outside their boxes when that was last asked.
  std::int64_t outside() const { return new_pairs_.outside(); }
  /// Raises the margins (m) by what each body has moved since the boxes were put around it.
  void add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) const;
  const Array<double, Space>& margin() const { return margin_; }  ///< (m)
  void archive(Archive& archive) {
    archive("margin", margin_);
    archive("position", position_);
    archive("orientation", orientation_);
  }

 private:
  bool pairs_last_now(const ConstBodyView& now, const Array<double, Space>& contact_margin);

  Array<double, Space> margin_;
  Array<Vec3, Space> position_;
  Array<Quat, Space> orientation_;
  NewPairs<Space> new_pairs_;
};

}  // namespace scree
