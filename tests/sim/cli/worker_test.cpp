#include "sim/cli/worker.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <semaphore>
#include <vector>

namespace scree::cli {
namespace {

TEST(Worker, DoesEverythingInOrder) {
  std::vector<int> done;
  Worker<int> worker(2, [&](int& item) { done.push_back(item); });
  for (int k = 0; k < 100; ++k) worker.push(k);
  worker.finish();
  ASSERT_EQ(done.size(), 100u);
  for (int k = 0; k < 100; ++k) EXPECT_EQ(done[static_cast<std::size_t>(k)], k);
}

TEST(Worker, PushWaitsWhileThereIsNoRoom) {
  std::counting_semaphore<> go(0);
  std::atomic<int> begun = 0;
  std::atomic<int> pushed = 0;
  Worker<int> worker(2, [&](int&) {
    ++begun;
    go.acquire();
  });
  std::thread pusher([&] {
    for (int k = 0; k < 10; ++k) {
      worker.push(k);
      ++pushed;
    }
  });
  while (pushed < 3) std::this_thread::yield();
  // One in work and two that wait: there is no room for a fourth, however long it takes.
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(pushed, 3);
  go.release(10);
  pusher.join();
  worker.finish();
  EXPECT_EQ(begun, 10);
}

TEST(Worker, CarriesAFailureOverAndStops) {
  std::atomic<int> done = 0;
  Worker<int> worker(2, [&](int& item) {
    if (item == 3) throw RunError("no room");
    ++done;
  });
  EXPECT_THROW(
      {
        for (int k = 0; k < 100; ++k) worker.push(k);
      },
      RunError);
  EXPECT_THROW(worker.finish(), RunError);
  EXPECT_EQ(done, 3);
}

TEST(Worker, EndsWithoutFinish) {
  std::atomic<int> done = 0;
  {
    Worker<int> worker(8, [&](int&) { ++done; });
    for (int k = 0; k < 5; ++k) worker.push(k);
  }
  EXPECT_LE(done, 5);
}

TEST(Worker, DestroysItsWorkOnTheThread) {
  std::thread::id destroyed_on, ran_on;
  const auto note = [&](int*) { destroyed_on = std::this_thread::get_id(); };
  Worker<int> worker(
      2, [&, held = std::shared_ptr<int>(nullptr, note)](int&) { ran_on = std::this_thread::get_id(); });
  worker.push(1);
  worker.finish();
  EXPECT_EQ(destroyed_on, ran_on);
  EXPECT_NE(ran_on, std::this_thread::get_id());
}

}  // namespace
}  // namespace scree::cli
