#include "sim/dynamics/ball_pairs.hpp"

#include "core/parallel_loops.hpp"
#include "sim/dynamics/contact_set.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace scree {

namespace {

bool is_late(const LateBodies* late, std::int32_t i, std::int32_t j) {
  return late != nullptr && late->time_of(i, j) > late->now();
}

std::pair<std::int32_t, std::int32_t> place_of(const lanes::Two& pair) { return {pair.i, pair.j}; }

constexpr lanes::Triple none_remembered = {0, 0, 0};

/// Whether a body that is not free, if it is one, stands still or moves without turning.
bool turns_as_ball(const ConstBodyView& bodies, std::int32_t k) {
  return bodies.mobility[k] == Mobility::free || bodies.spin[k].isZero(0);
}

}  // namespace

/// And nobody's, who reaches nobody.
struct BallPairs::SetReach {
  ConstBodyView bodies;
  ConstView<double> margin;
  const LateBodies* late;
  View<lanes::Reach> reach;
  View<lanes::Triple> up;
  void operator()(std::int64_t k) const {
    if (k == bodies.count()) {
      reach[k] = {Vec3::Zero(), -HUGE_VAL};
      up[k] = {0, 0, 0};
      return;
    }
    const bool plane = bodies.shape[k] == Shape::plane;
    const auto body = static_cast<std::int32_t>(k);
    const double extent = plane ? margin[k] : bodies.size[k].x() + margin[k];
    const Vec3 normal = plane ? Vec3(bodies.orientation[k] * Vec3::UnitZ()) : Vec3(Vec3::Zero());
    reach[k] = {bodies.position[k], is_late(late, body, body) ? -HUGE_VAL : extent};
    up[k] = {normal.x(), normal.y(), normal.z()};
  }
};

struct BallPairs::Look {
  const lanes::Reach* reach;
  const lanes::Triple* up;
  const lanes::Two* pairs;
  std::int64_t first_plane;
  const Period* period;
  View<std::uint64_t> looks;
  void operator()(std::int64_t look) const {
    const std::int64_t first = look * lanes::look;
    looks[look] = first < first_plane ? lanes::kernels().touch_balls(reach, pairs + first, period)
                                      : lanes::kernels().touch_planes(reach, up, pairs + first);
  }
};

void BallPairs::take(const ConstBodyView& bodies, ConstView<Pair> candidates, const ContactLaws& laws,
                     const ResponseParameters& parameters) {
  const auto is = [&](std::int32_t k, Shape shape) { return bodies.shape[k] == shape; };
  // 0 and 1: a pair of balls, and a ball with a plane.
  const auto kind_of = [&](const Pair& p) {
    const int balls = is(p.i, Shape::sphere) + is(p.j, Shape::sphere);
    const int planes = is(p.i, Shape::plane) + is(p.j, Shape::plane);
    const bool round = turns_as_ball(bodies, p.i) && turns_as_ball(bodies, p.j);
    return balls + planes < 2 || !round ? 2 : planes;
  };
  std::int64_t counts[3] = {0, 0, 0};
  others_.clear();
  for (const Pair& p : candidates) {
    const int kind = kind_of(p);
    ++counts[kind];
    if (kind == 2) others_.push_back(p);
  }
  const auto whole_looks = [](std::int64_t n) { return (n + lanes::look - 1) / lanes::look * lanes::look; };
  nobody_ = static_cast<std::int32_t>(bodies.count());
  tested_ = counts[0] + counts[1];
  const std::int64_t first[2] = {0, whole_looks(counts[0])};
  const std::int64_t n = first[1] + whole_looks(counts[1]);
  last_pairs_.resize(n);
  std::ranges::fill(last_pairs_.view(), lanes::Two{nobody_, nobody_});
  std::int64_t next[2] = {first[0], first[1]};
  for (const Pair& p : candidates) {
    if (const int kind = kind_of(p); kind < 2) last_pairs_.view()[next[kind]++] = {p.i, p.j};
  }
  last_impulse_.resize(n);
  friction_.resize(n);
  rolling_reach_.resize(parameters.rolling_friction ? n : 0);
  last_couple_.resize(rolling_reach_.size());
  // Both lists are in order: each kind is gone through once.
  std::int64_t old[2] = {0, first_plane_};
  for (std::int64_t k = 0; k < n; ++k) {
    const lanes::Two pair = last_pairs_.view()[k];
    const int kind = k < first[1] ? 0 : 1;
    const std::int64_t end = kind == 0 ? first_plane_ : pairs_.size();
    while (old[kind] < end && place_of(pairs_.view()[old[kind]]) < place_of(pair)) ++old[kind];
    const bool known = old[kind] < end && place_of(pairs_.view()[old[kind]]) == place_of(pair);
    const bool nobody = pair.i == nobody_;
    last_impulse_.view()[k] = known && !nobody ? impulse_.view()[old[kind]] : none_remembered;
    friction_.view()[k] = parameters.friction && !nobody ? laws.between(pair.i, pair.j).friction : 0.0;
    if (!rolls()) continue;
    rolling_reach_.view()[k] = nobody ? 0.0 : laws.rolling_reach(pair.i, pair.j);
    last_couple_.view()[k] = known && !nobody ? couple_.view()[old[kind]] : none_remembered;
  }
  pairs_.swap(last_pairs_);
  impulse_.swap(last_impulse_);
  couple_.swap(last_couple_);
  first_plane_ = first[1];
  loaded_.resize(n);
  flying_.resize(n);
  looks_.resize(n / lanes::look);
  carried_.resize(looks_.size());
  for (std::int64_t k = 0; k < n; ++k) {
    loaded_.view()[k] = impulse(k).isZero(0) ? 0 : 1;
    flying_.view()[k] = 0;
  }
  std::ranges::fill(carried_.view(), ~std::uint64_t{0});
  for (const int kind : {0, 1}) {
    begin_[kind].resize(nobody_ + 1);
    const View<std::int64_t> begin = begin_[kind].view();
    std::ranges::fill(begin, first[kind]);
    for (std::int64_t k = first[kind]; k < next[kind]; ++k) begin[pairs_.view()[k].i + 1] = k + 1;
    for (std::int64_t i = 1; i < begin.size(); ++i) begin[i] = std::max(begin[i], begin[i - 1]);
  }
}

void BallPairs::archive(Archive& archive) {
  archive("tested", tested_);
  archive("first_plane", first_plane_);
  archive("nobody", nobody_);
  archive("begin_of_balls", begin_[0]);
  archive("begin_of_planes", begin_[1]);
  archive("others", others_);
  archive("pairs", pairs_);
  archive("friction", friction_);
  archive("impulse", impulse_);
  archive("rolling_reach", rolling_reach_);
  archive("couple", couple_);
  archive("loaded", loaded_);
  archive("flying", flying_);
  archive("carried", carried_);
  if (archive.is_loading()) looks_.resize(carried_.size());
}

ConstView<Pair> BallPairs::others(ConstView<Pair> candidates, const LateBodies* late) {
  const auto view = [](const std::vector<Pair>& list) {
    return ConstView<Pair>(list.data(), static_cast<std::int64_t>(list.size()));
  };
  if (late == nullptr || pairs_.empty()) return view(others_);
  with_late_.clear();
  auto other = others_.begin();
  for (const Pair& p : candidates) {
    const bool is_other = other != others_.end() && other->i == p.i && other->j == p.j;
    if (is_other) ++other;
    if (is_other || is_late(late, p.i, p.j)) with_late_.push_back(p);
  }
  return view(with_late_);
}

void BallPairs::find(const ConstBodyView& bodies, ConstView<double> margin, const LateBodies* late) {
  touching_.clear();
  fresh_.clear();
  if (pairs_.empty()) return;
  reach_.resize(bodies.count() + 1);
  up_.resize(bodies.count() + 1);
  parallel::for_each<Host>("balls.reach", reach_.size(),
                           SetReach{bodies, margin, late, reach_.view(), up_.view()});
  parallel::for_each<Host>("balls.look", looks_.size(),
                           Look{reach_.data(), up_.data(), pairs_.data(), first_plane_,
                                bodies.period.exists ? &bodies.period : nullptr, looks_.view()});
  for (std::int64_t look = 0; look < looks_.size(); ++look) {
    for (std::uint64_t left = looks_.view()[look]; left != 0; left &= left - 1) {
      const auto k = static_cast<std::int32_t>(look * lanes::look + std::countr_zero(left));
      touching_.push_back(k);
      if (loaded_.view()[k] == 0) fresh_.push_back(k);
    }
  }
}

Vec3 BallPairs::impulse(std::int64_t candidate) const {
  const lanes::Triple& p = impulse_.view()[candidate];
  return {p.x, p.y, p.z};
}

Vec3 BallPairs::couple(std::int64_t candidate) const {
  const lanes::Triple& couple = couple_.view()[candidate];
  return {couple.x, couple.y, couple.z};
}

void BallPairs::remember_couple(std::int32_t candidate, const Vec3& couple) {
  couple_.view()[candidate] = {couple.x(), couple.y(), couple.z()};
}

void BallPairs::remember(std::int32_t candidate, const Vec3& impulse) {
  impulse_.view()[candidate] = {impulse.x(), impulse.y(), impulse.z()};
  loaded_.view()[candidate] = impulse.isZero(0) ? 0 : 1;
}

/// In the order of the candidates, which are side by side here; of the lanes they come to, few are open at
/// once.
struct BallPairs::Put {
  const BallPairs* pairs;
  double warm_start;
  ConstView<std::int32_t> lane_of;
  View<lanes::BallBatch> batches;
  View<lanes::BallParting> partings;
  View<lanes::Rolling> rolling;
  void operator()(std::int64_t place) const {
    const std::int32_t k = pairs->touching_[static_cast<std::size_t>(place)];
    const int l = lane_of[place] % lanes::width;
    lanes::BallBatch& batch = batches[lane_of[place] / lanes::width];
    lanes::BallParting& parting = partings[lane_of[place] / lanes::width];
    const lanes::Two& pair = pairs->pairs_.view()[k];
    const lanes::Triple& impulse = pairs->impulse_.view()[k];
    batch.ends.i[l] = pair.i;
    batch.ends.j[l] = pair.j;
    batch.friction.at[l] = pairs->friction_.view()[k];
    batch.impulse.impulse.x.at[l] = warm_start * impulse.x;
    batch.impulse.impulse.y.at[l] = warm_start * impulse.y;
    batch.impulse.impulse.z.at[l] = warm_start * impulse.z;
    parting.loaded[l] = pairs->loaded_.view()[k];
    parting.flying[l] = parting.loaded[l] != 0 ? 0 : pairs->flying_.view()[k];
    if (!pairs->rolls()) return;
    lanes::Rolling& of = rolling[lane_of[place] / lanes::width];
    const lanes::Triple& couple = pairs->couple_.view()[k];
    of.reach.at[l] = pairs->rolling_reach_.view()[k];
    of.couple.impulse.x.at[l] = warm_start * couple.x;
    of.couple.impulse.y.at[l] = warm_start * couple.y;
    of.couple.impulse.z.at[l] = warm_start * couple.z;
    of.couple.last.x.at[l] = of.couple.impulse.x.at[l];
    of.couple.last.y.at[l] = of.couple.impulse.y.at[l];
    of.couple.last.z.at[l] = of.couple.impulse.z.at[l];
  }
};

void BallPairs::put_into(double warm_start, lanes::Batches& batches) const {
  parallel::for_each<Host>("balls.put", batches.lane_of.size(),
                           Put{this, warm_start, batches.lane_of.view(), batches.balls.view(),
                               batches.partings.view(), batches.ball_rolling.view()});
}

struct BallPairs::Remember {
  BallPairs* pairs;
  ConstView<std::int32_t> lane_of;
  ConstView<lanes::BallBatch> batches;
  ConstView<lanes::Rolling> rolling;
  void operator()(std::int64_t place) const {
    const lanes::LaneVec& p = batches[lane_of[place] / lanes::width].impulse.impulse;
    const int l = lane_of[place] % lanes::width;
    const std::int32_t k = pairs->touching_[static_cast<std::size_t>(place)];
    pairs->remember(k, {p.x.at[l], p.y.at[l], p.z.at[l]});
    if (!pairs->rolls()) return;
    const lanes::LaneVec& couple = rolling[lane_of[place] / lanes::width].couple.impulse;
    pairs->remember_couple(k, {couple.x.at[l], couple.y.at[l], couple.z.at[l]});
  }
};

void BallPairs::remember(const lanes::Batches& batches) {
  if (pairs_.empty()) return;
  for (std::int64_t look = 0; look < looks_.size(); ++look) {
    const std::uint64_t gone = carried_.view()[look] & ~looks_.view()[look];
    for (std::uint64_t left = gone; left != 0; left &= left - 1) {
      const auto k = static_cast<std::int32_t>(look * lanes::look + std::countr_zero(left));
      remember(k, Vec3::Zero());
      if (rolls()) remember_couple(k, Vec3::Zero());
    }
  }
  copy(carried_, looks_);
  if (touching_.empty()) return;
  parallel::for_each<Host>(
      "balls.remember", batches.lane_of.size(),
      Remember{this, batches.lane_of.view(), batches.balls.view(), batches.ball_rolling.view()});
}

/// And nobody's.
struct BallPairs::LoadBall {
  BodyView bodies;
  double step;
  ResponseParameters parameters;
  View<lanes::Ball> balls;
  View<double> inverse_inertia;
  View<lanes::Triple> kick;
  void operator()(std::int64_t k) const {
    if (k == bodies.count()) {
      balls[k] = {Vec3::Zero(), 0, Vec3::Zero(), 0};
      inverse_inertia[k] = 0;
      kick[k] = {0, 0, 0};
      return;
    }
    const bool plane = bodies.shape[k] == Shape::plane;
    balls[k] = {bodies.position[k], plane ? 0.0 : bodies.size[k].x(), bodies.velocity[k],
                bodies.inverse_mass[k]};
    inverse_inertia[k] = bodies.inverse_inertia[k].x();
    const bool free = bodies.mobility[k] == Mobility::free;
    const Vec3 gained = free ? Vec3(step * parameters.acceleration_of(k)) : Vec3(Vec3::Zero());
    kick[k] = {gained.x(), gained.y(), gained.z()};
  }
};

lanes::BallSource BallPairs::source(const BodyView& bodies, double step,
                                    const ResponseParameters& parameters) {
  period_ = bodies.period;
  balls_.resize(bodies.count() + 1);
  inverse_inertia_.resize(bodies.count() + 1);
  kick_.resize(bodies.count() + 1);
  parallel::for_each<Host>(
      "balls.load", balls_.size(),
      LoadBall{bodies, step, parameters, balls_.view(), inverse_inertia_.view(), kick_.view()});
  return {.balls = balls_.data(),
          .inverse_inertia = inverse_inertia_.data(),
          .up = up_.data(),
          .kick = kick_.data(),
          .forces = parameters.acceleration.size() > 0,
          .step = step,
          .noise = 0,
          .period = bodies.period.exists ? &period_ : nullptr};
}

}  // namespace scree
