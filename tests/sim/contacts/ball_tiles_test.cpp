// Tests of contacts of balls as the kernels find and account them, against those found and accounted one by
// one.
#include "sim/contacts/ball_tiles.hpp"

#include "core/rng.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/found_slots.hpp"
#include "sim/response/bodies.hpp"
#include "sim/response/padding.hpp"
#include "tests/sim/impacts/flight_scenes.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace scree::solver {
namespace {

constexpr std::int64_t tile = parallel::tile;
constexpr double rounding = 1e-12;

/// Pairs of balls about to touch, some with a plane and some with a body that is not free, in slots that
/// share no body, and the data from which their contacts are made.
class Crowd {
 public:
  static constexpr int pairs = 600;
  static constexpr std::int64_t tiles = 3;

  explicit Crowd(bool periodic) {
    Random random(5, 0);
    scene_.parameters.gravity = Vec3(0, 0, -9.81);
    scene_.law = {.restitution = 0.3, .friction = 0.4};
    std::vector<Slot> slots(static_cast<std::size_t>(tiles * tile));
    std::vector<BallMemory<double>> memory(slots.size());
    for (std::int32_t k = 0; k < pairs; ++k) {
      const Vec3 at(3.0 * k, 0, 0);
      const double r = random.uniform(0.1, 0.4), other = random.uniform(0.1, 0.4);
      const Vec3 way = vector_in(random, 1).normalized();
      scene_.add(Shape::sphere, Vec3::Constant(r), at, vector_in(random, 1));
      if (k % 7 == 3) {
        scene_.add_plane(way, 0);
        scene_.bodies.position.back() = at - (r + random.uniform(-0.01, 0.04)) * way;
      } else {
        const double image = periodic && k % 3 == 0 ? 3.0 * pairs : 0.0;
        scene_.add(Shape::sphere, Vec3::Constant(other),
                   at + (r + other + random.uniform(-0.01, 0.04)) * way + Vec3(image, 0, 0),
                   vector_in(random, 1), k % 11 != 5);
      }
      // The slots do not fill the last tile.
      slots[static_cast<std::size_t>(k)] = {
          .i = 2 * k, .j = 2 * k + 1, .end_i = 2 * k, .end_j = 2 * k + 1, .candidate = k, .surface = 0};
      if (k % 2 == 0) memory[static_cast<std::size_t>(k)].impulse = v3<double>(random.uniform(0, 1) * way);
    }
    copy_bodies(bodies_, scene_.bodies);
    if (periodic) bodies_.period = period_of(Vec3::Zero(), Vec3(3.0 * pairs, 0, 0));
    copy(law_, std::vector<PairLaw>{scene_.law});
    copy(places_, slots);
    copy(memory_at_start_, memory);
    const std::int64_t n = bodies_.count();
    margin_.assign(static_cast<std::size_t>(n), 0.01);
    mid_.resize(n);
    solver_.resize(n + 1);
    for (std::int64_t k = 0; k < n; ++k)
      LoadBody<double>{view_of(std::as_const(bodies_)),
                       {margin_.data(), n},
                       scene_.parameters,
                       scene_.step,
                       mid_.view(),
                       solver_.view()}(k);
    solver_.view()[n] = {};
    log_.resize(n);
    for (std::int64_t k = 0; k < n; ++k) log_.clock.view()[k] = 0;
  }

  FindStage<double> stage() {
    const FlightTerms terms{.laws = {bodies_.shape.view(), bodies_.size.view(), bodies_.mobility.view(),
                                     bodies_.material.view(), law_.view(), 1},
                            .step = scene_.step,
                            .from = 0,
                            .bounces = true};
    return {.places = std::as_const(places_).view(),
            .mid = std::as_const(mid_).view(),
            .bodies = view_of(std::as_const(bodies_)),
            .solver = std::as_const(solver_).view(),
            .laws = terms.laws,
            .parameters = scene_.parameters,
            .step = scene_.step,
            .scale = 0.5,
            .noise = 1e-6,
            .struck = {FlightStage(terms, scene_.parameters, view_of(bodies_), log_)},
            .any_late_impact = false};
  }

  /// The contacts that were found, and the memory that is left.
  struct Found {
    ContactStore<Host, double> store;
    Array<BallMemory<double>, Host> memory;
    std::vector<std::int32_t> approaching;
  };
  enum class How { kernels, one_by_one, one_by_one_without_rare };
  template <How how>
  Found find() {
    constexpr bool by_kernels = how == How::kernels;
    using Find = FindBalls<double, how != How::one_by_one_without_rare>;
    Found found;
    copy(found.memory, memory_at_start_);
    std::vector<std::int32_t> approaching(static_cast<std::size_t>(tiles * tile));
    std::uint64_t count = 0;
    Find one_by_one{
        stage(), {}, found.memory.view(), solver_.view(), {{approaching.data(), tiles * tile}, &count}};
    Array<Reach, Host> reach(bodies_.count() + 1);
    for (std::int64_t k = 0; k < reach.size(); ++k) SetReach{stage(), reach.data() + 1}(k);
    FoundSlots<Host> slots;
    slots.start(tiles);
    if constexpr (by_kernels) {
      for (std::int64_t t = 0; t < tiles; ++t)
        FindBallTile{one_by_one, reach.data() + 1, slots.places(), slots.counts()}(t);
    } else {
      parallel::compact_tiles<Host>("test", tiles, FindSlots<Find>{one_by_one, slots.places()},
                                    slots.counts());
    }
    slots.join();
    // The contacts share no body, so that one colour holds them.
    ColorRanges one_color;
    one_color.add(slots.all().size());
    found.store.take_balls(one_color);
    one_by_one.contacts = found.store.balls();
    for (std::int64_t c = 0; c < one_color.places(); ++c)
      one_by_one.contacts.slot[c] = c < slots.all().size() ? slots.all()[c] : Slot::empty;
    if constexpr (by_kernels) {
      for (std::int64_t b = 0; b < one_color.places() / simd::width; ++b)
        MakeBallBlock{one_by_one, reach.data() + 1}(b);
    } else {
      for (std::int64_t c = 0; c < one_color.places(); ++c) MakeContacts<Find>{one_by_one}(c);
    }
    approaching.resize(static_cast<std::size_t>(count));
    std::ranges::sort(approaching);
    found.approaching = approaching;
    return found;
  }

  const Array<BodyRecord<double>, Host>& solver() const { return solver_; }
  const Array<Slot, Host>& places() const { return places_; }
  ConstBodyView bodies() const { return view_of(std::as_const(bodies_)); }
  const ResponseParameters& parameters() const { return scene_.parameters; }
  double step() const { return scene_.step; }

 private:
  FlightScene scene_;
  Bodies<Host> bodies_;
  Array<PairLaw, Host> law_;
  Array<Slot, Host> places_;
  Array<BallMemory<double>, Host> memory_at_start_;
  std::vector<double> margin_;
  Array<MidBody<double>, Host> mid_;
  Array<BodyRecord<double>, Host> solver_;
  FlightLog<Host> log_;
};

TEST(BallTiles, FindWhatIsFoundOneByOne) {
  using C = BallContacts<double>;
  for (const bool periodic : {false, true}) {
    Crowd crowd(periodic);
    auto kernels = crowd.find<Crowd::How::kernels>(), one_by_one = crowd.find<Crowd::How::one_by_one>();
    const C a = kernels.store.balls(), b = one_by_one.store.balls();
    EXPECT_EQ(kernels.approaching, one_by_one.approaching);
    EXPECT_GT(kernels.approaching.size(), 5u);
    const std::int64_t found = kernels.store.ball_colors().contacts();
    ASSERT_EQ(found, one_by_one.store.ball_colors().contacts());
    for (std::int64_t c = 0; c < found; ++c) {
      ASSERT_EQ(a.slot[c], b.slot[c]);
      ASSERT_EQ(a.flags[c], b.flags[c]);
      ASSERT_EQ(a.ends[c].i, b.ends[c].i);
      ASSERT_EQ(a.ends[c].j, b.ends[c].j);
      for (int field = 0; field < C::count; ++field)
        ASSERT_NEAR(a.fields.at(field, c), b.fields.at(field, c), rounding)
            << c << " " << field << " slot " << a.slot[c];
      for (int field = 0; field < C::gap_count; ++field)
        ASSERT_NEAR(a.gaps.at(field, c), b.gaps.at(field, c), rounding) << c << " " << field;
    }
    EXPECT_GT(found, 200);
    EXPECT_LT(found, Crowd::pairs - 100);
    for (std::int64_t k = 0; k < kernels.memory.size(); ++k)
      ASSERT_EQ(is_zero(kernels.memory.view()[k].impulse), is_zero(one_by_one.memory.view()[k].impulse)) << k;
  }
}

/// No slot of the crowd is rare, so the search without rare slots finds and makes the same, to the last bit.
TEST(BallTiles, RareSlotsAreLeftOutWhereThereAreNone) {
  using C = BallContacts<double>;
  Crowd crowd(true);
  auto all = crowd.find<Crowd::How::one_by_one>(), plain = crowd.find<Crowd::How::one_by_one_without_rare>();
  const C a = all.store.balls(), b = plain.store.balls();
  EXPECT_EQ(all.approaching, plain.approaching);
  ASSERT_EQ(a.slot.size(), b.slot.size());
  for (std::int64_t c = 0; c < all.store.ball_colors().contacts(); ++c) {
    ASSERT_EQ(a.slot[c], b.slot[c]);
    ASSERT_EQ(a.flags[c], b.flags[c]);
    for (int field = 0; field < C::count; ++field)
      ASSERT_EQ(a.fields.at(field, c), b.fields.at(field, c)) << c << " " << field;
    for (int field = 0; field < C::gap_count; ++field)
      ASSERT_EQ(a.gaps.at(field, c), b.gaps.at(field, c)) << c << " " << field;
  }
}

TEST(BallTiles, AccountWhatIsAccountedOneByOne) {
  using C = BallContacts<double>;
  Crowd crowd(false);
  auto kernels = crowd.find<Crowd::How::kernels>(), one_by_one = crowd.find<Crowd::How::kernels>();
  Random random(8, 0);
  Array<BodyRecord<double>, Host> before, after;
  copy(before, crowd.solver());
  copy(after, crowd.solver());
  const std::int64_t padding_body = crowd.bodies().count();
  for (std::int64_t k = 0; k < padding_body; ++k) {
    before.view()[k].velocity = v3<double>(crowd.bodies().velocity[k]);
    before.view()[k].spin = v3<double>(crowd.bodies().spin[k]);
    if (after.view()[k].inverse_mass == 0) continue;
    after.view()[k].velocity = after.view()[k].velocity + v3<double>(vector_in(random, 0.1));
    after.view()[k].spin = v3<double>(vector_in(random, 0.1));
  }
  const std::int64_t contacts = kernels.store.ball_colors().contacts();
  for (auto* found : {&kernels, &one_by_one}) {
    for (std::int64_t b = 0; b < kernels.store.ball_colors().places() / simd::width; ++b)
      PadBalls<double>{found->store.balls(), {}, false, static_cast<std::int32_t>(padding_body)}(b);
  }
  const AccountStage<double> stage{std::as_const(crowd.places()).view(),
                                   crowd.bodies(),
                                   crowd.solver().view(),
                                   std::as_const(after).view(),
                                   crowd.parameters(),
                                   crowd.step(),
                                   {}};
  ContactTotals expected;
  const AccountBalls<double> account{stage, one_by_one.store.balls(), one_by_one.memory.view()};
  for (std::int64_t c = 0; c < contacts; ++c) expected = expected + account(c);
  std::vector<std::uint32_t> loads(Crowd::pairs / 4 + 1);
  AccountStage<double> with_loads = stage;
  with_loads.loads = {loads.data(), std::ssize(loads)};
  const AccountBallBlocks blocks{.account = {.contacts = kernels.store.balls(),
                                             .before = before.data(),
                                             .free = crowd.solver().data(),
                                             .solver = after.data(),
                                             .step = crowd.step(),
                                             .rounding = response_gain<double>,
                                             .again = false},
                                 .stage = with_loads,
                                 .memory = kernels.memory.view()};
  ContactTotals got;
  for (std::int64_t run = 0; run < blocks.runs(); ++run) got = got + blocks(run);
  EXPECT_NEAR(got.restitution, expected.restitution, 1e-10);
  EXPECT_NEAR(got.friction, expected.friction, 1e-10);
  EXPECT_NEAR(got.work, expected.work, 1e-10);
  EXPECT_NEAR(got.gaps, expected.gaps, 1e-10);
  EXPECT_NEAR(got.residual_power, expected.residual_power, 1e-10);
  EXPECT_NEAR(got.impulse_power, expected.impulse_power, 1e-10);
  EXPECT_NEAR(got.deepest, expected.deepest, 1e-12);
  EXPECT_EQ(got.loaded, expected.loaded);
  EXPECT_EQ(got.ends, expected.ends);
  EXPECT_EQ(got.gaining, expected.gaining);
  EXPECT_GT(got.gaining, 0);
  EXPECT_GT(got.loaded, 50);
  for (std::int64_t c = 0; c < contacts; ++c) {
    ASSERT_NEAR(kernels.store.balls().gaps.at(C::predicted_gap, c),
                one_by_one.store.balls().gaps.at(C::predicted_gap, c), rounding);
    const std::int32_t place = kernels.store.balls().slot[c];
    const bool loaded = kernels.memory.view()[place].is_loaded();
    ASSERT_EQ(loaded, one_by_one.memory.view()[place].is_loaded());
    const auto candidate = static_cast<std::size_t>(crowd.places().view()[place].candidate);
    ASSERT_EQ((loads[candidate / 4] >> (8 * (candidate % 4)) & 1) != 0, loaded);
  }
}

}  // namespace
}  // namespace scree::solver
