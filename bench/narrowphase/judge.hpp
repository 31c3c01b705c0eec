// The comparison of the narrow phase's answers with long double (oracle.hpp).
#pragma once

#include "bench/narrowphase/families.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/libccd.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace scree::bench {

inline constexpr int most_parts = 3;

/// A pair, its margin, and the gap of each of its surfaces (Manifold::part).
struct Item {
  oracle::SolidPair pair;
  double margin;
  std::array<double, most_parts> gap;    ///< infinite if there can be no contact
  std::array<bool, most_parts> certain;  ///< false if rounding decides whether there can be a contact
};

struct Answer {
  int count = 0;
  std::array<Manifold, max_pair_manifolds> manifolds;
};

/// The results of one method in one family.
struct Row {
  std::int64_t pairs = 0, touching = 0, missed = 0, made_up = 0, not_finite = 0;
  std::int64_t ccd_calls = 0, ccd_refused = 0, ccd_stopped = 0, ccd_hung = 0;
  double error = 0, given_away = 0;
  std::vector<double> nanoseconds;
  std::int64_t broken = 0;           ///< pairs that broke a bound
  std::vector<std::uint64_t> which;  ///< numbers of the first such pairs
};

/// Set the true gaps from the pair and the margin.
void find_truth(oracle::Family family, Item& item);
void find_truth(oracle::ClosedForm form, Item& item);

/// Adds the answer to pair `n` to the row. `of_boxes` says that the pair is two boxes, tested by libccd's
/// method or by the 15 axes alone.
void judge(const Item& item, const Answer& answer, std::uint64_t n, bool of_boxes,
           std::optional<libccd::Method> method, Row& row);

}  // namespace scree::bench
