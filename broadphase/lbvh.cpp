#include "broadphase/lbvh.hpp"

#include "broadphase/census.hpp"
#include "broadphase/centre_scale.hpp"
#include "broadphase/pair_list.hpp"
#include "core/space_atomic.hpp"

namespace scree {

namespace {

/// A node: the box of one leaf, or of consecutive leaves. Nodes have numbers: leaf k has ~k, and an internal
/// node has the number of the one of its end leaves that is next to the split of its parent (Karras 2012),
/// which no other node shares.
struct alignas(32) Node {
  float lo[3];
  std::int32_t down;  ///< child with the first leaves; for a leaf: its body, or ~body if that is fixed
  float hi[3];
  std::int32_t over;  ///< node that follows after its leaves, or the number of leaves if there is none

  SCREE_HD Aabb box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// A binary tree over leaves with codes in order. A node splits where the highest bit changes in which the
/// codes of its leaves differ. Equal codes are distinguished by the numbers of their leaves, as if these
/// followed as lower bits (Karras 2012), so no path is longer than 63 + 31 nodes, however many codes are
/// equal.
struct Tree {
  std::int32_t leaves;  ///< number of leaves, at least two
  const std::uint64_t* code;
  Node* nodes;

  SCREE_HD Node& at(std::int32_t number) const {
    return nodes[number < 0 ? std::int64_t{leaves} + ~number : number];
  }
  /// Returns the first leaf of a node that is the `over` of another node. Its number gives the leaf, since
  /// the node is the upper part of its parent.
  SCREE_HD static std::int32_t first_of(std::int32_t over) { return over < 0 ? ~over : over; }

  /// Returns whether the split after leaf a is deeper in the tree than the split after leaf b, if both are
  /// next to one node.
  SCREE_HD bool deeper(std::int32_t a, std::int32_t b) const {
    const std::uint64_t difference_a = code[a] ^ code[a + 1];
    const std::uint64_t difference_b = code[b] ^ code[b + 1];
    if (difference_a != difference_b) return difference_a < difference_b;
    return (a ^ (a + 1)) < (b ^ (b + 1));
  }
  /// Returns whether the node with the leaves from first to last is the lower part of its parent.
  SCREE_HD bool is_lower(std::int32_t first, std::int32_t last) const {
    return first == 0 || (last + 1 < leaves && deeper(last, first - 1));
  }
  SCREE_HD static std::int32_t number_of(std::int32_t first, std::int32_t last, bool lower) {
    return first == last ? ~first : lower ? last : first;
  }
  /// Returns the upper part of the node that splits after leaf `last`. It is the next node to visit if a node
  /// that ends with this leaf is skipped (Prokopenko and Lebrun-Grandie 2024).
  SCREE_HD std::int32_t over(std::int32_t last) const {
    const std::int32_t next = last + 1;
    return next < leaves && !is_lower(next, next) ? ~next : next;
  }
};

struct CodeOfBox {
  CentreScale scale;
  ConstView<Aabb> bounds;
  View<std::uint64_t> code;
  View<std::int32_t> body;
  SCREE_HD void operator()(std::int64_t i) const {
    const Aabb box = bounds[i];
    code[i] = is_absent(box) ? beyond_z_order : morton_code(scale, box);
    body[i] = static_cast<std::int32_t>(i);
  }
};

/// Builds the tree from each leaf to the root. At a parent, the thread that comes first ends; the second one,
/// which finds both children done, makes the node (Apetrei 2014, "Fast and Simple Agglomerative LBVH
/// Construction"). Which thread comes second changes nothing in the tree.
struct Climb {
  static constexpr std::int32_t unvisited = -1;

  Tree tree;
  ConstView<Aabb> bounds;
  ConstView<Mobility> mobility;
  ConstView<std::int32_t> body;
  View<std::int32_t> reached;  ///< for the parent with each split: the far end of the child that came first

  SCREE_HD void operator()(std::int64_t k) const {
    auto first = static_cast<std::int32_t>(k);
    std::int32_t last = first;
    Node node = leaf(body[k]);
    for (;;) {
      const bool lower = tree.is_lower(first, last);
      node.over = tree.over(last);
      tree.at(Tree::number_of(first, last, lower)) = node;
      const std::int32_t split = lower ? last : first - 1;
      const std::int32_t far = exchange(&reached[split], lower ? first : last);
      if (far == unvisited) return;
      (lower ? last : first) = far;
      if (first == 0 && last + 1 == tree.leaves) return;  // the root, which no search visits
      const std::int32_t sibling =
          lower ? Tree::number_of(split + 1, last, false) : Tree::number_of(first, split, true);
      extend(node, tree.at(sibling));
      node.down = Tree::number_of(first, split, true);
    }
  }

 private:
  SCREE_HD Node leaf(std::int32_t i) const {
    const Aabb box = bounds[i];
    return {{box.lo[0], box.lo[1], box.lo[2]},
            mobility[i] == Mobility::fixed ? ~i : i,
            {box.hi[0], box.hi[1], box.hi[2]},
            0};
  }
  SCREE_HD static void extend(Node& node, const Node& by) {
    for (int a = 0; a < 3; ++a) {
      node.lo[a] = by.lo[a] < node.lo[a] ? by.lo[a] : node.lo[a];
      node.hi[a] = by.hi[a] > node.hi[a] ? by.hi[a] : node.hi[a];
    }
  }
};

SCREE_HD bool holds(const Node& outer, const Node& inner) {
  for (int a = 0; a < 3; ++a)
    if (inner.lo[a] < outer.lo[a] || inner.hi[a] > outer.hi[a]) return false;
  return true;
}

/// Searches the leaves after leaf k, so that each pair is found once; it needs no stack. Calls found(first,
/// end) for leaves that all overlap leaf k. It is called once for all leaves of a node that leaf k encloses,
/// so that oversize objects, and many bodies at one point, do not cost a test for each pair. Returns the
/// number of tests.
template <class Found>
SCREE_HD std::uint32_t search(const Tree& tree, std::int64_t k, const Found& found) {
  const Node self = tree.at(~static_cast<std::int32_t>(k));
  const bool fixed = self.down < 0;
  std::uint32_t tests = 0;
  auto first = static_cast<std::int32_t>(k) + 1;  // first of the node's leaves
  for (std::int32_t number = self.over; number != tree.leaves;) {
    const Node node = tree.at(number);
    ++tests;
    const bool meets = overlap(self.box(), node.box());
    if (meets && number >= 0 && (fixed || !holds(self, node))) {
      number = node.down;
      continue;
    }
    const std::int32_t end = Tree::first_of(node.over);
    if (meets && !(fixed && node.down < 0)) found(first, end);
    number = node.over;
    first = end;
  }
  return tests;
}

struct CountPairs {
  Tree tree;
  View<std::uint32_t> pairs;
  View<std::uint32_t> tests;
  SCREE_HD void operator()(std::int64_t k) const {
    std::uint32_t count = 0;
    tests[k] = search(tree, k, [&count](std::int32_t first, std::int32_t end) {
      count += static_cast<std::uint32_t>(end - first);
    });
    pairs[k] = count;
  }
};

struct ListPairs {
  Tree tree;
  const std::int64_t* place;  ///< index of each leaf's first pair
  View<Pair> pairs;
  SCREE_HD void operator()(std::int64_t k) const {
    if (place[k] == place[k + 1]) return;
    Pair* to = pairs.data() + place[k];
    const std::int32_t self = body(static_cast<std::int32_t>(k));
    search(tree, k, [this, &to, self](std::int32_t first, std::int32_t end) {
      for (std::int32_t other = first; other < end; ++other) *to++ = pair_of(self, body(other));
    });
  }

 private:
  SCREE_HD std::int32_t body(std::int32_t leaf) const {
    const std::int32_t down = tree.at(~leaf).down;
    return down < 0 ? ~down : down;
  }
};

struct TestsOfLeaf {
  ConstView<std::uint32_t> tests;
  SCREE_HD std::int64_t operator()(std::int64_t k) const { return tests[k]; }
};

template <class Space>
class Lbvh final : public BroadPhase<Space> {
 public:
  ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) override {
    stats_ = {};
    const Census census = take_census<Space>(bounds);
    if (census.present < 2) return {};
    sort(bounds, CentreScale(census));
    return traverse(build(bounds, mobility, census.present));
  }
  const BroadPhaseStats& stats() const override { return stats_; }

 private:
  /// Sorts the objects in the order of the curve; absent objects come last.
  void sort(ConstView<Aabb> bounds, const CentreScale& scale) {
    code_.resize(bounds.size());
    body_.resize(bounds.size());
    parallel::for_each<Space>("broadphase.lbvh.codes", bounds.size(),
                              CodeOfBox{scale, bounds, code_.view(), body_.view()});
    parallel::sort_by_key("broadphase.lbvh.sort", code_, body_);
  }

  Tree build(ConstView<Aabb> bounds, ConstView<Mobility> mobility, std::int32_t leaves) {
    nodes_.resize(2 * std::int64_t{leaves});
    reached_.resize(leaves);
    parallel::fill("broadphase.lbvh.clear", reached_, Climb::unvisited);
    const Tree tree{leaves, code_.data(), nodes_.data()};
    parallel::for_each<Space>("broadphase.lbvh.build", leaves,
                              Climb{tree, bounds, mobility, body_.view(), reached_.view()});
    return tree;
  }

  /// Searches the leaves after each leaf. The pairs are first counted and then listed.
  ConstView<Pair> traverse(const Tree& tree) {
    count_.resize(tree.leaves);
    tests_.resize(tree.leaves);
    parallel::for_each<Space>("broadphase.lbvh.count", tree.leaves,
                              CountPairs{tree, count_.view(), tests_.view()});
    stats_.candidates =
        parallel::sum<std::int64_t, Space>("broadphase.lbvh.tests", tree.leaves, TestsOfLeaf{tests_.view()});
    stats_.pairs = parallel::exclusive_scan<Space>("broadphase.lbvh.places", count_, place_);
    const View<Pair> pairs = pairs_.room_for(stats_.pairs);
    parallel::for_each<Space>("broadphase.lbvh.list", tree.leaves, ListPairs{tree, place_.data(), pairs});
    return pairs;
  }

  BroadPhaseStats stats_;
  Array<std::uint64_t, Space> code_;  ///< codes of the objects, sorted
  Array<std::int32_t, Space> body_;
  Array<Node, Space> nodes_;  ///< internal nodes, then leaves
  Array<std::int32_t, Space> reached_;
  Array<std::uint32_t, Space> count_, tests_;  ///< number of pairs and of tests of each leaf
  Array<std::int64_t, Space> place_;
  PairList<Space> pairs_;
};

}  // namespace

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_lbvh() {
  return std::make_unique<Lbvh<Space>>();
}

#define SCREE_INSTANTIATE(Space) template std::unique_ptr<BroadPhase<Space>> make_lbvh<Space>();
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
