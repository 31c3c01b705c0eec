#include "broadphase/bricks.hpp"

#include "broadphase/census.hpp"
#include "broadphase/device/brick_sample.hpp"
#include "broadphase/device/brick_search.hpp"
#include "broadphase/pair_list.hpp"
#include "core/error.hpp"
#include "core/timing.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace scree {

namespace {

unsigned blocks_for(std::int64_t items, std::int64_t of_block) {
  return static_cast<unsigned>((items + of_block - 1) / of_block);
}

constexpr std::size_t shared_to_search =
    std::max(sizeof(SearchMemory<BrickMethod::stencil>), sizeof(SearchMemory<BrickMethod::rows>));
constexpr std::size_t shared_to_buckets(std::int64_t buckets) {
  return scatter_tile * (sizeof(StagedRecord) + 2) +
         static_cast<std::size_t>(buckets) * (sizeof(BucketRun) + 4);
}
constexpr std::size_t shared_to_bricks(std::int32_t bucket_width) {
  const auto side = static_cast<std::size_t>(bucket_width) + 1;
  return side * side * side * (sizeof(BrickRun) + 4);
}

/// Returns whether a block of threads can have the shared memory that the kernels need, and if so, sets the
/// kernels' limits to it.
bool make_room() {
  int device = 0;
  int most = 0;
  if (cudaGetDevice(&device) != cudaSuccess ||
      cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerBlockOptin, device) != cudaSuccess)
    throw RunError("CUDA: could not ask for the shared memory of a block");
  const auto allow = [most](const void* kernel, std::size_t dynamic) {
    cudaFuncAttributes attributes;
    return cudaFuncGetAttributes(&attributes, kernel) == cudaSuccess &&
           attributes.sharedSizeBytes + dynamic <= static_cast<std::size_t>(most) &&
           cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                static_cast<int>(dynamic)) == cudaSuccess;
  };
  return allow(reinterpret_cast<const void*>(scatter_to_buckets), shared_to_buckets(most_buckets)) &&
         allow(reinterpret_cast<const void*>(scatter_to_bricks), shared_to_bricks(widest_bucket)) &&
         allow(reinterpret_cast<const void*>(search_bricks<BrickMethod::stencil>), shared_to_search) &&
         allow(reinterpret_cast<const void*>(search_bricks<BrickMethod::rows>), shared_to_search);
}

/// A T in pinned memory of the host, which the device can access.
template <class T>
class Pinned {
 public:
  Pinned() {
    if (cudaMallocHost(&at_, sizeof(T)) != cudaSuccess)
      throw RunError("CUDA: could not pin memory of the host");
  }
  ~Pinned() { cudaFreeHost(at_); }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;
  T* operator->() { return at_; }

 private:
  T* at_ = nullptr;
};

}  // namespace

struct Bricks<Device>::Arrays {
  Array<BrickSample, Device> sample{1};
  /// All words that must be zero at the start: the state, the tiles of the search, and the counts.
  Array<Word, Device> zeros;
  Array<std::uint32_t, Device> oversize_objects;
  Array<std::uint32_t, Device> owners;
  Array<StagedRecord, Device> records;
  Array<Entry, Device> entries;
  Array<Pair, Device> pairs;

  /// Results in pinned memory, to which the device writes directly: a copy to other memory would go by way of
  /// such memory.
  struct ToHost {
    BrickSample sample;
    BrickState state;
  };
  Pinned<ToHost> to_host;

  template <class T>
  static void fetch(T& to, const T* from) {
    if (cudaMemcpyAsync(&to, from, sizeof(T), cudaMemcpyDeviceToHost) != cudaSuccess)
      throw RunError("CUDA: could not copy from the device");
    Device::synchronize();
  }

  BrickSample take_sample(const BrickInput& input) {
    const timing::Call<Device> call("broadphase.initialize.sample");
    detail::clear_bytes(sample.data(), sizeof(BrickSample));
    const Sampled sampled{input.bounds, input.count};
    sample_sizes<<<sample_blocks, sample_threads>>>(sampled, sample.data());
    detail::require_launched("sample_sizes");
    sample_places<<<sample_blocks, sample_threads>>>(sampled, sample.data());
    detail::require_launched("sample_places");
    BrickSample& host = to_host->sample;
    fetch(host, sample.data());
    for (std::uint32_t& lo : host.lo) lo = ~lo;
    return host;
  }

  static constexpr std::int64_t state_words = sizeof(BrickState) / sizeof(Word);
  BrickState* state() { return reinterpret_cast<BrickState*>(zeros.data()); }
  Word* tiles() { return zeros.data() + state_words; }

  BrickStore scatter(const BrickPlan& plan, const BrickInput& input) {
    const std::int64_t bricks = plan.lattice.total();
    const std::int64_t buckets = plan.total_buckets();
    const std::int64_t per_bucket = input.count / chunk_records + 1;
    const std::int64_t most_chunks = input.count / chunk_records + buckets;
    const std::int64_t counts = bricks + buckets + buckets * per_bucket;
    oversize_objects.resize(input.count);
    entries.resize(bricks * std::int64_t{brick_objects});
    records.resize(most_chunks * chunk_records);
    owners.resize(most_chunks);
    zeros.resize(state_words + bricks + (counts + 1) / 2);
    detail::clear_bytes(zeros.data(), static_cast<std::size_t>(zeros.size()) * sizeof(Word));
    auto* const count = reinterpret_cast<std::uint32_t*>(tiles() + bricks);
    const BrickStore store{plan, state(), oversize_objects.data(), count, entries.data()};
    const BucketStore to{records.data(), count + bricks, count + bricks + buckets,
                         static_cast<std::uint32_t>(per_bucket), owners.data()};
    {
      const timing::Call<Device> call("broadphase.sort.buckets");
      const std::size_t shared = shared_to_buckets(buckets);
      scatter_to_buckets<<<blocks_for(input.count, scatter_tile), scatter_threads, shared>>>(input, store,
                                                                                             to);
      detail::require_launched("scatter_to_buckets");
    }
    const timing::Call<Device> call("broadphase.sort.bricks");
    const std::size_t shared = shared_to_bricks(plan.bucket_width);
    const auto blocks = static_cast<unsigned>(most_chunks) + oversize_blocks;
    scatter_to_bricks<<<blocks, scatter_threads, shared>>>(input, store, to);
    detail::require_launched("scatter_to_bricks");
    return store;
  }

  BrickState search(const BrickStore& store, const BrickInput& input) {
    const timing::Call<Device> call("broadphase.traverse.bricks");
    const SearchOutput out{input.bounds, pairs.data(), static_cast<Word>(pairs.capacity()), tiles()};
    if (store.plan.method == BrickMethod::stencil) {
      start<BrickMethod::stencil>(store, out);
    } else {
      start<BrickMethod::rows>(store, out);
    }
    fetch(to_host->state, state());
    return to_host->state;
  }

  /// Clears the results of a search, so that another search can be made.
  void clear_search(const BrickStore& store) {
    detail::clear_bytes(&state()->crowded,
                        sizeof(BrickState) - offsetof(BrickState, crowded) +
                            static_cast<std::size_t>(store.plan.lattice.total()) * sizeof(Word));
  }

  template <BrickMethod method>
  static void start(const BrickStore& store, const SearchOutput& out) {
    constexpr std::size_t shared = sizeof(SearchMemory<method>);
    search_bricks<method>
        <<<static_cast<unsigned>(store.plan.lattice.total()), search_threads, shared>>>(store, out);
    detail::require_launched("search_bricks");
  }
};

Bricks<Device>::Bricks() : arrays_(std::make_unique<Arrays>()) {}
Bricks<Device>::~Bricks() = default;

std::optional<ConstView<Pair>> Bricks<Device>::find(ConstView<Aabb> bounds, ConstView<Mobility> mobility,
                                                    BroadPhaseStats& stats) {
  Arrays& arrays = *arrays_;
  const BrickInput input{bounds.data(), mobility.data(), bounds.size()};
  static const bool has_room = make_room();
  if (!has_room || input.count == 0) return {};
  const std::optional<BrickPlan> plan = plan_bricks(arrays.take_sample(input), input.count);
  if (!plan) return {};
  const BrickStore store = arrays.scatter(*plan, input);
  for (;;) {
    const BrickState state = arrays.search(store, input);
    if (state.first_bad > 0 || state.over_full || state.crowded) return {};
    const auto pairs = static_cast<std::int64_t>(state.pairs);
    const bool fits = pairs <= arrays.pairs.capacity();
    if (!fits)
      require_memory(
          pairs, Device::free_memory() + static_cast<std::size_t>(arrays.pairs.capacity()) * sizeof(Pair));
    arrays.pairs.resize(pairs);
    if (!fits) {
      arrays.clear_search(store);
      continue;
    }
    stats.levels = 1;
    stats.bricks = plan->lattice.total();
    stats.pairs = pairs;
    for (const Word tests : state.tests) stats.candidates += static_cast<std::int64_t>(tests);
    return std::as_const(arrays.pairs).view();
  }
}

}  // namespace scree
