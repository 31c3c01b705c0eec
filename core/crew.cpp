#include "core/crew.hpp"

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

/// Longer than what one thread does alone between the calls of a step.
constexpr std::chrono::microseconds stand_by{200};

/// Of how long a job's work waited for helpers, as much says that they have no processor: then it is done
/// alone for a while.
constexpr std::chrono::microseconds long_wait{500};
constexpr int most_waiting = 4;  // the job takes no longer than so many times the wait
constexpr std::chrono::milliseconds alone_for{100};

/// Waits for what another thread is about to do.
class Wait {
 public:
  void operator()() {
    constexpr int soon = 1024;
    if (++waited_ < soon) {
      pause();
    } else {
      if (waited_ == soon) start_ = Clock::now();
      std::this_thread::yield();  // to who has no processor
    }
  }
  /// All but what is next to nothing.
  Clock::duration lasted() const {
    return start_ == Clock::time_point{} ? Clock::duration{} : Clock::now() - start_;
  }

 private:
  int waited_ = 0;
  Clock::time_point start_{};
};

}  // namespace

Crew& Crew::get() {
  static Crew& crew = *new Crew;  // helpers may outlive whatever is destroyed at the end
  return crew;
}

int Crew::most_threads() {
  const auto allowed =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return std::min({allowed, tbb::this_task_arena::max_concurrency(), most_seats});
}

void Crew::run(const Job& job) {
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
  hire(helpers);
  job_ = job;
  ranges_ = helpers + 1;
  done_.store(0, relaxed);
  for (int r = 0; r < ranges_; ++r) seats_[r].next.store(0, relaxed);
  // A helper says that it is inside and then looks whether the job is open; here it is closed first, and then
  // looked whether somebody is inside. In one order for all, so that one of both sees the other.
  open_.store(++jobs_);
  auto waited = work_from(0);
  open_.store(none);
  Wait wait;
  while (inside_.load() > 0) wait();
  waited += wait.lasted();
  if (waited > long_wait) {
    const Clock::time_point end = Clock::now();
    if (end - start < most_waiting * waited) {
      alone_until_ = end + alone_for;
      dismiss();
    }
  }
  const std::exception_ptr error = std::exchange(error_, nullptr);
  failed_.store(false, relaxed);
  busy_.clear(std::memory_order_release);
  if (error) std::rethrow_exception(error);
}

void Crew::hire(int helpers) {
  dismissed_.store(false, relaxed);
  const int missing = helpers - helpers_.load(relaxed);
  if (missing <= 0) return;
  helpers_.fetch_add(missing, relaxed);
  tbb::task_arena here{tbb::task_arena::attach{}};
  for (int k = 0; k < missing; ++k) here.enqueue([this] { help(); });
}

void Crew::help() {
  constexpr int looks = 16;  // at the job, for one at the clock
  int seat = 1;
  while (seat < most_seats && seats_[seat].taken.test_and_set(std::memory_order_acquire)) ++seat;
  if (seat < most_seats) {
    std::uint64_t last = none;
    for (auto leave = Clock::now() + stand_by; !dismissed_.load(relaxed) && Clock::now() < leave;) {
      for (int look = 0; look < looks; ++look) {
        const std::uint64_t job = open_.load();
        if (job == none || job == last) {
          pause();
          continue;
        }
        inside_.fetch_add(1);
        if (open_.load() == job) work_from(seat);
        inside_.fetch_sub(1);
        last = job;
        leave = Clock::now() + stand_by;
      }
    }
    seats_[seat].taken.clear(std::memory_order_release);
  }
  helpers_.fetch_sub(1, relaxed);
}

std::chrono::steady_clock::duration Crew::work_from(int seat) {
  Clock::duration waited{};
  seats_[seat].job.store(jobs_, relaxed);
  for (int phase = 0; phase < job_.phases; ++phase) {
    const std::int64_t all = chunks * ranges_ * (phase + 1);
    take_chunks(phase, seat % ranges_, 0);
    // A look at what others have left makes them wait for their own counts: most are done soon.
    constexpr int looks = 64;
    Wait wait;
    for (int look = 1; done_.load(std::memory_order_acquire) < all; ++look) {
      wait();
      if (look % looks == 0) help_others(phase, seat);
    }
    waited += wait.lasted();
  }
  return waited;
}

void Crew::help_others(int phase, int seat) {
  for (int r = 1; r < ranges_; ++r) {
    const int range = (seat + r) % ranges_;
    const bool is_there = seats_[range].job.load(relaxed) == jobs_;
    take_chunks(phase, range, is_there ? 1 : 0);
  }
}

/// All but so many.
void Crew::take_chunks(int phase, int range, std::int64_t leave) {
  const std::int64_t items = job_.count(phase);
  const std::int64_t first = chunks * phase, end = first + chunks - leave;
  std::atomic<std::int64_t>& next = seats_[range].next;
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
