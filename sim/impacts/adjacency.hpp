// The candidate pairs that each free body is in, as compressed sparse rows.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/candidates.hpp"

#include <cstdint>

namespace scree {

/// A view of an Adjacency, which owns the lists. It is cheap to copy.
struct AdjacencyView {
  /// A body with more pairs than this has many.
  static constexpr std::int64_t most_of_few = 256;

  ConstView<std::int64_t> begin;  ///< start of each body's row, and the end of the last one; empty: no rows
  ConstView<std::int32_t> row;    ///< indices of the pairs, in any order within a row
  ConstView<std::int32_t> between_many;  ///< pairs whose two bodies are both free and have many pairs

  SCREE_HD bool is_empty() const { return begin.size() == 0; }
  SCREE_HD std::int64_t count(std::int32_t body) const { return begin[body + 1] - begin[body]; }
  SCREE_HD bool has_many_pairs(std::int32_t body) const { return count(body) > most_of_few; }
  SCREE_HD std::int32_t pair(std::int32_t body, std::int64_t place) const { return row[begin[body] + place]; }
};

template <class Space>
class Adjacency {
 public:
  /// Builds the rows. The rows of bodies that are not free are empty.
  void build(ConstView<Pair> pairs, ConstView<Mobility> mobility);
  void clear() { begin_.resize(0); }
  AdjacencyView view() const { return {begin_.view(), row_.view(), between_many_.view()}; }

 private:
  Array<std::uint32_t, Space> count_;
  Array<std::int64_t, Space> begin_;
  Array<std::int32_t, Space> row_, between_many_;
};

}  // namespace scree
