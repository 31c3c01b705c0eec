// Tests that the parts of hubs get their weighted mean velocity, in either space, however many they are.
#include "sim/response/hubs.hpp"

#include "core/parallel.hpp"
#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace scree::solver {
namespace {

template <class Space>
class HubsTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(HubsTest, test::Spaces, test::SpaceName);

struct RunPhase {
  JoinHubs<BodyRecord<double>> join;
  int phase;
  SCREE_HD void operator()(std::int64_t item) const { join(phase, item); }
};

/// Hubs with numbers of parts that need no group, one, several, and groups of groups. In `records` the
/// bodies of all hubs come first, and then the parts of each hub in turn.
struct Hubs {
  std::vector<Hub> hubs;
  std::vector<std::int32_t> hub_of;
  std::vector<double> share;
  std::vector<BodyRecord<double>> records;

  explicit Hubs(const std::vector<std::int32_t>& parts) {
    Random rng(3, 0);
    const auto any = [&rng] {
      return V3<double>{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
    };
    auto first = static_cast<std::int32_t>(parts.size());
    records.resize(parts.size());
    for (const std::int32_t count : parts) {
      const auto hub = static_cast<std::int32_t>(hubs.size());
      hubs.push_back({.body = hub, .first = first, .parts = count});
      first += count;
      std::vector<double> weights;
      double all = 0;
      for (int k = 0; k < count; ++k) all += weights.emplace_back(rng.uniform(0.5, 1.5));
      for (const double weight : weights) {
        hub_of.push_back(hub);
        share.push_back(weight / all);
        BodyRecord<double>& record = records.emplace_back();
        record.velocity = any();
        record.spin = any();
      }
    }
  }

  /// Returns the mean of one number of the parts of a hub.
  template <class Number>
  double mean(const Hub& hub, Number number) const {
    long double sum = 0;
    for (std::int32_t k = 0; k < hub.parts; ++k) {
      const auto part = static_cast<std::size_t>(hub.first + k);
      sum += static_cast<long double>(share[part - hubs.size()]) * number(records[part]);
    }
    return static_cast<double>(sum);
  }
};

TYPED_TEST(HubsTest, AllPartsGetTheMean) {
  for (const std::vector<std::int32_t>& parts : std::vector<std::vector<std::int32_t>>{
           {1}, {2, 64, 65, 129, 1, 3000}, {3, 4096, 1, 9000, 128, 70000}}) {
    const Hubs before(parts);
    Array<Hub, TypeParam> hubs;
    Array<std::int32_t, TypeParam> hub_of;
    Array<double, TypeParam> share;
    Array<BodyRecord<double>, TypeParam> records;
    copy(hubs, before.hubs);
    copy(hub_of, before.hub_of);
    copy(share, before.share);
    copy(records, before.records);
    Array<PartsSum, TypeParam> sums(hub_of.size());
    const JoinHubs<BodyRecord<double>> join{std::as_const(hubs).view(),
                                            std::as_const(hub_of).view(),
                                            std::as_const(share).view(),
                                            static_cast<std::int64_t>(parts.size()),
                                            records.data(),
                                            sums.data()};
    for (int phase = 0; phase < join.phases(); ++phase)
      parallel::for_each<TypeParam>("test.join", join.items(phase), RunPhase{join, phase});
    const std::vector<BodyRecord<double>> after = to_vector(records);
    for (const Hub& hub : before.hubs) {
      const BodyRecord<double>& joined = after[static_cast<std::size_t>(hub.body)];
      EXPECT_NEAR(joined.velocity.x, before.mean(hub, [](const auto& r) { return r.velocity.x; }), 1e-14);
      EXPECT_NEAR(joined.velocity.z, before.mean(hub, [](const auto& r) { return r.velocity.z; }), 1e-14);
      EXPECT_NEAR(joined.spin.y, before.mean(hub, [](const auto& r) { return r.spin.y; }), 1e-14);
      for (std::int32_t k = 0; k < hub.parts; ++k) {
        const BodyRecord<double>& part = after[static_cast<std::size_t>(hub.first + k)];
        ASSERT_EQ(part.velocity.x, joined.velocity.x) << hub.parts << " parts, part " << k;
        ASSERT_EQ(part.spin.z, joined.spin.z) << hub.parts << " parts, part " << k;
      }
    }
  }
}

TYPED_TEST(HubsTest, NothingIsJoinedWithoutHubs) { EXPECT_EQ(JoinHubs<BodyRecord<double>>{}.phases(), 0); }

}  // namespace
}  // namespace scree::solver
