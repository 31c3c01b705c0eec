// The objects of the hierarchical grid, sorted by cell so that neighbours share cache lines, and the test of
// one object against others, in the form that suits the processor of each space.
#pragma once

#include "broadphase/pair_list.hpp"
#include "core/array.hpp"
#include "core/space_four.hpp"
#include "core/space_prefetch.hpp"

#include <cstdint>

namespace scree {

/// Views of the objects. Lower and upper corners are in separate arrays, so that a warp's loads of 16 bytes
/// share cache lines too.
template <class Space>
struct GridObjects {
  static constexpr int lanes = 1;  ///< number of objects that are tested at once
  using Probe = Boxed;             ///< an object that is tested against others

  Corner* lo;
  Corner* hi;

  SCREE_HD void set(std::int64_t k, const Boxed& object) const {
    lo[k] = object.lo;
    hi[k] = object.hi;
  }
  SCREE_HD Boxed object(std::int64_t k) const { return {lo[k], hi[k]}; }
  SCREE_HD static Probe probe(const Boxed& object) { return object; }
};

/// Views of the objects in blocks of four, with each coordinate of all four together, so that four are tested
/// at once.
template <>
struct GridObjects<Host> {
  static constexpr int lanes = 4;
  static constexpr std::int32_t body_bits = 0x7fffffff;

  struct alignas(64) Block {
    float lo[3][lanes];
    float hi[3][lanes];
    std::int32_t tag[lanes];  ///< the body, and the sign bit if it is fixed
  };
  /// An object that is repeated in all lanes.
  struct alignas(16) Probe {
    float lo[3][lanes];
    float hi[3][lanes];
    std::int32_t tag[lanes];

    SCREE_HD std::int32_t body() const { return tag[0] & body_bits; }
  };

  Block* block;

  SCREE_HD void set(std::int64_t k, const Boxed& object) const { put(object, block[k / lanes], k % lanes); }
  SCREE_HD Boxed object(std::int64_t k) const {
    const Block& b = block[k / lanes];
    const std::int64_t l = k % lanes;
    return {{{b.lo[0][l], b.lo[1][l], b.lo[2][l]}, b.tag[l] & body_bits},
            {{b.hi[0][l], b.hi[1][l], b.hi[2][l]}, b.tag[l] < 0 ? 1 : 0}};
  }
  SCREE_HD static Probe probe(const Boxed& object) {
    Probe probe;
    for (int l = 0; l < lanes; ++l) put(object, probe, l);
    return probe;
  }
  void prefetch(std::uint32_t number) const {
    scree::prefetch(block[number].lo);
    scree::prefetch(block[number].hi[1]);
  }
  /// Returns a mask in which bit l is set if the object may collide with the l-th object of a block.
  std::uint32_t may_collide(const Probe& a, std::uint32_t number) const {
    const Block& b = block[number];
    FourInts overlap = ~(four(a.tag) & four(b.tag));
    for (int d = 0; d < 3; ++d) {
      overlap &= four(a.lo[d]) <= four(b.hi[d]);
      overlap &= four(b.lo[d]) <= four(a.hi[d]);
    }
    return negative_lanes(overlap);
  }

 private:
  template <class Lanes>
  SCREE_HD static void put(const Boxed& object, Lanes& to, std::int64_t lane) {
    for (int a = 0; a < 3; ++a) {
      to.lo[a][lane] = object.lo.at[a];
      to.hi[a][lane] = object.hi.at[a];
    }
    to.tag[lane] = object.hi.tag == 0 ? object.lo.tag : object.lo.tag | ~body_bits;
  }
};

/// The owner of the objects' memory.
template <class Space>
class GridObjectArray {
 public:
  void resize(std::int64_t n) {
    lo_.resize(n);
    hi_.resize(n);
  }
  std::int64_t size() const { return lo_.size(); }
  GridObjects<Space> objects() { return {lo_.data(), hi_.data()}; }

 private:
  Array<Corner, Space> lo_, hi_;
};

template <>
class GridObjectArray<Host> {
 public:
  void resize(std::int64_t n) {
    blocks_.resize((n + GridObjects<Host>::lanes - 1) / GridObjects<Host>::lanes);
    size_ = n;
  }
  std::int64_t size() const { return size_; }
  GridObjects<Host> objects() { return {blocks_.data()}; }

 private:
  Array<GridObjects<Host>::Block, Host> blocks_;
  std::int64_t size_ = 0;
};

}  // namespace scree
