// Labelled parallel calls in either space. Sums have a fixed tree, so results do not depend on the number of
// threads. It and its own headers (space_*.hpp) reach Thrust: for parallel libraries alone.
#pragma once

#include "core/array.hpp"
#include "core/crew.hpp"
#include "core/space_matches.hpp"
#include "core/space_policy.hpp"
#include "core/timing.hpp"

#include <thrust/copy.h>
#include <thrust/count.h>
#include <thrust/extrema.h>
#include <thrust/for_each.h>
#include <thrust/functional.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <thrust/scan.h>
#include <thrust/transform_reduce.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace scree::parallel {

/// Under this many items the cost of sharing them out exceeds the work, on the host.
inline constexpr std::int64_t few = 256;

/// Whether the host has but one thread to work with.
inline bool is_alone() { return scree::detail::Crew::most_threads() == 1; }

/// Calls f(i) for 0 <= i < n, in any order and at once. f is a copyable function object over views; on
/// Device the call returns before the work is done. `label` names the work to a profiler. `fewest`: items
/// worth sharing out, on the host, where each is much work.
template <class Space, class F>
void for_each(const char* label, std::int64_t n, F f, [[maybe_unused]] std::int64_t fewest = few) {
  const timing::Call<Space> call(label);
  if constexpr (std::is_same_v<Space, Host>) {
    const auto run = [&f](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end; ++i) f(i);
    };
    if (n < fewest || is_alone()) {
      run(0, n);
    } else {
      scree::detail::Crew::get().share(n, run);
    }
  } else {
    thrust::for_each_n(scree::detail::policy(Space{}), thrust::counting_iterator<std::int64_t>(0), n, f);
  }
}

namespace detail {

template <class T>
struct Widen {
  const T* counts;
  SCREE_HD std::int64_t operator()(std::int64_t i) const { return static_cast<std::int64_t>(counts[i]); }
};

template <class T>
struct Set {
  T* values;
  T value;
  SCREE_HD void operator()(std::int64_t i) const { values[i] = value; }
};

// Leaves of the sum's tree hold this many items; it fixes the grouping, so changing it changes the last bits.
inline constexpr std::int64_t leaf = 256;

template <class T, class F>
struct SumLeaf {
  F f;
  T* partial;
  std::int64_t n;
  SCREE_HD void operator()(std::int64_t block) const {
    const std::int64_t first = block * leaf;
    const std::int64_t last = first + leaf < n ? first + leaf : n;
    T sum = f(first);
    for (std::int64_t i = first + 1; i < last; ++i) sum = sum + f(i);
    partial[block] = sum;
  }
};

template <class T>
struct IsNot {
  T none;
  SCREE_HD bool operator()(const T& value) const { return value != none; }
};

template <class T>
struct Load {
  const T* values;
  SCREE_HD T operator()(std::int64_t i) const { return values[i]; }
};

}  // namespace detail

/// Sets every element to `value`.
template <class Space, class T>
void fill(const char* label, Array<T, Space>& values, const T& value) {
  parallel::for_each<Space>(label, values.size(), detail::Set<T>{values.data(), value});
}

/// Sum of f(i) over 0 <= i < n, as T with an operator +; T{} for n = 0. The tree of the additions depends on
/// n alone.
template <class T, class Space, class F>
T sum(const char* label, std::int64_t n, F f) {
  if (n <= 0) return T{};
  if constexpr (std::is_same_v<Space, Host>) {
    if (n <= detail::leaf) {
      const timing::Call<Space> call(label);
      T total;
      detail::SumLeaf<T, F>{f, &total, n}(0);
      return total;
    }
  }
  std::int64_t blocks = (n + detail::leaf - 1) / detail::leaf;
  constexpr std::int64_t few_leaves = 2;
  Array<T, Space> partial(blocks);
  parallel::for_each<Space>(label, blocks, detail::SumLeaf<T, F>{f, partial.data(), n}, few_leaves);
  while (blocks > 1) {
    const std::int64_t next = (blocks + detail::leaf - 1) / detail::leaf;
    Array<T, Space> level(next);
    parallel::for_each<Space>(label, next,
                              detail::SumLeaf<T, detail::Load<T>>{{partial.data()}, level.data(), blocks});
    partial.swap(level);
    blocks = next;
  }
  T total;
  copy_bytes<Host, Space>(&total, partial.data(), sizeof(T));
  return total;
}

/// All of f(i) for 0 <= i < n joined by `join`, and `neutral` for n = 0. The grouping is free: `join` must be
/// exact, associative and commutative (integers, minima, maxima), or the result would depend on it.
template <class T, class Space, class F, class Join>
T reduce(const char* label, std::int64_t n, F f, T neutral, Join join) {
  const timing::Call<Space> call(label);
  if constexpr (std::is_same_v<Space, Host>) {
    const auto of_range = [&](std::int64_t begin, std::int64_t end) {
      T all = neutral;
      for (std::int64_t i = begin; i < end; ++i) all = join(all, f(i));
      return all;
    };
    if (n < few || is_alone()) return of_range(0, n);
    const std::int64_t blocks = std::min<std::int64_t>(n / few + 1, 4 * scree::detail::Crew::most_threads());
    std::vector<T> parts(static_cast<std::size_t>(blocks), neutral);
    scree::detail::for_each_block(n, blocks, [&](std::int64_t b, std::int64_t begin, std::int64_t end) {
      parts[static_cast<std::size_t>(b)] = of_range(begin, end);
    });
    T all = neutral;
    for (const T& part : parts) all = join(all, part);
    return all;
  } else {
    const thrust::counting_iterator<std::int64_t> first(0);
    return thrust::transform_reduce(scree::detail::policy(Space{}), first, first + n, f, neutral, join);
  }
}

/// Largest f(i), and `lowest` for n = 0. Exact, whatever the grouping.
template <class T, class Space, class F>
T max(const char* label, std::int64_t n, F f, T lowest) {
  return reduce<T, Space>(label, n, f, lowest, thrust::maximum<T>());
}

/// Smallest f(i), and `highest` for n = 0. Exact, whatever the grouping.
template <class T, class Space, class F>
T min(const char* label, std::int64_t n, F f, T highest) {
  return reduce<T, Space>(label, n, f, highest, thrust::minimum<T>());
}

/// counts[b] = number of i, 0 <= i < n, with f(i) = b, for 0 <= b < bins; other values are not counted. f
/// gives int; bins <= 256 is fastest.
template <class Space, class F>
void histogram(const char* label, std::int64_t n, F f, int bins, Array<std::uint32_t, Space>& counts) {
  const timing::Call<Space> call(label);
  counts.resize(bins);
  const auto first = thrust::make_transform_iterator(thrust::counting_iterator<std::int64_t>(0), f);
  scree::detail::histogram(Space{}, first, n, bins, counts.data());
}

/// values[i] becomes the largest of values[0..i].
template <class Space, class T>
void running_max(const char* label, Array<T, Space>& values) {
  const timing::Call<Space> call(label);
  thrust::inclusive_scan(scree::detail::policy(Space{}), values.data(), values.data() + values.size(),
                         values.data(), thrust::maximum<T>());
}

/// offsets[i] = counts[0] + ... + counts[i-1] for 0 <= i <= n, which nobody waits for. 64-bit throughout.
template <class Space, class T>
void exclusive_scan_into(const char* label, const Array<T, Space>& counts,
                         Array<std::int64_t, Space>& offsets) {
  const std::int64_t n = counts.size();
  offsets.resize(n + 1);
  parallel::for_each<Space>(label, 1, detail::Set<std::int64_t>{offsets.data(), 0});
  const auto first = thrust::make_transform_iterator(thrust::counting_iterator<std::int64_t>(0),
                                                     detail::Widen<T>{counts.data()});
  const timing::Call<Space> call(label);
  thrust::inclusive_scan(scree::detail::policy(Space{}), first, first + n, offsets.data() + 1);
}

/// The same; returns offsets[n].
template <class Space, class T>
std::int64_t exclusive_scan(const char* label, const Array<T, Space>& counts,
                            Array<std::int64_t, Space>& offsets) {
  exclusive_scan_into(label, counts, offsets);
  std::int64_t total = 0;
  copy_bytes<Host, Space>(&total, offsets.data() + counts.size(), sizeof(total));
  return total;
}

/// Those f(i), 0 <= i < n, that are not `none`, in their order. f is asked more than once.
template <class Space, class T, class F>
void select(const char* label, std::int64_t n, F f, T none, Array<T, Space>& found) {
  const timing::Call<Space> call(label);
  if constexpr (std::is_same_v<Space, Host>) {
    if (n < few) {
      found.resize(n);
      std::int64_t count = 0;
      for (std::int64_t i = 0; i < n; ++i) {
        const T value = f(i);
        if (value != none) found.data()[count++] = value;
      }
      found.resize(count);
      return;
    }
  }
  const auto first = thrust::make_transform_iterator(thrust::counting_iterator<std::int64_t>(0), f);
  const detail::IsNot<T> some{none};
  found.resize(thrust::count_if(scree::detail::policy(Space{}), first, first + n, some));
  thrust::copy_if(scree::detail::policy(Space{}), first, first + n, found.data(), some);
}

/// Sorts unsigned keys that hold nothing above their lowest `bits` bits.
template <class Space, class Key>
void sort(const char* label, Array<Key, Space>& keys, int bits = 8 * sizeof(Key)) {
  const timing::Call<Space> call(label);
  Array<Key, Space> spare(keys.size());
  Key* k = keys.data();
  Key* s = spare.data();
  scree::detail::sort_keys(Space{}, k, s, keys.size(), bits);
  if (k != keys.data()) keys.swap(spare);
}

/// Stable sort of values by the lowest `bits` bits of their unsigned keys, which hold nothing above them.
template <class Space, class Key, class Value>
void sort_by_key(const char* label, Array<Key, Space>& keys, Array<Value, Space>& values,
                 int bits = 8 * sizeof(Key)) {
  const timing::Call<Space> call(label);
  Array<Key, Space> spare_keys(keys.size());
  Array<Value, Space> spare_values(values.size());
  Key* k = keys.data();
  Key* sk = spare_keys.data();
  Value* v = values.data();
  Value* sv = spare_values.data();
  scree::detail::sort_pairs(Space{}, k, v, sk, sv, keys.size(), bits);
  if (k != keys.data()) {
    keys.swap(spare_keys);
    values.swap(spare_values);
  }
}

}  // namespace scree::parallel
