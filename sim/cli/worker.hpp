// A thread that works on items in the order in which they are handed to it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace scree::cli {

template <class Item>
class Worker {
 public:
  /// `work` runs on the thread, and is destroyed there once no more items can come. At most `most_waiting`
  /// items wait in the queue.
  Worker(std::size_t most_waiting, std::function<void(Item&)> work)
      : most_waiting_(most_waiting), thread_([this, work = std::move(work)]() mutable {
          run(work);
          work = nullptr;
        }) {}
  /// Drops items that still wait; finish() must be called before, unless something has failed.
  ~Worker() { stop(true); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Hands over an item; waits while there is no room. Throws the exception that the work has thrown.
  void push(Item item) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return items_.size() < most_waiting_ || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    items_.push_back(std::move(item));
    changed_.notify_all();
  }

  /// Waits until everything is done. Throws the exception that the work has thrown.
  void drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return (items_.empty() && !busy_) || failure_; });
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Waits until everything is done; no more items can come. Throws the exception that the work has thrown.
  void finish() {
    stop(false);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void run(const std::function<void(Item&)>& work) {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !items_.empty() || stopping_; });
      if (items_.empty()) return;
      Item item = std::move(items_.front());
      items_.pop_front();
      busy_ = true;
      changed_.notify_all();
      lock.unlock();
      try {
        work(item);
        lock.lock();
        busy_ = false;
        changed_.notify_all();
      } catch (...) {
        lock.lock();
        failure_ = std::current_exception();
        items_.clear();
        changed_.notify_all();
        return;
      }
    }
  }

  void stop(bool give_up) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
      if (give_up) items_.clear();
      changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool stopping_ = false;
  bool busy_ = false;  // whether the thread works on an item, which is no longer in the queue
  std::exception_ptr failure_;
  std::thread thread_;  // declared last, since it uses all the others
};

}  // namespace scree::cli
