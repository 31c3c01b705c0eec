// Pairs of balls that may touch, and balls beside planes: their contacts are found and made in lanes, and
// what these carried is remembered by candidate.
#pragma once

#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/lanes/batches.hpp"

#include <cstdint>
#include <vector>

namespace scree {

struct ContactLaws;
struct ResponseParameters;

class BallPairs {
 public:
  /// Takes those of the candidates, which are ordered by (i, j), that are pairs of balls, or a ball and a
  /// plane, of which one is free and the other, if it is not, does not turn. The rest is others(). Impulses
  /// stay with their pairs.
  void take(const ConstBodyView& bodies, ConstView<Pair> candidates, const ContactLaws& laws,
            const ResponseParameters& parameters);
  /// The candidates that are not balls; with pairs of balls of which one is late, if there are any.
  ConstView<Pair> others(ConstView<Pair> candidates, const LateBodies* late);

  /// Finds those whose gap is within their margins (m), but for pairs of which one is late.
  void find(const ConstBodyView& bodies, ConstView<double> margin, const LateBodies* late);
  /// Candidates that touch, ascending; and those of them that carried no impulse.
  const std::vector<std::int32_t>& touching() const { return touching_; }
  const std::vector<std::int32_t>& fresh() const { return fresh_; }

  /// Of candidates; some are nobody with nobody.
  std::int64_t size() const { return pairs_.size(); }
  /// Of a candidate.
  lanes::Two pair(std::int32_t candidate) const { return pairs_.view()[candidate]; }
  Vec3 impulse(std::int64_t candidate) const;
  /// Against rolling, if anything rolls (N m s).
  Vec3 couple(std::int64_t candidate) const;
  /// Where the candidates are, for functors.
  struct Index {
    const lanes::Two* pairs;
    const std::uint8_t* loaded;
    ConstView<std::int64_t> begin[2];

    /// The candidate of two bodies, i < j, or lanes::none.
    SCREE_HD std::int32_t candidate_of(std::int32_t i, std::int32_t j) const {
      for (const ConstView<std::int64_t>& kind : begin) {
        if (kind.size() == 0) continue;
        // A floor may have as many as there are bodies.
        std::int64_t first = kind[i];
        for (std::int64_t last = kind[i + 1]; first < last;) {
          const std::int64_t middle = first + (last - first) / 2;
          if (pairs[middle].j < j) {
            first = middle + 1;
          } else {
            last = middle;
          }
        }
        if (first < kind[i + 1] && pairs[first].j == j) return static_cast<std::int32_t>(first);
      }
      return lanes::none;
    }
    /// False of none.
    SCREE_HD bool is_loaded(std::int32_t candidate) const {
      return candidate != lanes::none && loaded[candidate] != 0;
    }
  };
  Index index() const { return {pairs_.data(), loaded_.data(), {begin_[0].view(), begin_[1].view()}}; }

  void archive(Archive& archive);

  std::int64_t tested() const { return tested_; }
  void set_flying(std::int32_t candidate, bool flying) { flying_.view()[candidate] = flying ? 1 : 0; }
  /// Remembers what a candidate carried (N s).
  void remember(std::int32_t candidate, const Vec3& impulse);
  void remember_couple(std::int32_t candidate, const Vec3& couple);
  /// And what the contacts in the lanes did; what does not touch carries nothing.
  void remember(const lanes::Batches& batches);

  /// Puts into the lanes who touches, with the share given of the impulses remembered.
  void put_into(double warm_start, lanes::Batches& batches) const;
  /// Prepares the making of contacts, at the midpoint before gravity's kick.
  lanes::BallSource source(const BodyView& bodies, double step, const ResponseParameters& parameters);

 private:
  struct SetReach;
  struct LoadBall;
  struct Look;
  struct Put;
  struct Remember;

  bool rolls() const { return rolling_reach_.size() > 0; }

  std::int64_t tested_ = 0;       // candidates that are somebody
  std::int64_t first_plane_ = 0;  // before it pairs of two balls, then of a ball and a plane
  std::int32_t nobody_ = 0;
  Period period_;                       // of the space of source()
  Array<std::int64_t, Host> begin_[2];  // of either kind, those of each first body
  std::vector<Pair> others_, with_late_;
  // Of each body, and of nobody.
  Array<lanes::Reach, Host> reach_;
  Array<lanes::Ball, Host> balls_;
  Array<double, Host> inverse_inertia_;
  Array<lanes::Triple, Host> up_, kick_;
  Array<std::uint64_t, Host> looks_, carried_;  // what touches and what did, a bit each
  std::vector<std::int32_t> touching_, fresh_;
  // Of each candidate; both kinds are filled up with nobody to whole looks.
  Array<lanes::Two, Host> pairs_, last_pairs_;
  Array<double, Host> friction_;
  Array<lanes::Triple, Host> impulse_, last_impulse_;
  Array<double, Host> rolling_reach_;  // empty, as the couples, if nothing rolls
  Array<lanes::Triple, Host> couple_, last_couple_;
  Array<std::uint8_t, Host> loaded_, flying_;
};

}  // namespace scree
