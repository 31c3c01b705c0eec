#include "sim/dynamics/motion.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/lanes/lanes.hpp"
#include "sim/dynamics/rotation.hpp"

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

/// Returns the drift of the body's energy (J).
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

/// Rotate of bodies side by side, on Host.
struct RotateBatch {
  Rotate rotate;
  View<double> drift;
  void operator()(std::int64_t batch) const {
    const BodyView& bodies = rotate.bodies;
    const std::int64_t first = batch * lanes::width;
    const auto count = static_cast<int>(std::min<std::int64_t>(lanes::width, bodies.count() - first));
    lanes::Tops tops = no_tops;
    std::uint32_t filled = 0;
    for (int l = 0; l < count; ++l) {
      const std::int64_t k = first + l;
      if (bodies.mobility[k] != Mobility::free || has_equal_moments(bodies.inverse_inertia[k])) {
        drift[k] = rotate(k);
      } else {
        filled |= 1u << l;
        load(k, l, tops);
      }
    }
    if (filled == 0) return;
    lanes::kernels().turn(tops, rotate.dt, rotate.order == RotationOrder::fourth);
    for (int l = 0; l < count; ++l) {
      if ((filled >> l & 1) == 0) continue;
      const std::int64_t k = first + l;
      drift[k] = (tops.far >> l & 1) != 0 ? rotate(k) : store(tops, l, k);
    }
  }

 private:
  /// That stay as they are.
  static constexpr lanes::Tops no_tops = [] {
    lanes::Tops tops{};
    for (int l = 0; l < lanes::width; ++l) {
      tops.w.at[l] = 1;
      for (lanes::Lane* inverse : {&tops.inverse_inertia.x, &tops.inverse_inertia.y, &tops.inverse_inertia.z})
        inverse->at[l] = 1;
    }
    return tops;
  }();

  void load(std::int64_t k, int l, lanes::Tops& tops) const {
    const Vec3& inverse_inertia = rotate.bodies.inverse_inertia[k];
    const Quat& q = rotate.bodies.orientation[k];
    const AxisOrder axes(inverse_inertia);
    const auto put = [l](lanes::LaneVec& lanes, const Vec3& value) {
      lanes.x.at[l] = value.x();
      lanes.y.at[l] = value.y();
      lanes.z.at[l] = value.z();
    };
    tops.w.at[l] = q.w();
    put(tops.v, axes.renamed(q.vec()));
    put(tops.spin, axes.renamed(rotate.bodies.spin[k]));
    put(tops.inverse_inertia, axes.ordered(inverse_inertia));
  }
  /// Returns the drift.
  double store(const lanes::Tops& tops, int l, std::int64_t k) const {
    const AxisOrder axes(rotate.bodies.inverse_inertia[k]);
    const auto take = [l, &axes](const lanes::LaneVec& lanes) {
      return axes.named_back(Vec3(lanes.x.at[l], lanes.y.at[l], lanes.z.at[l]));
    };
    rotate.bodies.orientation[k].w() = tops.w.at[l];
    rotate.bodies.orientation[k].vec() = take(tops.v);
    rotate.bodies.spin[k] = take(tops.spin);
    return tops.drift.at[l];
  }
};

struct LoadDrift {
  ConstView<double> drift;
  SCREE_HD double operator()(std::int64_t k) const { return drift[k]; }
};

/// No point of a body moves faster (m/s).
SCREE_HD double surface_speed(const ConstBodyView& bodies, std::int64_t k) {
  const Shape shape = bodies.shape[k];
  const double turning =
      shape == Shape::sphere ? 0.0 : bounding_radius(shape, bodies.size[k]) * bodies.spin[k].norm();
  return bodies.velocity[k].norm() + turning;
}

struct SetMargin {
  ConstBodyView bodies;
  View<double> margin;
  double dt;
  double slack;
  ResponseParameters parameters;
  SCREE_HD void operator()(std::int64_t k) const {
    const Shape shape = bodies.shape[k];
    if (bodies.mobility[k] == Mobility::fixed) {
      margin[k] = 0;
      return;
    }
    const double curving =
        bodies.mobility[k] == Mobility::prescribed ? parameters.prescribed_acceleration : 0.0;
    const double fall = (parameters.acceleration_of(k).norm() + curving) * dt * dt;
    margin[k] = (is_surface(shape) ? 0.0 : slack * smallest_size(shape, bodies.size[k])) +
                tolerance::travel_factor * (surface_speed(bodies, k) * dt + fall);
  }
};

/// How far a body's surface may have moved from where it was (m).
struct Travel {
  ConstBodyView bodies;
  ConstView<Vec3> position;
  ConstView<Quat> orientation;
  SCREE_HD double operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || bodies.mobility[k] == Mobility::absent) return 0;
    const double moved = (bodies.position[k] - position[k]).norm();
    if (bodies.shape[k] == Shape::sphere) return moved;
    // A turn by an angle moves a point by 2 r sin(angle / 2), which is at most 4 r sin(angle / 4).
    const Eigen::Vector4d& q = bodies.orientation[k].coeffs();
    const Eigen::Vector4d& before = orientation[k].coeffs();
    const double way = sqrt(fmin((q - before).squaredNorm(), (q + before).squaredNorm()));
    return moved + 2 * bounding_radius(bodies.shape[k], bodies.size[k]) * way;
  }
};

/// Whether a body may touch something outside its box.
struct IsOut {
  Travel travel;
  ConstView<double> box_margin;
  ConstView<double> contact_margin;
  SCREE_HD bool operator()(std::int64_t k) const {
    const Mobility mobility = travel.bodies.mobility[k];
    if (mobility == Mobility::fixed || mobility == Mobility::absent) return false;
    return travel(k) + contact_margin[k] > box_margin[k];
  }
};

struct NoteOutside {
  IsOut is_out;
  BodiesOutside outside;
  SCREE_HD void operator()(std::int64_t k) const {
    if (is_out(k)) outside.add({is_out.travel.bodies, is_out.contact_margin}, k);
  }
};

/// The same with margins that are yet to be set.
struct NoteOutsideWithMargin {
  SetMargin margins;
  NoteOutside note;
  SCREE_HD void operator()(std::int64_t k) const {
    margins(k);
    note(k);
  }
};

struct LoadMargin {
  ConstView<double> margin;
  SCREE_HD double operator()(std::int64_t k) const { return margin[k]; }
};

struct AddTravel {
  Travel travel;
  View<double> margin;
  SCREE_HD void operator()(std::int64_t k) const { margin[k] += travel(k); }
};

/// At least the margin wanted and the skin, and how far a body's surface travels in so long (s): fast bodies
/// are few, and for them alone the boxes of all would have to be put anew. So would they for a slow one among
/// others, which pass their speed on to it.
struct RaiseMargin {
  ConstBodyView bodies;
  ConstView<double> wanted;
  View<double> margin;
  double life;
  double typical;  ///< speed of bodies, in their smallest_size (1/s)
  double most;     ///< but for what is wanted (m)
  SCREE_HD void operator()(std::int64_t k) const {
    if (bodies.mobility[k] == Mobility::fixed || is_surface(bodies.shape[k])) return;
    const double size = smallest_size(bodies.shape[k], bodies.size[k]);
    const double travel =
        tolerance::contact_slack * size + life * fmax(surface_speed(bodies, k), typical * size);
    const double ample = fmax(margin[k], fmax(wanted[k] + tolerance::pair_skin * size, travel));
    margin[k] = fmax(wanted[k], fmin(ample, most));
  }
};

/// How fast bodies leave where they are, in their own smallest_size (1/s).
struct Leaving {
  double rates = 0;  ///< their sum
  std::int64_t count = 0;
  SCREE_HD friend Leaving operator+(const Leaving& a, const Leaving& b) {
    return {a.rates + b.rates, a.count + b.count};
  }
};
struct LeavingOf {
  ConstBodyView bodies;
  SCREE_HD Leaving operator()(std::int64_t k) const {
    if (bodies.mobility[k] != Mobility::free) return {};
    return {surface_speed(bodies, k) / smallest_size(bodies.shape[k], bodies.size[k]), 1};
  }
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
    constexpr std::int64_t few_batches = 16;  // worth waking threads for
    if (parameters.gyroscopic) {
      Array<double, Host> drift(n);
      parallel::for_each<Host>("motion.translate", n, translate);
      parallel::for_each<Host>("motion.rotate", (n + lanes::width - 1) / lanes::width,
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
void contact_margins(const Bodies<Space>& bodies, double dt, double slack,
                     const ResponseParameters& parameters, Array<double, Space>& margin) {
  margin.resize(bodies.count());
  parallel::for_each<Space>("motion.margins", bodies.count(),
                            SetMargin{view_of(bodies), margin.view(), dt, slack, parameters});
}

template <class Space>
double largest_margin(const Array<double, Space>& margin) {
  return parallel::max<double, Space>("motion.margins", margin.size(), LoadMargin{margin.view()}, 0.0);
}

template <class Space>
void FatBoxes<Space>::put_around(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                                 const Array<double, Space>& contact_margin) {
  const auto leaving =
      parallel::sum_by_tiles<Leaving, Space>("motion.leaving", bodies.count(), LeavingOf{view_of(bodies)});
  const double rate = leaving.rates / static_cast<double>(std::max<std::int64_t>(leaving.count, 1));
  const double longest = tolerance::most_pair_steps * dt;
  const double life =
      rate * longest > tolerance::pair_travel ? std::max(dt, tolerance::pair_travel / rate) : longest;
  contact_margins(bodies, dt, tolerance::contact_slack + tolerance::pair_skin, parameters, margin_);
  parallel::for_each<Space>("motion.margins", bodies.count(),
                            RaiseMargin{view_of(bodies), contact_margin.view(), margin_.view(), life, rate,
                                        bodies.period.most_margin});
  copy(position_, bodies.position);
  copy(orientation_, bodies.orientation);
}

template <class Space>
bool FatBoxes<Space>::pairs_last(const Bodies<Space>& bodies, const Array<double, Space>& contact_margin) {
  const ConstBodyView now = view_of(bodies);
  const IsOut is_out{{now, position_.view(), orientation_.view()}, margin_.view(), contact_margin.view()};
  parallel::for_each<Space>("motion.out", bodies.count(), NoteOutside{is_out, new_pairs_.start()});
  return pairs_last_now(now, contact_margin);
}

template <class Space>
bool FatBoxes<Space>::pairs_last(const Bodies<Space>& bodies, double dt, const ResponseParameters& parameters,
                                 Array<double, Space>& contact_margin) {
  contact_margin.resize(bodies.count());
  const ConstBodyView now = view_of(bodies);
  const SetMargin margins{now, contact_margin.view(), dt, tolerance::contact_slack, parameters};
  const IsOut is_out{
      {now, position_.view(), orientation_.view()}, margin_.view(), std::as_const(contact_margin).view()};
  parallel::for_each<Space>("motion.out", bodies.count(),
                            NoteOutsideWithMargin{margins, {is_out, new_pairs_.start()}});
  return pairs_last_now(now, contact_margin);
}

template <class Space>
bool FatBoxes<Space>::pairs_last_now(const ConstBodyView& now, const Array<double, Space>& contact_margin) {
  ConstBodyView then = now;
  then.position = std::as_const(position_).view();
  then.orientation = std::as_const(orientation_).view();
  return !new_pairs_.exist({now, contact_margin.view()}, {then, std::as_const(margin_).view()});
}

template <class Space>
void FatBoxes<Space>::add_travel(const Bodies<Space>& bodies, Array<double, Space>& contact_margin) const {
  parallel::for_each<Space>(
      "motion.travel", bodies.count(),
      AddTravel{{view_of(bodies), position_.view(), orientation_.view()}, contact_margin.view()});
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
  template void contact_margins(const Bodies<Space>&, double, double, const ResponseParameters&,    \
                                Array<double, Space>&);                                             \
  template double largest_margin<Space>(const Array<double, Space>&);                               \
  template class FatBoxes<Space>;                                                                   \
  template double work_of_forces(const Bodies<Space>&, const Array<Vec3, Space>&, ConstView<Vec3>); \
  template Energies energies_of<Space>(const Bodies<Space>&, const Vec3&, const Vec3&);             \
  template Totals totals_of<Space>(const Bodies<Space>&, const Vec3&, const Vec3&);                 \
  template double largest_speed<Space>(const Bodies<Space>&);
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
