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

/// Under this many objects they go straight to their bricks.
constexpr std::int64_t many = 200'000;

void clear(void* memory, std::size_t bytes) {
  if (cudaMemsetAsync(memory, 0, bytes) != cudaSuccess) throw RunError("CUDA: could not clear memory");
}

unsigned blocks_for(std::int64_t items, std::int64_t of_block) {
  return static_cast<unsigned>((items + of_block - 1) / of_block);
}

constexpr std::size_t shared_to_search =
    std::max(sizeof(SearchMemory<BrickMethod::stencil>), sizeof(SearchMemory<BrickMethod::rows>));
constexpr std::size_t shared_to_buckets(std::int64_t buckets) {
  return scatter_tile * (sizeof(Parcel) + 2) + static_cast<std::size_t>(buckets) * (sizeof(BucketRun) + 4);
}
constexpr std::size_t shared_to_bricks(std::int32_t bucket_width) {
  const auto side = static_cast<std::size_t>(bucket_width) + 1;
  return most_staged * (sizeof(Entry) + 2) + side * side * side * (sizeof(BrickRun) + 4);
}

/// Whether a block of threads can have the shared memory that it needs; then the kernels are told to.
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

}  // namespace

struct Bricks<Device>::Arrays {
  Array<BrickSample, Device> sample{1};
  Array<BrickState, Device> state{1};
  Array<std::uint32_t, Device> giants;
  Array<std::uint32_t, Device> counts;  ///< of bricks, of buckets, and the buckets' chunks
  Array<std::uint32_t, Device> owners;
  Array<Parcel, Device> parcels;
  Array<Entry, Device> entries;
  Array<Word, Device> tiles;
  Array<Pair, Device> pairs;

  BrickSample take_sample(const BrickInput& input) {
    const timing::Call<Device> call("broadphase.initialize.sample");
    clear(sample.data(), sizeof(BrickSample));
    const Sampled sampled{input.bounds, input.count, std::min<std::int64_t>(input.count, BrickSample::most)};
    sample_sizes<<<sample_blocks, sample_threads>>>(sampled, sample.data());
    sample_places<<<sample_blocks, sample_threads>>>(sampled, sample.data());
    BrickSample host;
    copy_bytes<Host, Device>(&host, sample.data(), sizeof(host));
    for (std::uint32_t& lo : host.lo) lo = ~lo;
    return host;
  }

  BrickStore scatter(const BrickPlan& plan, const BrickInput& input) {
    const std::int64_t bricks = plan.lattice.total();
    const bool in_two_steps = input.count >= many;
    const std::int64_t buckets = in_two_steps ? plan.total_buckets() : 0;
    const std::int64_t per_bucket = input.count / chunk_parcels + 1;
    giants.resize(input.count);
    entries.resize(bricks * std::int64_t{brick_objects});
    counts.resize(bricks + buckets + buckets * per_bucket);
    clear(state.data(), sizeof(BrickState));
    clear(counts.data(), static_cast<std::size_t>(counts.size()) * sizeof(std::uint32_t));
    const BrickStore store{plan, state.data(), giants.data(), counts.data(), entries.data()};
    if (in_two_steps) {
      const std::int64_t most_chunks = input.count / chunk_parcels + buckets;
      parcels.resize(most_chunks * chunk_parcels);
      owners.resize(most_chunks);
      const BucketStore to{parcels.data(), counts.data() + bricks, counts.data() + bricks + buckets,
                           static_cast<std::uint32_t>(per_bucket), owners.data()};
      {
        const timing::Call<Device> call("broadphase.sort.buckets");
        const std::size_t shared = shared_to_buckets(buckets);
        scatter_to_buckets<<<blocks_for(input.count, scatter_tile), scatter_threads, shared>>>(input, store,
                                                                                               to);
      }
      const timing::Call<Device> call("broadphase.sort.bricks");
      const std::size_t shared = shared_to_bricks(plan.bucket_width);
      scatter_to_bricks<<<static_cast<unsigned>(most_chunks), scatter_threads, shared>>>(store, to);
    } else {
      const timing::Call<Device> call("broadphase.sort.bricks");
      scatter_directly<<<blocks_for(input.count, direct_threads), direct_threads>>>(input, store);
    }
    const timing::Call<Device> call("broadphase.sort.giants");
    scatter_giants<<<1024, 128>>>(input, store);
    return store;
  }

  BrickState search(const BrickStore& store, const BrickInput& input) {
    const timing::Call<Device> call("broadphase.traverse.bricks");
    const std::int64_t bricks = store.plan.lattice.total();
    tiles.resize(bricks);
    clear(tiles.data(), static_cast<std::size_t>(bricks) * sizeof(Word));
    const SearchOutput out{input.bounds, pairs.data(), static_cast<Word>(pairs.capacity()), tiles.data()};
    if (store.plan.method == BrickMethod::stencil) {
      start<BrickMethod::stencil>(store, out);
    } else {
      start<BrickMethod::rows>(store, out);
    }
    BrickState host;
    copy_bytes<Host, Device>(&host, state.data(), sizeof(host));
    return host;
  }

  template <BrickMethod method>
  static void start(const BrickStore& store, const SearchOutput& out) {
    constexpr std::size_t shared = sizeof(SearchMemory<method>);
    search_bricks<method>
        <<<static_cast<unsigned>(store.plan.lattice.total()), search_threads, shared>>>(store, out);
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
      clear(&arrays.state.data()->crowded, sizeof(BrickState) - offsetof(BrickState, crowded));
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
