#include "core/space.hpp"

#include "core/error.hpp"
#include "core/thread_pool.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <malloc.h>
#include <new>

#if SCREE_WITH_CUDA
#include <cuda_runtime_api.h>
#endif

namespace scree {

void* Host::allocate(std::size_t bytes) {
  constexpr std::size_t line = 64;
  void* memory = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (!memory && bytes > 0) throw std::bad_alloc();
  return memory;
}

void Host::deallocate(void* memory) noexcept { std::free(memory); }

namespace {

/// Returns the bytes in the line "key   123 kB" of one of the system's tables; `otherwise` if there is no
/// such line.
std::size_t bytes_in(const char* table, const std::string& key, std::size_t otherwise) {
  std::ifstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key)) return 1024 * std::strtoull(line.c_str() + key.size(), nullptr, 10);
  }
  return otherwise;
}

}  // namespace

std::size_t Host::free_memory() {
  return bytes_in("/proc/meminfo", "MemAvailable:", SIZE_MAX);  // unknown: let the allocation decide
}

MemoryUse Host::memory_use() {
  return {bytes_in("/proc/self/status", "VmRSS:", 0), bytes_in("/proc/self/status", "VmHWM:", 0)};
}

void Host::forget_peak() {
  malloc_trim(0);  // free memory that is still resident would hide what is taken next
  std::ofstream("/proc/self/clear_refs") << 5;
}

template <>
void copy_bytes<Host, Host>(void* to, const void* from, std::size_t bytes) {
  constexpr std::size_t page = 4096;
  constexpr std::size_t few_pages = 16;
  const auto copy = [&](std::size_t begin, std::size_t end) {
    std::memcpy(static_cast<char*>(to) + begin, static_cast<const char*>(from) + begin, end - begin);
  };
  if (bytes < few_pages * page) {
    if (bytes > 0) copy(0, bytes);
    return;
  }
  const std::size_t pages = (bytes + page - 1) / page;
  detail::ThreadPool::get().for_ranges(
      static_cast<std::int64_t>(pages), [&](std::int64_t begin, std::int64_t end) {
        copy(static_cast<std::size_t>(begin) * page, std::min(static_cast<std::size_t>(end) * page, bytes));
      });
}

#if SCREE_WITH_CUDA

namespace {

void check(cudaError_t status, const char* what, std::size_t bytes = 0) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // clears the error, or the next Thrust call would report it as its own
  std::string message = std::string("CUDA: ") + what;
  if (bytes > 0) message += " (" + std::to_string(bytes) + " bytes)";
  throw RunError(message + ": " + cudaGetErrorString(status));
}

cudaMemPool_t default_pool() {
  int device = 0;
  cudaMemPool_t pool{};
  check(cudaGetDevice(&device), "device");
  check(cudaDeviceGetDefaultMemPool(&pool, device), "memory pool");
  return pool;
}

std::size_t pool_bytes(cudaMemPoolAttr attribute) {
  std::uint64_t bytes = 0;
  check(cudaMemPoolGetAttribute(default_pool(), attribute, &bytes), "memory pool");
  return bytes;
}

// Freed blocks stay in the pool, so that a step in the steady state never reaches the driver's allocator.
void keep_pool() {
  static const bool done = [] {
    std::uint64_t never = ~std::uint64_t{0};
    check(cudaMemPoolSetAttribute(default_pool(), cudaMemPoolAttrReleaseThreshold, &never), "memory pool");
    return true;
  }();
  (void)done;
}

void copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  if (bytes > 0) check(cudaMemcpyAsync(to, from, bytes, kind, cudaStream_t{}), "copy", bytes);
}

/// Memory of the host that does not move, through which a few bytes come from Device sooner than by way of
/// the driver's own. A thread has it as long as it lives, and it is taken when it is first needed.
class SmallBuffer {
 public:
  static constexpr std::size_t bytes = 4096;

  SmallBuffer() {
    if (cudaMallocHost(&memory_, bytes) != cudaSuccess) {
      cudaGetLastError();  // clears the error
      memory_ = nullptr;
    }
  }
  ~SmallBuffer() {
    if (memory_ != nullptr) cudaFreeHost(memory_);
  }
  SmallBuffer(const SmallBuffer&) = delete;
  SmallBuffer& operator=(const SmallBuffer&) = delete;

  void* memory() const { return memory_; }  ///< null if there is none

 private:
  void* memory_ = nullptr;
};

}  // namespace

void* Device::allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  keep_pool();
  void* memory = nullptr;
  const cudaError_t status = cudaMallocAsync(&memory, bytes, cudaStream_t{});
  if (status == cudaErrorMemoryAllocation) {
    cudaGetLastError();  // clears the error
    throw std::bad_alloc();
  }
  check(status, "cannot take memory", bytes);
  return memory;
}

void Device::deallocate(void* memory) noexcept {
  if (memory) cudaFreeAsync(memory, cudaStream_t{});
}

void Device::synchronize() { check(cudaStreamSynchronize(cudaStream_t{}), "a kernel failed"); }

std::size_t Device::free_memory() {
  std::size_t available = 0;
  std::size_t total = 0;
  check(cudaMemGetInfo(&available, &total), "memory");
  return available +
         (pool_bytes(cudaMemPoolAttrReservedMemCurrent) - pool_bytes(cudaMemPoolAttrUsedMemCurrent));
}

MemoryUse Device::memory_use() {
  return {pool_bytes(cudaMemPoolAttrUsedMemCurrent), pool_bytes(cudaMemPoolAttrUsedMemHigh)};
}

void Device::forget_peak() {
  std::uint64_t none = 0;
  check(cudaMemPoolSetAttribute(default_pool(), cudaMemPoolAttrUsedMemHigh, &none), "memory pool");
}

template <>
void copy_bytes<Device, Host>(void* to, const void* from, std::size_t bytes) {
  copy(to, from, bytes, cudaMemcpyHostToDevice);
}

template <>
void copy_bytes<Host, Device>(void* to, const void* from, std::size_t bytes) {
  static thread_local const SmallBuffer small;
  const bool by_buffer = bytes <= SmallBuffer::bytes && small.memory() != nullptr;
  copy(by_buffer ? small.memory() : to, from, bytes, cudaMemcpyDeviceToHost);
  Device::synchronize();
  if (by_buffer && bytes > 0) std::memcpy(to, small.memory(), bytes);
}

template <>
void copy_bytes<Device, Device>(void* to, const void* from, std::size_t bytes) {
  copy(to, from, bytes, cudaMemcpyDeviceToDevice);
}

namespace {

/// Returns a version such as "12.4" from a number as the runtime gives it.
std::string version_words(int version) {
  return std::to_string(version / 1000) + '.' + std::to_string(version % 1000 / 10);
}

std::string why_no_device(cudaError_t status) {
  if (status == cudaSuccess) return "no CUDA device";
  int driver = 0, runtime = 0;
  const bool known =
      cudaDriverGetVersion(&driver) == cudaSuccess && cudaRuntimeGetVersion(&runtime) == cudaSuccess;
  if (status != cudaErrorInsufficientDriver || !known) return cudaGetErrorString(status);
  if (driver == 0) return "no NVIDIA driver";
  return "the NVIDIA driver is for CUDA " + version_words(driver) + ", and this program needs one for " +
         version_words(runtime);
}

}  // namespace

DeviceInfo device_info() {
  DeviceInfo info;
  info.built = true;
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess || count == 0) {
    info.name = why_no_device(status);
    return info;
  }
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, 0), "device properties");
  info.available = true;
  info.name = properties.name;
  info.memory = properties.totalGlobalMem;
  return info;
}

#else

DeviceInfo device_info() { return {.name = "this program was built without CUDA"}; }

#endif

}  // namespace scree
