#include "core/thread_pool.hpp"

#include "core/space_pause.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace scree::detail {

namespace {

constexpr auto relaxed = std::memory_order_relaxed;
using Clock = std::chrono::steady_clock;

/// How long a worker spins without a job. Longer than what one thread does alone between the calls of a step.
constexpr std::chrono::microseconds spin_time{200};

/// If a job has waited for its workers longer than this, they have no processor of their own: the caller then
/// works alone for a while.
constexpr std::chrono::microseconds long_wait{500};
constexpr int most_waiting = 4;  // and if the whole job took less than so many times that wait
constexpr std::chrono::milliseconds alone_for{100};

/// Waits for something that another thread is about to do.
class Wait {
 public:
  void operator()() {
    constexpr int soon = 1024;
    if (++waited_ < soon) {
      pause();
    } else {
      if (waited_ == soon) start_ = Clock::now();
      std::this_thread::yield();  // to a thread that has no processor
    }
  }
  /// The time waited, but for the first microseconds.
  Clock::duration lasted() const {
    return start_ == Clock::time_point{} ? Clock::duration{} : Clock::now() - start_;
  }

 private:
  int waited_ = 0;
  Clock::time_point start_{};
};

}  // namespace

ThreadPool& ThreadPool::get() {
  static ThreadPool& pool = *new ThreadPool;  // workers may outlive whatever is destroyed at the end
  return pool;
}

int ThreadPool::most_threads() {
  const auto allowed =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min({allowed, tbb::this_task_arena::max_concurrency(), most_workers});
}

void ThreadPool::run(const Job& job) {
  const auto alone = [&job] {
    for (int phase = 0; phase < job.phases; ++phase) job(phase, 0, job.count(phase));
  };
  const int helpers = most_threads() - 1;
  if (helpers == 0 || busy_.test_and_set(std::memory_order_acquire)) return alone();
  const Clock::time_point start = Clock::now();
  if (start < alone_until_) {
    busy_.clear(std::memory_order_release);
    return alone();
  }
  call_workers(helpers);
  job_ = job;
  ranges_ = helpers + 1;
  done_.store(0, relaxed);
  for (int r = 0; r < ranges_; ++r) workers_[r].next.store(0, relaxed);
  // A worker first counts itself as inside and then reads whether the job is open. The caller first closes
  // the job and then reads whether a worker is inside. These operations have one order for all threads, so at
  // least one of the two sees the other.
  open_.store(++jobs_);
  auto waited = work_as(0);
  open_.store(none);
  Wait wait;
  while (inside_.load() > 0) wait();
  waited += wait.lasted();
  if (waited > long_wait) {
    const Clock::time_point end = Clock::now();
    if (end - start < most_waiting * waited) {
      alone_until_ = end + alone_for;
      release_workers();
    }
  }
  const std::exception_ptr error = std::exchange(error_, nullptr);
  failed_.store(false, relaxed);
  busy_.clear(std::memory_order_release);
  if (error) std::rethrow_exception(error);
}

void ThreadPool::call_workers(int wanted) {
  released_.store(false, relaxed);
  const int missing = wanted - workers_called_.load(relaxed);
  if (missing <= 0) return;
  workers_called_.fetch_add(missing, relaxed);
  tbb::task_arena here{tbb::task_arena::attach{}};
  for (int k = 0; k < missing; ++k) here.enqueue([this] { wait_for_jobs(); });
}

void ThreadPool::wait_for_jobs() {
  constexpr int looks = 16;  // at the job, for each look at the clock
  int worker = 1;
  while (worker < most_workers && workers_[worker].taken.test_and_set(std::memory_order_acquire)) ++worker;
  if (worker < most_workers) {
    std::uint64_t last = none;
    for (auto leave = Clock::now() + spin_time; !released_.load(relaxed) && Clock::now() < leave;) {
      for (int look = 0; look < looks; ++look) {
        const std::uint64_t job = open_.load();
        if (job == none || job == last) {
          pause();
          continue;
        }
        inside_.fetch_add(1);
        if (open_.load() == job) work_as(worker);
        inside_.fetch_sub(1);
        last = job;
        leave = Clock::now() + spin_time;
      }
    }
    workers_[worker].taken.clear(std::memory_order_release);
  }
  workers_called_.fetch_sub(1, relaxed);
}

std::chrono::steady_clock::duration ThreadPool::work_as(int worker) {
  Clock::duration waited{};
  workers_[worker].job.store(jobs_, relaxed);
  for (int phase = 0; phase < job_.phases; ++phase) {
    const std::int64_t all = chunks * ranges_ * (phase + 1);
    take_chunks(phase, worker % ranges_, 0);
    // Reading what others have left slows down their own counting, and most are done soon: so not at once.
    constexpr int looks = 64;
    Wait wait;
    for (int look = 1; done_.load(std::memory_order_acquire) < all; ++look) {
      wait();
      if (look % looks == 0) take_from_others(phase, worker);
    }
    waited += wait.lasted();
  }
  return waited;
}

void ThreadPool::take_from_others(int phase, int worker) {
  for (int r = 1; r < ranges_; ++r) {
    const int range = (worker + r) % ranges_;
    const bool is_there = workers_[range].job.load(relaxed) == jobs_;
    take_chunks(phase, range, is_there ? 1 : 0);
  }
}

/// Takes and does chunks of a range until `leave` of them are left.
void ThreadPool::take_chunks(int phase, int range, std::int64_t leave) {
  const std::int64_t items = job_.count(phase);
  const std::int64_t first = chunks * phase, end = first + chunks - leave;
  std::atomic<std::int64_t>& next = workers_[range].next;
  std::int64_t taken = 0;
  for (std::int64_t chunk = next.load(relaxed); chunk < end;) {
    if (!next.compare_exchange_weak(chunk, chunk + 1, relaxed)) continue;
    ++taken;
    const std::int64_t at = chunks * range + (chunk - first);
    const std::int64_t parts = chunks * ranges_;
    try {
      if (!failed_.load(relaxed)) job_(phase, items * at / parts, items * (at + 1) / parts);
    } catch (...) {
      if (!failed_.exchange(true)) error_ = std::current_exception();
    }
    ++chunk;
  }
  if (taken > 0) done_.fetch_add(taken, std::memory_order_acq_rel);
}

}  // namespace scree::detail
