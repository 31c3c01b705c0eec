// Which candidate pairs each free body is in: compressed sparse rows.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/candidates.hpp"

#include <cstdint>

namespace scree {

/// Cheap to copy; the lists are an Adjacency's.
struct AdjacencyView {
  /// A body with more pairs than this has many.
  static constexpr std::int64_t most_of_few = 256;

  ConstView<std::int64_t> begin;         ///< of each body's row; one more than bodies, or none
  ConstView<std::int32_t> row;           ///< indices of pairs, in any order
  ConstView<std::int32_t> between_many;  ///< those pairs of which both bodies are free and have many

  SCREE_HD bool is_empty() const { return begin.size() == 0; }
  SCREE_HD std::int64_t count(std::int32_t body) const { return begin[body + 1] - begin[body]; }
  SCREE_HD bool has_many_pairs(std::int32_t body) const { return count(body) > most_of_few; }
  SCREE_HD std::int32_t pair(std::int32_t body, std::int64_t place) const { return row[begin[body] + place]; }
};

template <class Space>
class Adjacency {
 public:
  /// Rows of bodies that are not free are empty.
  void build(ConstView<Pair> pairs, ConstView<Mobility> mobility);
  void clear() { begin_.resize(0); }
  AdjacencyView view() const { return {begin_.view(), row_.view(), between_many_.view()}; }

 private:
  Array<std::uint32_t, Space> count_;
  Array<std::int64_t, Space> begin_;
  Array<std::int32_t, Space> row_, between_many_;
};

}  // namespace scree
