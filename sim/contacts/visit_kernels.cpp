// The kernels of ContactKernels. This file is compiled once for each instruction set, as
// sim/laws/simd/kernels.cpp is; SCREE_SIMD names the instruction set.
#include "sim/contacts/visit_kernels.hpp"

#include "sim/laws/simd/kernels/vectors.hpp"

#include <cmath>
#include <cstddef>

namespace scree::solver::SCREE_SIMD {

namespace {

constexpr int width = simd::width;

template <class Number>
using VectorOf = typename simd::SCREE_SIMD::LanesOf<Number>::V;

/// Returns the same numbers in double precision.
template <class Vector>
SCREE_LAW VectorOf<double> in_double(const Vector& v) {
  return __builtin_convertvector(v, VectorOf<double>);
}

/// The arithmetic of eight contacts side by side. It adds what the visits need beyond the laws, as Scalar
/// does.
template <class Number>
struct ContactLanes : simd::SCREE_SIMD::LanesOf<Number> {
  using Real = Number;
  using V = VectorOf<Number>;
  static constexpr int width = simd::width;
  static_assert(sizeof(BodyRecord<Real>) == sizeof(V) && 2 * sizeof(CentreRecord<Real>) == sizeof(V));

  SCREE_LAW static V all(Real a) { return a - V{}; }
  SCREE_LAW static V get(const Real* from) { return *reinterpret_cast<const V*>(from); }
  SCREE_LAW static void set(Real* to, const V& value) { *reinterpret_cast<V*>(to) = value; }
  SCREE_LAW static std::int32_t most(const std::int32_t* of) {
    std::int32_t most = 0;
    for (int l = 0; l < width; ++l) most = of[l] > most ? of[l] : most;
    return most;
  }

  template <End end>
  SCREE_LAW static simd::Moving<ContactLanes> bodies(const BodyRecord<Real>* from, const Ends* ends) {
    V rows[width];
    for (int l = 0; l < width; ++l) rows[l] = reinterpret_cast<const V&>(from[body_at<end>(ends[l])]);
    simd::SCREE_SIMD::transpose<width>(rows);
    return {{rows[0], rows[1], rows[2]}, rows[3], {rows[4], rows[5], rows[6]}, rows[7]};
  }
  template <End end>
  SCREE_LAW static simd::Centre<ContactLanes> bodies(const CentreRecord<Real>* from, const Ends* ends) {
    V rows[half];
    for (int l = 0; l < half; ++l) {
      rows[l] = __builtin_shufflevector(half_of(from[body_at<end>(ends[l])]),
                                        half_of(from[body_at<end>(ends[l + half])]), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    simd::SCREE_SIMD::transpose<half>(rows);
    return {{rows[0], rows[1], rows[2]}, rows[3]};
  }
  template <End end>
  SCREE_LAW static void put(const simd::Moving<ContactLanes>& from, BodyRecord<Real>* to, const Ends* ends) {
    V rows[width] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass,
                     from.spin.x,     from.spin.y,     from.spin.z,     from.inverse_inertia};
    simd::SCREE_SIMD::transpose<width>(rows);
    for (int l = 0; l < width; ++l) {
      BodyRecord<Real>& body = to[body_at<end>(ends[l])];
      if (body.inverse_mass > 0) whole(body) = rows[l];
    }
  }
  template <End end>
  SCREE_LAW static void put(const simd::Centre<ContactLanes>& from, CentreRecord<Real>* to,
                            const Ends* ends) {
    V rows[half] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass};
    simd::SCREE_SIMD::transpose<half>(rows);
    for (int l = 0; l < half; ++l) {
      CentreRecord<Real>& low = to[body_at<end>(ends[l])];
      CentreRecord<Real>& high = to[body_at<end>(ends[l + half])];
      if (low.inverse_mass > 0) half_of(low) = __builtin_shufflevector(rows[l], rows[l], 0, 1, 2, 3);
      if (high.inverse_mass > 0) half_of(high) = __builtin_shufflevector(rows[l], rows[l], 4, 5, 6, 7);
    }
  }

  SCREE_LAW static V& whole(BodyRecord<Real>& body) { return reinterpret_cast<V&>(body); }

 private:
  static constexpr int half = width / 2;
  using Half = typename simd::SCREE_SIMD::VectorsOf<Real>::Half;

  SCREE_LAW static const Half& half_of(const CentreRecord<Real>& body) {
    return reinterpret_cast<const Half&>(body);
  }
  SCREE_LAW static Half& half_of(CentreRecord<Real>& body) { return reinterpret_cast<Half&>(body); }
};

using Lanes = ContactLanes<double>;
using Vector = Lanes::V;

// Each of these loops has its own copy of the visit, which stores to memory cannot change.
template <class Real, class Visit>
void push_over(const Visit& given, Blocks blocks) {
  const Visit visit = given;
  for (std::int64_t k = 0; k < blocks.count; ++k) visit.template visit<ContactLanes<Real>>(blocks.place(k));
}

/// Sums are in double, as those of single contacts are.
template <class Real, class Visit>
SweepChange sweep_over(const Visit& given, Blocks blocks, Real beta) {
  const Visit visit = given;
  ChangeOf<Lanes> sum;
  for (std::int64_t k = 0; k < blocks.count; ++k) {
    const ChangeOf<ContactLanes<Real>> change =
        visit.template visit<ContactLanes<Real>>(blocks.place(k), beta);
    sum = sum + ChangeOf<Lanes>{in_double(change.step), in_double(change.size)};
  }
  SweepChange total;
  for (int l = 0; l < width; ++l) {
    total.step += sum.step[l];
    total.size += sum.size[l];
  }
  return total;
}

template <class Real, class Visit>
Overlaps correct_over(const Visit& given, Blocks blocks, Real beta) {
  const Visit visit = given;
  Vector deepest{}, sum{}, count{};
  for (std::int64_t k = 0; k < blocks.count; ++k) {
    const Vector gap = in_double(visit.template visit<ContactLanes<Real>>(blocks.place(k), beta));
    const Vector depth = gap < 0 ? -gap : Vector{};
    deepest = depth > deepest ? depth : deepest;
    sum += depth;
    count += depth > 0 ? Lanes::all(1) : Vector{};
  }
  Overlaps total;
  for (int l = 0; l < width; ++l) {
    const auto depth = static_cast<float>(deepest[l]);
    total.deepest = total.deepest > depth ? total.deepest : depth;
    total.sum += sum[l];
    total.count += count[l];
  }
  return total;
}

/// Extrapolates whole records. The inverse mass and inertia in them do not change, since they are equal in
/// `last`.
template <class Real>
void accelerate(const Accelerate<Real>& visit, std::int64_t begin, std::int64_t end, Real beta) {
  using A = ContactLanes<Real>;
  for (std::int64_t k = begin; k < end; ++k) {
    typename A::V& body = A::whole(visit.bodies[k]);
    typename A::V& last = A::whole(visit.last[k]);
    const typename A::V now = body;
    if (beta > 0) body = now + beta * (now - last);
    last = now;
  }
}

template <class Real>
constexpr VisitKernels<Real> visits_in = {.push_balls = push_over<Real, PushBalls<Real>>,
                                          .push_points = push_over<Real, PushPoints<Real>>,
                                          .push_rolling_balls = push_over<Real, PushRollingBalls<Real>>,
                                          .push_rolling_points = push_over<Real, PushRollingPoints<Real>>,
                                          .sweep_balls = sweep_over<Real, SweepBalls<Real>>,
                                          .sweep_points = sweep_over<Real, SweepPoints<Real>>,
                                          .roll_balls = sweep_over<Real, RollBalls<Real>>,
                                          .roll_points = sweep_over<Real, RollPoints<Real>>,
                                          .correct_balls = correct_over<Real, CorrectBalls<Real>>,
                                          .correct_points = correct_over<Real, CorrectPoints<Real>>,
                                          .accelerate = accelerate<Real>};

using Half = simd::SCREE_SIMD::Half;
using VectorOfMasks = decltype(Vector{} > Vector{});
using Three = simd::V3<Lanes>;

using simd::SCREE_SIMD::bits_of;

/// Does the same as Period::nearest(). Adding and subtracting `whole` rounds to a whole number, as rint()
/// does.
SCREE_LAW Vector nearest(const Vector& offset, double length, double per_length) {
  constexpr double whole = 0x1.8p52;
  return offset - length * ((offset * per_length + whole) - whole);
}
SCREE_LAW Three nearest(const Three& offset, const Period* period) {
  if (period == nullptr) return offset;
  const double* const length = period->length.data();
  const double* const per_length = period->per_length.data();
  return {nearest(offset.x, length[0], per_length[0]), nearest(offset.y, length[1], per_length[1]),
          nearest(offset.z, length[2], per_length[2])};
}

std::uint64_t near(const Reach* reach, const Slot* slots, const Period* period) {
  static_assert(sizeof(Reach) == sizeof(Half));
  const Half sign = {-1, -1, -1, 1};
  const auto at = [reach](std::int32_t k) { return *reinterpret_cast<const Half*>(reach + k); };
  std::uint64_t bits = 0;
  for (int first = 0; first < look; first += width) {
    constexpr int half = width / 2;
    Half offset[width];
    for (int l = 0; l < width; ++l) offset[l] = at(slots[first + l].j) + sign * at(slots[first + l].i);
    Vector rows[half];
    for (int l = 0; l < half; ++l)
      rows[l] = __builtin_shufflevector(offset[l], offset[l + half], 0, 1, 2, 3, 4, 5, 6, 7);
    simd::SCREE_SIMD::transpose<half>(rows);
    const Three apart = nearest(Three{rows[0], rows[1], rows[2]}, period);
    const VectorOfMasks is_near = (rows[3] > 0) & (dot(apart, apart) <= rows[3] * rows[3]);
    bits |= std::uint64_t{bits_of(is_near)} << first;
  }
  return bits;
}

static_assert(offsetof(MidBody<double>, size) == 24 && offsetof(MidBody<double>, velocity) == 32);
SCREE_LAW simd::Round<Lanes> round_of(const MidBody<double>* mid, const std::int32_t* at, Three& position) {
  Vector rows[width];
  simd::Round<Lanes> ball;
  for (int l = 0; l < width; ++l) {
    __builtin_memcpy(&rows[l], mid + at[l], sizeof(Vector));
    ball.inverse_mass[l] = mid[at[l]].inverse_mass;
    ball.inverse_inertia[l] = mid[at[l]].inverse_inertia;
  }
  simd::SCREE_SIMD::transpose<width>(rows);
  position = {rows[0], rows[1], rows[2]};
  ball.radius = rows[3];
  ball.velocity = {rows[4], rows[5], rows[6]};
  return ball;
}

SCREE_LAW Three from(const V3<double>* of) {
  Three all;
  for (int l = 0; l < width; ++l) {
    all.x[l] = of[l].x;
    all.y[l] = of[l].y;
    all.z[l] = of[l].z;
  }
  return all;
}

std::uint32_t prepare_balls(const PrepareBalls& given, const BallBlock& block, std::int64_t place) {
  using C = BallContacts<double>;
  const auto& f = given.contacts.fields;
  const auto& gaps = given.contacts.gaps;
  Three x_i, x_j;
  const auto i = round_of(given.mid, block.i, x_i);
  const auto j = round_of(given.mid, block.j, x_j);
  const Vector friction = Lanes::get(block.friction);
  const Three kick = from(block.kick);
  const auto contact = simd::contact_of<Lanes>(nearest(x_j - x_i, given.period), friction, i, j, kick,
                                               given.step, given.noise);
  const auto& law = contact.law;
  const Three start = simd::in_cone<Lanes>(from(block.impulse), law.normal, friction);
  f.put<Lanes>(C::normal, place, law.normal);
  f.put<Lanes>(C::arm_i, place, i.inverse_mass > 0 ? law.arm_i : Vector{});
  f.put<Lanes>(C::arm_j, place, j.inverse_mass > 0 ? law.arm_j : Vector{});
  f.put<Lanes>(C::friction, place, friction);
  f.put<Lanes>(C::target, place, law.target);
  f.put<Lanes>(C::normal_mass, place, law.normal_mass);
  f.put<Lanes>(C::tangent_mass, place, law.tangent_mass);
  f.put<Lanes>(C::impulse, place, start);
  f.put<Lanes>(C::last, place, start);
  const Vector smaller = i.radius < j.radius ? i.radius : j.radius;
  gaps.put<Lanes>(C::gap, place, contact.gap);
  gaps.put<Lanes>(C::predicted_gap, place, contact.gap + 0.125 * given.step * given.step * contact.curvature);
  gaps.put<Lanes>(C::pushed, place, Vector{});
  gaps.put<Lanes>(C::pushed_before, place, Vector{});
  gaps.put<Lanes>(C::cap, place, tolerance::correction_cap * smaller);
  const Vector closing = -dot(law.normal, j.velocity - i.velocity + kick);
  const Vector open = contact.gap > 0 ? contact.gap : Vector{};
  return bits_of(closing * given.step > tolerance::likely_closing * open);
}

SCREE_LAW double sum_of(const Vector& v) {
  double sum = 0;
  for (int l = 0; l < width; ++l) sum += v[l];
  return sum;
}

/// Sets the predicted gaps of the contacts from c on, with the normal velocities after the response (m/s).
/// Returns the overlaps at the end, as shares of their caps.
SCREE_LAW Vector predict_gaps(const AccountBlocks& by, std::int64_t c, const Vector& velocity,
                              const VectorOfMasks& carries) {
  using C = BallContacts<double>;
  Vector gap = by.contacts.gaps.get<Lanes>(C::predicted_gap, c);
  const Vector cap = by.contacts.gaps.get<Lanes>(C::cap, c);
  const std::uint8_t* const flags = by.contacts.flags.data() + c;
  Vector late{}, flying{};
  for (int l = 0; l < width; ++l) {
    late[l] = (flags[l] & flag_late_impact) != 0 ? 1 : 0;
    flying[l] = (flags[l] & flag_flying) != 0 ? 1 : 0;
  }
  const VectorOfMasks passes = (flying > 0) & !carries;
  if (!by.again) gap = late == 0 ? gap + 0.5 * by.step * velocity : gap;
  by.contacts.gaps.put<Lanes>(C::predicted_gap, c, gap);
  return (late == 0) & !passes ? -gap / cap : Vector{};
}

BlockTotals account_balls(const AccountBlocks& given, Blocks blocks) {
  using C = BallContacts<double>;
  const AccountBlocks by = given;
  Vector restitution{}, friction{}, work{}, of_gaps{}, deepest{}, residual_power{}, impulse_power{};
  Vector loaded{}, ends{}, gaining{};
  const Vector one = Lanes::all(1);
  for (std::int64_t k = 0; k < blocks.count; ++k) {
    const std::int64_t c = blocks.place(k);
    const Ends* const at = by.contacts.ends + c;
    const auto balls = balls_at<Lanes>(by.contacts, c);
    const Three p = by.contacts.fields.vector<Lanes>(C::impulse, c);
    const auto after = bodies_of<Lanes>(by.solver, at);
    const Three u = velocity_at(balls, after.i, after.j);
    const auto kicked = bodies_of<Lanes>(by.free, at);
    const Three u_free = velocity_at(balls, kicked.i, kicked.j);
    const auto before = bodies_of<Lanes>(by.before, at);
    const Three u_before = velocity_at(balls, before.i, before.j);
    const Vector pn = dot(p, balls.normal);
    const Vector through_mean = 0.5 * dot(p, u_before + u);
    const Vector normal_part = 0.5 * pn * dot(balls.normal, u_before + u);
    const Vector changed = dot(p, u - u_free);
    const VectorOfMasks carries = (p.x != 0) | (p.y != 0) | (p.z != 0);
    const VectorOfMasks free_i = after.i.inverse_mass > 0, free_j = after.j.inverse_mass > 0;
    const auto arm = [&](const Vector& length, const Three& spin) {
      return cross(spin, length * balls.normal);
    };
    restitution = restitution - normal_part;
    friction = friction - (through_mean - normal_part);
    work = work + (free_i ? Vector{} : dot(p, after.i.velocity + arm(balls.arm_i, after.i.spin)));
    work = work - (free_j ? Vector{} : dot(p, after.j.velocity + arm(balls.arm_j, after.j.spin)));
    residual_power = residual_power + pn * (dot(u, balls.normal) - balls.target);
    impulse_power = impulse_power + changed;
    const Vector square = 0.5 * changed;
    gaining = gaining + ((carries & (through_mean > by.rounding * square)) ? one : Vector{});
    const Vector gap = by.contacts.gaps.get<Lanes>(C::gap, c);
    of_gaps = of_gaps + (carries ? (gap < 0 ? -gap : gap) : Vector{});
    loaded = loaded + (carries ? one : Vector{});
    ends = ends + ((carries & free_i) ? one : Vector{}) + ((carries & free_j) ? one : Vector{});
    const Vector velocity = dot(balls.normal, after.j.velocity - after.i.velocity);
    const Vector depth = predict_gaps(by, c, velocity, carries);
    deepest = depth > deepest ? depth : deepest;
  }
  BlockTotals totals;
  totals.restitution = sum_of(restitution);
  totals.friction = sum_of(friction);
  totals.work = sum_of(work);
  totals.gaps = sum_of(of_gaps);
  totals.residual_power = sum_of(residual_power);
  totals.impulse_power = sum_of(impulse_power);
  totals.loaded = static_cast<std::int64_t>(sum_of(loaded));
  totals.ends = static_cast<std::int64_t>(sum_of(ends));
  totals.gaining = static_cast<std::int64_t>(sum_of(gaining));
  for (int l = 0; l < width; ++l) totals.deepest = deepest[l] > totals.deepest ? deepest[l] : totals.deepest;
  return totals;
}

}  // namespace

extern const ContactKernels contact_kernels = {.in_double = visits_in<double>,
                                               .in_float = visits_in<float>,
                                               .near = near,
                                               .prepare_balls = prepare_balls,
                                               .account_balls = account_balls};

}  // namespace scree::solver::SCREE_SIMD
