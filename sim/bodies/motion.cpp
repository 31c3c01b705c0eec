#include "sim/bodies/motion.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/laws/rotation.hpp"
#include "sim/laws/simd/simd.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace scree {

namespace {

struct Translate {
  BodyView bodies;
  double dt;
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::free) bodies.position[k] += dt * bodies.velocity[k];
  }
};

/// Rotates a body, and returns the drift of its energy (J).
struct Rotate {
  BodyView bodies;
  double dt;
  RotationOrder order;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    return rotate_freely(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k], dt, order);
  }
};

struct Fly {
  Translate translate;
  Rotate rotate;
  SCREE_HD double operator()(std::int64_t k) const {
    translate(k);
    return rotate(k);
  }
};

/// Rotates bodies side by side in SIMD lanes, on Host.
struct RotateBatch {
  Rotate rotate;
  View<double> drift;
  void operator()(std::int64_t batch) const {
    const BodyView& bodies = rotate.bodies;
    const std::int64_t first = batch * simd::width;
    const auto count = static_cast<int>(std::min<std::int64_t>(simd::width, bodies.count() - first));
    simd::RotatingBodies rotating = at_rest;
    std::uint32_t filled = 0;
    for (int l = 0; l < count; ++l) {
      const std::int64_t k = first + l;
      if (bodies.mobility[k] != Mobility::free || has_equal_moments(bodies.inverse_inertia[k])) {
        drift[k] = rotate(k);
      } else {
        filled |= 1u << l;
        load(k, l, rotating);
      }
    }
    if (filled == 0) return;
    simd::kernels().turn(rotating, rotate.dt, rotate.order == RotationOrder::fourth);
    for (int l = 0; l < count; ++l) {
      if ((filled >> l & 1) == 0) continue;
      const std::int64_t k = first + l;
      drift[k] = (rotating.far >> l & 1) != 0 ? rotate(k) : store(rotating, l, k);
    }
  }

 private:
  /// Bodies that a rotation leaves as they are, for unused lanes.
  static constexpr simd::RotatingBodies at_rest = [] {
    simd::RotatingBodies rotating{};
    for (int l = 0; l < simd::width; ++l) {
      rotating.w.at[l] = 1;
      for (simd::Lane* inverse :
           {&rotating.inverse_inertia.x, &rotating.inverse_inertia.y, &rotating.inverse_inertia.z})
        inverse->at[l] = 1;
    }
    return rotating;
  }();

  void load(std::int64_t k, int l, simd::RotatingBodies& rotating) const {
    const Vec3& inverse_inertia = rotate.bodies.inverse_inertia[k];
    const Quat& q = rotate.bodies.orientation[k];
    const AxisOrder axes(inverse_inertia);
    const auto put = [l](simd::LaneVec& lanes, const Vec3& value) {
      lanes.x.at[l] = value.x();
      lanes.y.at[l] = value.y();
      lanes.z.at[l] = value.z();
    };
    rotating.w.at[l] = q.w();
    put(rotating.v, axes.renamed(q.vec()));
    put(rotating.spin, axes.renamed(rotate.bodies.spin[k]));
    put(rotating.inverse_inertia, axes.ordered(inverse_inertia));
  }
  /// Stores the result of a lane, and returns the drift of the body's energy (J).
  double store(const simd::RotatingBodies& rotating, int l, std::int64_t k) const {
    const AxisOrder axes(rotate.bodies.inverse_inertia[k]);
    const auto take = [l, &axes](const simd::LaneVec& lanes) {
      return axes.named_back(Vec3(lanes.x.at[l], lanes.y.at[l], lanes.z.at[l]));
    };
    rotate.bodies.orientation[k].w() = rotating.w.at[l];
    rotate.bodies.orientation[k].vec() = take(rotating.v);
    rotate.bodies.spin[k] = take(rotating.spin);
    return rotating.drift.at[l];
  }
};

struct LoadDrift {
  ConstView<double> drift;
  SCREE_HD double operator()(std::int64_t k) const { return drift[k]; }
};

struct WorkOfForce {
  ConstBodyView bodies;
  ConstView<Vec3> start;
  ConstView<Vec3> acceleration;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return 0;
    return acceleration[k].dot(bodies.position[k] - start[k]) / bodies.inverse_mass[k];
  }
};

struct BodyEnergies {
  ConstBodyView bodies;
  Vec3 gravity;
  Vec3 reference;
  SCREE_HD Energies operator()(std::int64_t k) const {
    return energies_of_body(bodies, k, gravity, reference);
  }
};

struct BodyTotals {
  ConstBodyView bodies;
  Vec3 gravity;
  Vec3 reference;
  SCREE_HD Totals operator()(std::int64_t k) const { return totals_of_body(bodies, k, gravity, reference); }
};

struct Speed {
  ConstBodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::free ? bodies.velocity[k].norm() : 0.0;
  }
};

}  // namespace

template <class Space>
double advance(Bodies<Space>& bodies, double dt, const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const BodyView views = view_of(bodies);
  const Translate translate{views, dt};
  const Rotate rotate{views, dt, parameters.accurate ? RotationOrder::fourth : RotationOrder::second};
  if (!parameters.rotation) {
    parallel::for_each<Space>("motion.translate", n, translate);
    return 0;
  }
  if constexpr (std::is_same_v<Space, Host>) {
    constexpr std::int64_t few_batches = 16;  // fewer are not worth waking threads for
    if (parameters.gyroscopic) {
      Array<double, Host> drift(n);
      parallel::for_each<Host>("motion.translate", n, translate);
      parallel::for_each<Host>("motion.rotate", (n + simd::width - 1) / simd::width,
                               RotateBatch{rotate, drift.view()}, few_batches);
      return parallel::sum_by_tiles<double, Host>("motion.rotate", n, LoadDrift{std::as_const(drift).view()});
    }
  }
  if (parameters.gyroscopic)
    return parallel::sum_by_tiles<double, Space>("motion.fly", n, Fly{translate, rotate});
  parallel::for_each<Space>("motion.fly", n, Fly{translate, rotate});
  return 0;
}

template <class Space>
double work_of_forces(const Bodies<Space>& bodies, const Array<Vec3, Space>& start,
                      ConstView<Vec3> acceleration) {
  return parallel::sum_by_tiles<double, Space>("motion.work", bodies.count(),
                                               WorkOfForce{view_of(bodies), start.view(), acceleration});
}

template <class Space>
Energies energies_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference) {
  return parallel::sum_by_tiles<Energies, Space>("motion.energies", bodies.count(),
                                                 BodyEnergies{view_of(bodies), gravity, reference});
}

template <class Space>
Totals totals_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference) {
  return parallel::sum_by_tiles<Totals, Space>("motion.totals", bodies.count(),
                                               BodyTotals{view_of(bodies), gravity, reference});
}

template <class Space>
double largest_speed(const Bodies<Space>& bodies) {
  return parallel::max<double, Space>("motion.speed", bodies.count(), Speed{view_of(bodies)}, 0.0);
}

#define SCREE_INSTANTIATE(Space)                                                                    \
  template double advance<Space>(Bodies<Space>&, double, const ResponseParameters&);                \
  template double work_of_forces(const Bodies<Space>&, const Array<Vec3, Space>&, ConstView<Vec3>); \
  template Energies energies_of<Space>(const Bodies<Space>&, const Vec3&, const Vec3&);             \
  template Totals totals_of<Space>(const Bodies<Space>&, const Vec3&, const Vec3&);                 \
  template double largest_speed<Space>(const Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
