#include "narrowphase/libccd_contacts.hpp"

#include "narrowphase/box_box_crosscheck.hpp"
#include "narrowphase/box_box_libccd.hpp"
#include "narrowphase/convex_libccd.hpp"
#include "narrowphase/crosscheck.hpp"

#include <optional>
#include <utility>

namespace scree {

namespace {

bool is_box_pair(Shape a, Shape b) { return a == Shape::box && b == Shape::box; }

/// Returns the method of libccd, none for the axes. `automatic` means the 15 axes: scree_bench_narrowphase
/// measures 0.2 to 0.6 us for a pair with them, against 0.5 to 1.2 us with MPR and 1.1 to 2.4 us with EPA (12
/// us where centres coincide). The axes are exact to rounding, while the certificate refuses about 10 % of
/// libccd's answers and more in every family except that of shallow contacts:
/// bench/results/xeon-2-cores/narrowphase.md.
std::optional<libccd::Method> method_of(BoxBoxMethod method) {
  if (method == BoxBoxMethod::ccd_gjk) return libccd::Method::gjk;
  if (method == BoxBoxMethod::ccd_mpr) return libccd::Method::mpr;
  return std::nullopt;
}
/// Returns the method of libccd, none for the axes. As for boxes, `automatic` means the search along axes.
std::optional<libccd::Method> method_of(ConvexMethod method) {
  if (method == ConvexMethod::ccd_gjk) return libccd::Method::gjk;
  if (method == ConvexMethod::ccd_mpr) return libccd::Method::mpr;
  return std::nullopt;
}

}  // namespace

bool LibccdContacts::is_needed() const {
  return settings_.crosscheck > 0 || method_of(settings_.box_box) || method_of(settings_.convex);
}

bool LibccdContacts::decides(Shape a, Shape b) const {
  return is_box_pair(a, b) ? method_of(settings_.box_box).has_value()
                           : is_convex_pair(a, b) && method_of(settings_.convex).has_value();
}

int LibccdContacts::find(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, double margin,
                         Manifold* out) {
  NarrowPhaseStats stats;
  int count = 0;
  if (is_box_pair(a.shape, b.shape)) {
    out->part = 0;
    count = box_box_libccd(a.solid, b.solid, margin, *method_of(settings_.box_box), *out, stats) ? 1 : 0;
  } else {
    count = find_contacts_by_libccd(a, b, shapes, margin, *method_of(settings_.convex), out, stats);
  }
  const std::scoped_lock lock(mutex_);
  stats_ += stats;
  return count;
}

bool LibccdContacts::checks(Shape a, Shape b, std::int32_t i, std::int32_t j) const {
  return settings_.crosscheck > 0 && (is_box_pair(a, b) || is_convex_pair(a, b)) &&
         is_crosschecked(settings_.crosscheck, searches_, i, j);
}

void LibccdContacts::check(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes) {
  CrosscheckStats stats;
  if (is_box_pair(a.shape, b.shape)) {
    crosscheck(a.solid, b.solid, stats);
  } else {
    crosscheck(a, b, shapes, stats);
  }
  const std::scoped_lock lock(mutex_);
  stats_.crosscheck += stats;
}

NarrowPhaseStats LibccdContacts::take_stats() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(stats_, {});
}

}  // namespace scree
