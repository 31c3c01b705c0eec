// What the rounds of impacts of a flight pass on: predicted meetings and their order, impacts, counts.
#pragma once

#include "sim/impacts/impact.hpp"
#include "sim/observe/observation.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace scree::detail {

/// A predicted meeting.
struct PredictedMeeting {
  double time;        ///< time into the substep (s); infinite: the meeting has come to nothing
  std::int64_t pair;  ///< index in the list of pairs
  std::int32_t part;
  std::uint32_t next_of_wall = 0;  ///< next meeting of the same body, see ImpactProgram::walls_of
};

/// A sort key of pairs, made of their bodies' numbers: it does not depend on the places of the bodies.
struct PairNumbers {
  std::uint64_t bits;

  SCREE_HD static PairNumbers of(BodyNumber i, BodyNumber j) {
    const BodyNumber low = i < j ? i : j;
    const BodyNumber high = i < j ? j : i;
    return {static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high)};
  }
};

/// An impact, and the ledger of what it moved.
struct Resolved {
  Impact impact;
  Ledger moved;
};

/// Returns the bits of a number that is not negative; they are in the order of such numbers.
SCREE_HD inline std::uint64_t ordered_bits(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }

/// The first meeting of a body in one word. Of two such words the smaller one is the earlier meeting: it
/// holds the time, in parts of 2^-32 of the substep, and the number of the partner. Of meetings in the same
/// part, that of the first pair is the smaller one (PairNumbers).
struct FirstMeeting {
  std::uint64_t bits;

  SCREE_HD static FirstMeeting of(double time, double step, BodyNumber partner) {
    const double part = fmin(floor(parts * (time / step)), parts - 2);
    return {static_cast<std::uint64_t>(part) << 32 | static_cast<std::uint64_t>(partner)};
  }
  SCREE_HD bool is_none() const { return bits == ~std::uint64_t{0}; }
  SCREE_HD std::uint64_t part() const { return bits >> 32; }
  /// Returns the time into the substep, rounded down (s).
  SCREE_HD double time(double step) const { return static_cast<double>(part()) / parts * step; }
  SCREE_HD BodyNumber partner() const { return BodyNumber{static_cast<std::int32_t>(bits & 0xffffffffu)}; }

 private:
  static constexpr double parts = 0x1p32;
};

inline constexpr std::uint64_t no_meeting = ~std::uint64_t{0};
inline constexpr std::uint32_t no_impact_group =
    ~std::uint32_t{0};  ///< ImpactProgram::impact_group_of of a body without group

/// The numbers of items that a round has found.
struct RoundCounts {
  std::uint64_t to_search = 0;
  std::uint64_t meetings = 0;
  std::uint64_t with_heavy = 0;  ///< meetings with a body that is heavy to the other
};

/// The first meeting of all. The smallest exact time decides, and among equal times the first pair.
struct FirstOfAll {
  std::uint64_t time = no_meeting, pair = no_meeting;
};

/// The progress of a flight, which its threads share, and which the host reads at the end.
struct ImpactProgress {
  RoundCounts counts[2];          ///< counts of the even rounds and of the odd ones
  FirstOfAll first[2];            ///< first meetings of the even rounds and of the odd ones
  double least_impact_speed = 0;  ///< FlightStage::least_impact_speed; infinite if no pair is faster (m/s)
  bool needs_search = false;      ///< whether the meetings of some body have no closed form
  std::uint64_t fast = 0;         ///< number of pairs that are fast enough for an impact, or of a sample
  std::uint64_t near = 0;         ///< number of pairs that come near each other, before the first round
  std::uint64_t chunks = 0;       ///< number of chunks that this round has listed
  /// Number of ImpactProgram::struck_large_bodies that this round has listed.
  std::uint64_t struck_large_bodies = 0;
  std::uint64_t impacts = 0;
  std::uint64_t struck = 0;       ///< number of struck bodies
  std::uint32_t late_impact = 0;  ///< whether a body was struck after the midpoint
  std::uint32_t hit_bound = 0;
};

/// The state of the rounds.
struct RoundsState {
  /// The reason why the rounds halt: they are at their end; or there is no room in the lists of the first
  /// half; or there is none for the results of the second half, which also needs the pairs of each body
  /// (adjacency).
  enum class Halt : std::uint8_t { none, end, lists, results };

  Halt halt = Halt::none;
  bool resolving = false;  ///< whether the rounds are in the second half
  std::uint32_t round = 1;
  std::int64_t kept = 0;                 ///< number of meetings of the round before
  std::int64_t chunks = 0;               ///< number of chunks of pairs of bodies that were struck in it
  std::int64_t struck_large_bodies = 0;  ///< number of ImpactProgram::struck_large_bodies
  RoundCounts counts;                    ///< counts of this round, once its first half is over
  std::uint64_t fast = 0;                ///< ImpactProgress::fast
};

/// An empty sum, since the phases add up nothing.
struct NoSum {
  SCREE_HD friend NoSum operator+(NoSum, NoSum) { return {}; }
};

/// Some pairs of a body that has been struck: chunk_size entries of its row, from `first` on.
struct StruckPairs {
  std::int32_t body, first;
};

}  // namespace scree::detail
