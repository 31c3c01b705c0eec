// A pool of threads on Host that spin between short calls, because waking a thread that sleeps takes longer
// than most of these calls.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>

namespace scree::detail {

/// The workers are tasks of TBB. They spin while they wait for a job, and leave when there has been none for
/// a while (200 us). Each worker has a number, and begins with the range of the items that has this number,
/// so that its cache still holds the data of the last job. Then it takes chunks from the ranges of others,
/// but leaves each of them its last chunk. A worker that comes late finds the rest or nothing, and the caller
/// waits for no worker that has not come. Where there are more threads than processors, workers do not help:
/// the caller then works alone for a while (100 ms).
class ThreadPool {
 public:
  /// The pool of this process.
  static ThreadPool& get();
  /// Threads that TBB allows here, the caller included.
  static int most_threads();

  /// Calls work(begin, end) for ranges that together are the n items, in any order and at once, and throws
  /// the first exception of a call. A call from within work, or while another thread has a job here, is done
  /// by its caller alone.
  template <class Work>
  void for_ranges(std::int64_t n, const Work& work) {
    for_ranges_in_phases(
        1, [n](int) { return n; }, [&work](int, std::int64_t begin, std::int64_t end) { work(begin, end); });
  }

  /// As for_ranges(), in phases that wait for one another: work(phase, begin, end), for items(phase) items.
  template <class Items, class Work>
  void for_ranges_in_phases(int phases, const Items& items, const Work& work) {
    run({phases,
         [](const void* of, int phase) -> std::int64_t { return (*static_cast<const Items*>(of))(phase); },
         &items,
         [](const void* of, int phase, std::int64_t begin, std::int64_t end) {
           (*static_cast<const Work*>(of))(phase, begin, end);
         },
         &work});
  }

  /// Lets the workers leave. Call it before TBB is asked for something, so that TBB has its threads.
  void release_workers() { released_.store(true, std::memory_order_relaxed); }

 private:
  struct Job {
    int phases;
    std::int64_t (*items_in)(const void* items, int phase);
    const void* items;
    void (*call)(const void* work, int phase, std::int64_t begin, std::int64_t end);
    const void* work;

    std::int64_t count(int phase) const { return items_in(items, phase); }
    void operator()(int phase, std::int64_t begin, std::int64_t end) const {
      if (begin < end) call(work, phase, begin, end);
    }
  };
  static constexpr std::uint64_t none = 0;
  static constexpr int most_workers = 256;
  static constexpr std::int64_t chunks = 4;  // of a range, in each phase
  struct alignas(64) Worker {
    std::atomic<std::int64_t> next{
        0};  // first chunk of its ranges that is not taken, counted over all phases
    std::atomic<std::uint64_t> job{none};  // the last job that it has worked on
    std::atomic_flag taken;                // whether a thread has this number
  };

  void run(const Job& job);
  void call_workers(int wanted);
  void wait_for_jobs();
  std::chrono::steady_clock::duration work_as(int worker);
  void take_from_others(int phase, int worker);
  void take_chunks(int phase, int range, std::int64_t leave);

  std::atomic_flag busy_;  // a thread has a job here
  std::chrono::steady_clock::time_point alone_until_{};
  std::uint64_t jobs_ = none;  // number of the last job
  Job job_{};                  // valid while it is open or a worker is inside
  int ranges_ = 1;             // in each of its phases
  std::exception_ptr error_;   // the first exception of the job
  std::atomic<bool> failed_{false};
  std::atomic<bool> released_{false};
  std::atomic<int> workers_called_{0};                 // workers that are there or have been called
  Worker workers_[most_workers];                       // the first is the caller
  alignas(64) std::atomic<std::uint64_t> open_{none};  // number of the job that is open
  alignas(64) std::atomic<int> inside_{0};             // workers that may read the job
  alignas(64) std::atomic<std::int64_t> done_{0};      // chunks of the job that are done, over all phases
};

/// Calls work(b, begin, end) for each of `blocks` runs of like length among n items, at once.
template <class Work>
void for_each_block(std::int64_t n, std::int64_t blocks, const Work& work) {
  ThreadPool::get().for_ranges(blocks, [&](std::int64_t b, std::int64_t end) {
    for (; b < end; ++b) work(b, n * b / blocks, n * (b + 1) / blocks);
  });
}

}  // namespace scree::detail
