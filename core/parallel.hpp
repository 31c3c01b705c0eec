// Labelled parallel calls in either space: loops and sums (parallel_loops.hpp), scans, selections, moves and
// sorts. This header, and the headers space_*.hpp that it includes, use Thrust: only parallel sources may
// include them.
#pragma once

#include "core/array.hpp"
#include "core/parallel_loops.hpp"
#include "core/space_matches.hpp"
#include "core/space_policy.hpp"
#include "core/timing.hpp"

#include <thrust/copy.h>
#include <thrust/count.h>
#include <thrust/functional.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <thrust/scan.h>

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace scree::parallel {

namespace detail {

template <class T>
struct Widen {
  const T* counts;
  SCREE_HD std::int64_t operator()(std::int64_t i) const { return static_cast<std::int64_t>(counts[i]); }
};

template <class T>
struct Gather {
  const T* from;
  const std::int32_t* index;
  T* to;
  SCREE_HD void operator()(std::int64_t k) const { to[k] = from[index[k]]; }
};

template <class T>
struct Scatter {
  const T* from;
  const std::int32_t* index;
  T* to;
  SCREE_HD void operator()(std::int64_t k) const { to[index[k]] = from[k]; }
};

template <class T>
struct IsNot {
  T none;
  SCREE_HD bool operator()(const T& value) const { return value != none; }
};

}  // namespace detail

/// Sets counts[b] to the number of i, 0 <= i < n, with f(i) = b, for 0 <= b < bins; other values are not
/// counted. f returns int; bins <= 256 is fastest.
template <class Space, class F>
void histogram(const char* label, std::int64_t n, F f, int bins, Array<std::uint32_t, Space>& counts) {
  const timing::Call<Space> call(label);
  counts.resize(bins);
  const auto first = thrust::make_transform_iterator(thrust::counting_iterator<std::int64_t>(0), f);
  scree::detail::histogram(Space{}, first, n, bins, counts.data());
}

/// Replaces values[i] by the largest of values[0..i].
template <class Space, class T>
void running_max(const char* label, Array<T, Space>& values) {
  const timing::Call<Space> call(label);
  thrust::inclusive_scan(scree::detail::policy(Space{}), values.data(), values.data() + values.size(),
                         values.data(), thrust::maximum<T>());
}

/// Sets offsets[i] = counts[0] + ... + counts[i-1] for 0 <= i <= n, in 64 bits. The host does not wait for
/// the result on Device.
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

/// Does the same as exclusive_scan_into(), waits for it, and returns offsets[n].
template <class Space, class T>
std::int64_t exclusive_scan(const char* label, const Array<T, Space>& counts,
                            Array<std::int64_t, Space>& offsets) {
  exclusive_scan_into(label, counts, offsets);
  std::int64_t total = 0;
  copy_bytes<Host, Space>(&total, offsets.data() + counts.size(), sizeof(total));
  return total;
}

/// Collects the f(i), 0 <= i < n, that are not `none`, in their order. On Device f is called more than once
/// for each i.
template <class Space, class T, class F>
void select(const char* label, std::int64_t n, F f, T none, Array<T, Space>& found) {
  if constexpr (std::is_same_v<Space, Host>) {
    // The items are taken block by block, so that f is called once for each.
    constexpr std::int64_t block = 4096;
    std::vector<std::vector<T>> of_block(static_cast<std::size_t>((n + block - 1) / block));
    for_each<Host>(
        label, std::ssize(of_block),
        [&](std::int64_t b) {
          for (std::int64_t i = b * block; i < std::min((b + 1) * block, n); ++i) {
            const T value = f(i);
            if (value != none) of_block[static_cast<std::size_t>(b)].push_back(value);
          }
        },
        2);
    std::int64_t count = 0;
    for (const std::vector<T>& list : of_block) count += std::ssize(list);
    found.resize(count);
    T* to = found.data();
    for (const std::vector<T>& list : of_block) to = std::copy(list.begin(), list.end(), to);
    return;
  }
  const timing::Call<Space> call(label);
  const auto first = thrust::make_transform_iterator(thrust::counting_iterator<std::int64_t>(0), f);
  const detail::IsNot<T> some{none};
  found.resize(thrust::count_if(scree::detail::policy(Space{}), first, first + n, some));
  thrust::copy_if(scree::detail::policy(Space{}), first, first + n, found.data(), some);
}

/// Sets to[k] = from[index[k]]; `to` takes the size of `index`.
template <class Space, class T>
void gather(const char* label, const Array<T, Space>& from, const Array<std::int32_t, Space>& index,
            Array<T, Space>& to) {
  to.resize(index.size());
  parallel::for_each<Space>(label, index.size(), detail::Gather<T>{from.data(), index.data(), to.data()});
}

/// Sets to[index[k]] = from[k]; no two indices may be the same.
template <class Space, class T>
void scatter(const char* label, const Array<T, Space>& from, const Array<std::int32_t, Space>& index,
             Array<T, Space>& to) {
  parallel::for_each<Space>(label, index.size(), detail::Scatter<T>{from.data(), index.data(), to.data()});
}

/// Sorts unsigned keys in which all bits above the lowest `bits` are 0.
template <class Space, class Key>
void sort(const char* label, Array<Key, Space>& keys, int bits = 8 * sizeof(Key)) {
  const timing::Call<Space> call(label);
  Array<Key, Space> spare(keys.size());
  Key* k = keys.data();
  Key* s = spare.data();
  scree::detail::sort_keys(Space{}, k, s, keys.size(), bits);
  if (k != keys.data()) keys.swap(spare);
}

/// Sorts values stably by their unsigned keys, in which all bits above the lowest `bits` are 0.
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
