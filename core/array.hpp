// Owned and borrowed arrays in either space. Owners cannot be copied by accident; kernels take views.
#pragma once

#include "core/space.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {

/// A borrowed range: pointer and count, usable in kernels. T may be const.
template <class T>
class View {
 public:
  View() = default;
  SCREE_HD View(T* data, std::int64_t size) : data_(data), size_(size) {}
  /// A view that may be written converts to one that may only be read.
  template <class U>
  requires std::is_same_v<const U, T> SCREE_HD View(const View<U>& other)
      : data_(other.data()), size_(other.size()) {}

  SCREE_HD T& operator[](std::int64_t i) const { return data_[i]; }
  SCREE_HD T* data() const { return data_; }
  SCREE_HD std::int64_t size() const { return size_; }
  SCREE_HD T* begin() const { return data_; }
  SCREE_HD T* end() const { return data_ + size_; }

 private:
  T* data_ = nullptr;
  std::int64_t size_ = 0;
};

template <class T>
using ConstView = View<const T>;

/// Uninitialised storage of `size` elements in a space. It grows geometrically and never shrinks its
/// capacity, so that a step in the steady state does not allocate. Elements are moved as bytes.
template <class T, class Space>
class Array {
 public:
  Array() = default;
  explicit Array(std::int64_t n) { resize(n); }
  Array(Array&& other) noexcept { swap(other); }
  Array& operator=(Array&& other) noexcept {
    swap(other);
    return *this;
  }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  ~Array() { Space::deallocate(data_); }

  /// Changes the size; the contents are lost when the storage has to grow.
  void resize(std::int64_t n) {
    if (n > capacity_) {
      const std::int64_t grown = std::max(n, capacity_ + capacity_ / 2);
      Space::deallocate(data_);
      data_ = nullptr;
      capacity_ = size_ = 0;
      data_ = static_cast<T*>(Space::allocate(static_cast<std::size_t>(grown) * sizeof(T)));
      capacity_ = grown;
    }
    size_ = n;
  }

  T* data() { return data_; }
  const T* data() const { return data_; }
  std::int64_t size() const { return size_; }
  /// Number of elements that there is storage for.
  std::int64_t capacity() const { return capacity_; }
  bool empty() const { return size_ == 0; }
  View<T> view() { return {data_, size_}; }
  ConstView<T> view() const { return {data_, size_}; }
  void swap(Array& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  T* data_ = nullptr;
  std::int64_t size_ = 0;
  std::int64_t capacity_ = 0;
};

/// These named copies are the only way in which data moves between spaces. `to` takes the size of `from`.
template <class T, class To, class From>
void copy(Array<T, To>& to, const Array<T, From>& from) {
  to.resize(from.size());
  copy_bytes<To, From>(to.data(), from.data(), static_cast<std::size_t>(from.size()) * sizeof(T));
}
template <class T, class To>
void copy(Array<T, To>& to, const std::vector<T>& from) {
  to.resize(static_cast<std::int64_t>(from.size()));
  copy_bytes<To, Host>(to.data(), from.data(), from.size() * sizeof(T));
}
template <class T, class From>
void copy(std::vector<T>& to, const Array<T, From>& from) {
  to.resize(static_cast<std::size_t>(from.size()));
  copy_bytes<Host, From>(to.data(), from.data(), to.size() * sizeof(T));
}
template <class T, class From>
std::vector<T> to_vector(const Array<T, From>& from) {
  std::vector<T> to;
  copy(to, from);
  return to;
}

}  // namespace scree
