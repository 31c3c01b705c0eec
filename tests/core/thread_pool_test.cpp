// Tests of shared work: all of it is done once, phase after phase, with as many threads as are allowed and no
// more, and exceptions come through.
#include "core/thread_pool.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace scree {
namespace {

using detail::ThreadPool;

template <class F>
void with_threads(int threads, const F& f) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(f);
}

TEST(ThreadPool, DoesEveryItemOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    with_threads(threads, [&] {
      EXPECT_EQ(ThreadPool::most_threads(), threads);
      for (const std::int64_t n : {0, 1, 2, 3, 7, 100, 12345}) {
        for (int again = 0; again < 20; ++again) {
          std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
          ThreadPool::get().for_ranges(n, [&](std::int64_t begin, std::int64_t end) {
            ASSERT_LE(0, begin);
            ASSERT_LT(begin, end);
            ASSERT_LE(end, n);
            for (; begin < end; ++begin) ++visits[static_cast<std::size_t>(begin)];
          });
          for (const auto& count : visits) ASSERT_EQ(count, 1) << n;
        }
      }
    });
  }
}

// Each phase reads what the last phase has written at other items.
TEST(ThreadPool, APhaseWaitsForTheLastOne) {
  constexpr int phases = 200;
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] {
      const auto items = [](int phase) { return phase % 3 == 0 ? 1 : 500 + phase; };
      std::vector<std::int64_t> last(1, 1);
      std::vector<std::vector<std::int64_t>> sums;
      for (int p = 0; p < phases; ++p) sums.emplace_back(static_cast<std::size_t>(items(p)), -1);
      ThreadPool::get().for_ranges_in_phases(phases, items, [&](int p, std::int64_t begin, std::int64_t end) {
        const auto& before = p > 0 ? sums[static_cast<std::size_t>(p) - 1] : last;
        for (; begin < end; ++begin) {
          const std::size_t from = before.size() - 1 - static_cast<std::size_t>(begin) % before.size();
          sums[static_cast<std::size_t>(p)][static_cast<std::size_t>(begin)] = before[from] + 1;
        }
      });
      for (int p = 0; p < phases; ++p)
        for (const std::int64_t sum : sums[static_cast<std::size_t>(p)]) ASSERT_EQ(sum, p + 2);
    });
  }
}

/// Returns the threads that have worked, once there are several, or after a second: a helper thread without a
/// free processor comes late.
std::set<std::thread::id> threads_that_came() {
  using Clock = std::chrono::steady_clock;
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (const auto end = Clock::now() + std::chrono::seconds(1); seen.size() < 2 && Clock::now() < end;) {
    ThreadPool::get().for_ranges(64, [&](std::int64_t, std::int64_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
  }
  return seen;
}

TEST(ThreadPool, AsManyThreadsAsAreAllowed) {
  EXPECT_EQ(threads_that_came().size() > 1, ThreadPool::most_threads() > 1);
  with_threads(1, [] { EXPECT_EQ(threads_that_came().size(), 1u); });
}

TEST(ThreadPool, HelpersThatHaveLeftComeAgain) {
  with_threads(2, [] {
    for (int again = 0; again < 3; ++again) {
      EXPECT_EQ(threads_that_came().size(), 2u);
      if (again == 0) ThreadPool::get().release_workers();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

TEST(ThreadPool, WorkWithinWorkIsItsThreads) {
  with_threads(3, [] {
    std::atomic<std::int64_t> sum{0};
    ThreadPool::get().for_ranges(100, [&](std::int64_t begin, std::int64_t end) {
      for (; begin < end; ++begin) {
        const std::thread::id mine = std::this_thread::get_id();
        ThreadPool::get().for_ranges(10, [&](std::int64_t first, std::int64_t last) {
          EXPECT_EQ(std::this_thread::get_id(), mine);
          sum += last - first;
        });
      }
    });
    EXPECT_EQ(sum, 1000);
  });
}

TEST(ThreadPool, TwoThreadsMayShareOutAtOnce) {
  std::atomic<std::int64_t> sum{0};
  const auto share = [&] {
    for (int again = 0; again < 1000; ++again)
      ThreadPool::get().for_ranges(50, [&](std::int64_t begin, std::int64_t end) { sum += end - begin; });
  };
  std::thread other(share);
  share();
  other.join();
  EXPECT_EQ(sum, 2 * 1000 * 50);
}

TEST(ThreadPool, ThrowsWhatWorkHasThrownAndWorksOn) {
  for (const int threads : {1, 2, 4}) {
    with_threads(threads, [] {
      for (int again = 0; again < 20; ++again) {
        const auto fails = [](std::int64_t begin, std::int64_t end) {
          if (begin <= 77 && 77 < end) throw std::runtime_error("77");
        };
        EXPECT_THROW(ThreadPool::get().for_ranges(100, fails), std::runtime_error);
        std::atomic<std::int64_t> sum{0};
        ThreadPool::get().for_ranges(100, [&](std::int64_t begin, std::int64_t end) { sum += end - begin; });
        EXPECT_EQ(sum, 100);
      }
    });
  }
}

}  // namespace
}  // namespace scree
