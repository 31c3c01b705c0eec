// Labelled parallel loops and sums in either space. Sums have a fixed tree, so results do not depend on the
// number of threads. On Host they need no Thrust: sources that run on Host alone include this header and stay
// plain C++. A call on Device compiles only where core/parallel.hpp is included as well, which brings
// launch_for_each and launch_reduce.
#pragma once

#include "core/array.hpp"
#include "core/space.hpp"
#include "core/thread_pool.hpp"
#include "core/timing.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace scree::parallel {

/// Number of items below which, on the host, sharing them among threads costs more than the work.
inline constexpr std::int64_t few = 256;

/// Returns whether the host has only one thread to work with.
inline bool is_alone() { return scree::detail::ThreadPool::most_threads() == 1; }

/// Calls f(i) for 0 <= i < n, in any order and concurrently. f is a copyable function object over views; on
/// Device the call returns before the work is done. `label` names the work for a profiler. `fewest` is the
/// least number of items that is worth sharing among threads on the host; it is smaller where each item is
/// much work.
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
      scree::detail::ThreadPool::get().for_ranges(n, run);
    }
  } else {
    launch_for_each(Space{}, n, f);
  }
}

namespace detail {

template <class T>
struct Set {
  T* values;
  T value;
  SCREE_HD void operator()(std::int64_t i) const { values[i] = value; }
};

// Number of items in a leaf of the sum's tree. It fixes the grouping, so changing it changes the last bits.
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
struct Larger {
  SCREE_HD T operator()(const T& a, const T& b) const { return a < b ? b : a; }
};

template <class T>
struct Smaller {
  SCREE_HD T operator()(const T& a, const T& b) const { return b < a ? b : a; }
};

template <class T>
struct Load {
  const T* values;
  SCREE_HD T operator()(std::int64_t i) const { return values[i]; }
};

/// The work of for_each_counted() on one of `threads` threads of Device. The threads of a warp that go
/// different ways work one after the other, so the first items are dealt to one thread of each warp.
template <class F>
struct CountedLoop {
  static constexpr std::int64_t warp = 32;
  static constexpr std::int64_t threads = 1 << 16;  // a GPU holds about as many with much work at once

  const std::uint64_t* count;
  F f;
  SCREE_HD void operator()(std::int64_t thread) const {
    const auto items = static_cast<std::int64_t>(*count);
    const std::int64_t first = thread % warp * (threads / warp) + thread / warp;
    for (std::int64_t k = first; k < items; k += threads) f(k);
  }
};

}  // namespace detail

/// Calls f(k) for 0 <= k < *count, in any order and concurrently. `count` is in the space, so that the host
/// does not wait for it. This is for items with much work each.
template <class Space, class F>
void for_each_counted(const char* label, const std::uint64_t* count, F f) {
  if constexpr (std::is_same_v<Space, Host>) {
    constexpr std::int64_t few_items = 16;
    parallel::for_each<Host>(label, static_cast<std::int64_t>(*count), f, few_items);
  } else {
    parallel::for_each<Space>(label, detail::CountedLoop<F>::threads, detail::CountedLoop<F>{count, f});
  }
}

/// Sets every element to `value`.
template <class Space, class T>
void fill(const char* label, View<T> values, const std::type_identity_t<T>& value) {
  parallel::for_each<Space>(label, values.size(), detail::Set<T>{values.data(), value});
}
template <class Space, class T>
void fill(const char* label, Array<T, Space>& values, const std::type_identity_t<T>& value) {
  parallel::fill<Space>(label, values.view(), value);
}

/// Returns the sum of f(i) over 0 <= i < n, as T with an operator +; T{} for n = 0. The tree of the additions
/// depends on n alone.
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

/// Returns all f(i) for 0 <= i < n joined by `join`, and `neutral` for n = 0. The grouping is not fixed:
/// `join` must be exact, associative and commutative (integers, minima, maxima), or the result would depend
/// on it.
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
    const std::int64_t blocks =
        std::min<std::int64_t>(n / few + 1, 4 * scree::detail::ThreadPool::most_threads());
    std::vector<T> parts(static_cast<std::size_t>(blocks), neutral);
    scree::detail::for_each_block(n, blocks, [&](std::int64_t b, std::int64_t begin, std::int64_t end) {
      parts[static_cast<std::size_t>(b)] = of_range(begin, end);
    });
    T all = neutral;
    for (const T& part : parts) all = join(all, part);
    return all;
  } else {
    return launch_reduce(Space{}, n, f, neutral, join);
  }
}

/// Returns the largest f(i), and `lowest` for n = 0. It is exact, whatever the grouping.
template <class T, class Space, class F>
T max(const char* label, std::int64_t n, F f, T lowest) {
  return reduce<T, Space>(label, n, f, lowest, detail::Larger<T>());
}

/// Returns the smallest f(i), and `highest` for n = 0. It is exact, whatever the grouping.
template <class T, class Space, class F>
T min(const char* label, std::int64_t n, F f, T highest) {
  return reduce<T, Space>(label, n, f, highest, detail::Smaller<T>());
}

}  // namespace scree::parallel
