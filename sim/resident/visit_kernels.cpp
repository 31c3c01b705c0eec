// Compiled once for each instruction set, as dynamics/lanes/kernels.cpp; SCREE_LANES names it.
#include "sim/resident/visit_kernels.hpp"

#include "sim/dynamics/lanes/kernels/vectors.hpp"

namespace scree::resident::SCREE_LANES {

namespace {

using Vectors = lanes::SCREE_LANES::Lanes;
using Vector = Vectors::V;
constexpr int width = lanes::width;

static_assert(sizeof(BodyRecord<double>) == sizeof(Vector));
static_assert(sizeof(CentreRecord<double>) == sizeof(Vector) / 2);

/// What visits ask of an arithmetic beside what the laws do (Scalar).
struct Lanes : Vectors {
  using Real = double;
  static constexpr int width = lanes::width;

  SCREE_LAW static V all(double a) { return a - V{}; }
  SCREE_LAW static V get(const double* from) { return *reinterpret_cast<const V*>(from); }
  SCREE_LAW static void set(double* to, const V& value) { *reinterpret_cast<V*>(to) = value; }
  SCREE_LAW static std::int32_t most(const std::int32_t* of) {
    std::int32_t most = 0;
    for (int l = 0; l < width; ++l) most = of[l] > most ? of[l] : most;
    return most;
  }

  template <End end>
  SCREE_LAW static lanes::Moving<Lanes> bodies(const BodyRecord<double>* from, const Ends* ends) {
    V rows[width];
    for (int l = 0; l < width; ++l) rows[l] = reinterpret_cast<const V&>(from[body_at<end>(ends[l])]);
    lanes::SCREE_LANES::transpose<width>(rows);
    return {{rows[0], rows[1], rows[2]}, rows[3], {rows[4], rows[5], rows[6]}, rows[7]};
  }
  template <End end>
  SCREE_LAW static lanes::Centre<Lanes> bodies(const CentreRecord<double>* from, const Ends* ends) {
    V rows[half];
    for (int l = 0; l < half; ++l) {
      rows[l] = __builtin_shufflevector(half_of(from[body_at<end>(ends[l])]),
                                        half_of(from[body_at<end>(ends[l + half])]), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    lanes::SCREE_LANES::transpose<half>(rows);
    return {{rows[0], rows[1], rows[2]}, rows[3]};
  }
  template <End end>
  SCREE_LAW static void put(const lanes::Moving<Lanes>& from, BodyRecord<double>* to, const Ends* ends) {
    V rows[width] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass,
                     from.spin.x,     from.spin.y,     from.spin.z,     from.inverse_inertia};
    lanes::SCREE_LANES::transpose<width>(rows);
    for (int l = 0; l < width; ++l) {
      BodyRecord<double>& body = to[body_at<end>(ends[l])];
      if (body.inverse_mass > 0) whole(body) = rows[l];
    }
  }
  template <End end>
  SCREE_LAW static void put(const lanes::Centre<Lanes>& from, CentreRecord<double>* to, const Ends* ends) {
    V rows[half] = {from.velocity.x, from.velocity.y, from.velocity.z, from.inverse_mass};
    lanes::SCREE_LANES::transpose<half>(rows);
    for (int l = 0; l < half; ++l) {
      CentreRecord<double>& low = to[body_at<end>(ends[l])];
      CentreRecord<double>& high = to[body_at<end>(ends[l + half])];
      if (low.inverse_mass > 0) half_of(low) = __builtin_shufflevector(rows[l], rows[l], 0, 1, 2, 3);
      if (high.inverse_mass > 0) half_of(high) = __builtin_shufflevector(rows[l], rows[l], 4, 5, 6, 7);
    }
  }

  SCREE_LAW static V& whole(BodyRecord<double>& body) { return reinterpret_cast<V&>(body); }

 private:
  static constexpr int half = width / 2;
  using Half = lanes::SCREE_LANES::Half;

  SCREE_LAW static const Half& half_of(const CentreRecord<double>& body) {
    return reinterpret_cast<const Half&>(body);
  }
  SCREE_LAW static Half& half_of(CentreRecord<double>& body) { return reinterpret_cast<Half&>(body); }
};

// Each has a copy of the visit, which what it writes cannot change.
template <class Visit>
void push_over(const Visit& given, Blocks blocks) {
  const Visit visit = given;
  for (std::int64_t k = 0; k < blocks.count; ++k) visit.template visit<Lanes>(blocks.places[k]);
}

template <class Visit>
SweepChange<double> sweep_over(const Visit& given, Blocks blocks, double beta) {
  const Visit visit = given;
  ChangeOf<Lanes> sum;
  for (std::int64_t k = 0; k < blocks.count; ++k)
    sum = sum + visit.template visit<Lanes>(blocks.places[k], beta);
  SweepChange<double> total;
  for (int l = 0; l < width; ++l) {
    total.step += sum.step[l];
    total.size += sum.size[l];
  }
  return total;
}

template <class Visit>
Overlaps part_over(const Visit& given, Blocks blocks) {
  const Visit visit = given;
  Vector deepest{}, sum{}, count{};
  for (std::int64_t k = 0; k < blocks.count; ++k) {
    const Vector gap = visit.template visit<Lanes>(blocks.places[k]);
    const Vector depth = gap < 0 ? -gap : Vector{};
    deepest = depth > deepest ? depth : deepest;
    sum += depth;
    count += depth > 0 ? Lanes::all(1) : Vector{};
  }
  Overlaps total;
  for (int l = 0; l < width; ++l) {
    const auto depth = static_cast<float>(deepest[l]);
    total.deepest = total.deepest > depth ? total.deepest : depth;
    total.sum += static_cast<float>(sum[l]);
    total.count += static_cast<float>(count[l]);
  }
  return total;
}

/// Inverse mass and inertia stay: they are those of the last.
void accelerate(const Accelerate<double>& visit, std::int64_t begin, std::int64_t end, double beta) {
  for (std::int64_t k = begin; k < end; ++k) {
    Vector& body = Lanes::whole(visit.bodies[k]);
    Vector& last = Lanes::whole(visit.last[k]);
    const Vector now = body;
    if (beta > 0) body = now + beta * (now - last);
    last = now;
  }
}

}  // namespace

extern const VisitKernels visit_kernels = {.push_balls = push_over<PushBalls<double>>,
                                           .push_points = push_over<PushPoints<double>>,
                                           .push_rolling_balls = push_over<PushRollingBalls>,
                                           .push_rolling_points = push_over<PushRollingPoints>,
                                           .sweep_balls = sweep_over<SweepBalls<double>>,
                                           .sweep_points = sweep_over<SweepPoints<double>>,
                                           .roll_balls = sweep_over<RollBalls>,
                                           .roll_points = sweep_over<RollPoints>,
                                           .part_balls = part_over<PartBalls<double>>,
                                           .part_points = part_over<PartPoints<double>>,
                                           .accelerate = accelerate};

}  // namespace scree::resident::SCREE_LANES
