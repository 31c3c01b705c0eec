#include "core/space.hpp"

#include "core/error.hpp"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
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

std::size_t Host::free_memory() {
  std::ifstream table("/proc/meminfo");
  std::string key;
  for (std::size_t kilobytes = 0; table >> key >> kilobytes; table.ignore(64, '\n')) {
    if (key == "MemAvailable:") return kilobytes * 1024;
  }
  return SIZE_MAX;  // unknown: let the allocation decide
}

template <>
void copy_bytes<Host, Host>(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) std::memcpy(to, from, bytes);
}

#if SCREE_WITH_CUDA

namespace {

void check(cudaError_t status, const char* what, std::size_t bytes = 0) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // forgets it, or the next Thrust call would report it as its own
  std::string message = std::string("CUDA: ") + what;
  if (bytes > 0) message += " (" + std::to_string(bytes) + " bytes)";
  throw RunError(message + ": " + cudaGetErrorString(status));
}

// Freed blocks stay in the pool: the steady step then never reaches the driver's allocator.
void keep_pool() {
  static const bool done = [] {
    int device = 0;
    cudaMemPool_t pool{};
    std::uint64_t never = ~std::uint64_t{0};
    check(cudaGetDevice(&device), "device");
    check(cudaDeviceGetDefaultMemPool(&pool, device), "memory pool");
    check(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &never), "memory pool");
    return true;
  }();
  (void)done;
}

void copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  if (bytes > 0) check(cudaMemcpyAsync(to, from, bytes, kind, cudaStream_t{}), "copy", bytes);
}

}  // namespace

void* Device::allocate(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  keep_pool();
  void* memory = nullptr;
  check(cudaMallocAsync(&memory, bytes, cudaStream_t{}), "out of device memory", bytes);
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
  int device = 0;
  cudaMemPool_t pool{};
  std::uint64_t reserved = 0;
  std::uint64_t used = 0;
  check(cudaGetDevice(&device), "device");
  check(cudaDeviceGetDefaultMemPool(&pool, device), "memory pool");
  check(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReservedMemCurrent, &reserved), "memory pool");
  check(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &used), "memory pool");
  return available + (reserved - used);
}

template <>
void copy_bytes<Device, Host>(void* to, const void* from, std::size_t bytes) {
  copy(to, from, bytes, cudaMemcpyHostToDevice);
}

template <>
void copy_bytes<Host, Device>(void* to, const void* from, std::size_t bytes) {
  copy(to, from, bytes, cudaMemcpyDeviceToHost);
  Device::synchronize();
}

template <>
void copy_bytes<Device, Device>(void* to, const void* from, std::size_t bytes) {
  copy(to, from, bytes, cudaMemcpyDeviceToDevice);
}

DeviceInfo device_info() {
  DeviceInfo info;
  info.built = true;
  int count = 0;
  const cudaError_t status = cudaGetDeviceCount(&count);
  if (status != cudaSuccess || count == 0) {
    info.name = status != cudaSuccess ? cudaGetErrorString(status) : "no CUDA device";
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

DeviceInfo device_info() { return {.name = "built without nvcc"}; }

#endif

}  // namespace scree
