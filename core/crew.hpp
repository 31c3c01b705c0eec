// Threads of Host that stand by between short calls: to wake one that sleeps takes longer than most calls
// do.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>

namespace scree::detail {

/// Helpers are tasks of TBB that look out for work, and leave when there has been none for a while. Each
/// thread has a seat, and begins with the range of the work that is its seat's, so that what it has in its
/// cache is what it had there the last time; then it helps others, but leaves them the last chunk of theirs.
/// Who comes late finds the rest or nothing, and nobody waits for a helper that has not come. Where there are
/// more threads than processors, helpers are of no use: work is done alone for a while.
class Crew {
 public:
  /// The one of this process.
  static Crew& get();
  /// Threads that TBB allows here, with the one that asks.
  static int most_threads();

  /// Calls work(begin, end) for ranges that make up n items, in any order and at once, and throws what one
  /// of them has thrown. What is shared out from within work, or while another thread's work is shared out,
  /// is done by the thread that asks.
  template <class Work>
  void share(std::int64_t n, const Work& work) {
    share_phases(
        1, [n](int) { return n; }, [&work](int, std::int64_t begin, std::int64_t end) { work(begin, end); });
  }

  /// The same in phases that wait for one another: work(phase, begin, end), for items(phase) items.
  template <class Items, class Work>
  void share_phases(int phases, const Items& items, const Work& work) {
    run({phases,
         [](const void* of, int phase) -> std::int64_t { return (*static_cast<const Items*>(of))(phase); },
         &items,
         [](const void* of, int phase, std::int64_t begin, std::int64_t end) {
           (*static_cast<const Work*>(of))(phase, begin, end);
         },
         &work});
  }

  /// Before TBB is asked for something: the helpers leave, so that it has its threads.
  void dismiss() { dismissed_.store(true, std::memory_order_relaxed); }

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
  static constexpr int most_seats = 256;
  static constexpr std::int64_t chunks = 4;  // of a range, in each phase
  struct alignas(64) Seat {
    std::atomic<std::int64_t> next{0};     // chunk of its ranges that nobody has taken, over all phases
    std::atomic<std::uint64_t> job{none};  // the last that it has worked on
    std::atomic_flag taken;
  };

  void run(const Job& job);
  void hire(int helpers);
  void help();
  std::chrono::steady_clock::duration work_from(int seat);
  void help_others(int phase, int seat);
  void take_chunks(int phase, int range, std::int64_t leave);

  std::atomic_flag busy_;  // somebody shares work out
  std::chrono::steady_clock::time_point alone_until_{};
  std::uint64_t jobs_ = none;  // so far
  Job job_{};                  // while it is open, and while somebody is inside
  int ranges_ = 1;             // of each of its phases
  std::exception_ptr error_;   // the first that it has thrown
  std::atomic<bool> failed_{false};
  std::atomic<bool> dismissed_{false};
  std::atomic<int> helpers_{0};                        // that are there, or called
  Seat seats_[most_seats];                             // the first is that of who shares work out
  alignas(64) std::atomic<std::uint64_t> open_{none};  // number of the job that is open
  alignas(64) std::atomic<int> inside_{0};             // helpers that may look at it
  alignas(64) std::atomic<std::int64_t> done_{0};      // chunks of the job, over all phases
};

/// Calls work(b, begin, end) for each of `blocks` runs of like length among n items, at once.
template <class Work>
void for_each_block(std::int64_t n, std::int64_t blocks, const Work& work) {
  Crew::get().share(blocks, [&](std::int64_t b, std::int64_t end) {
    for (; b < end; ++b) work(b, n * b / blocks, n * (b + 1) / blocks);
  });
}

}  // namespace scree::detail
