// The two places where data lives and code runs. This header and space.cpp are the only files that know
// which compiler reads them; everything else is a template on Host or Device.
#pragma once

#include <cstddef>
#include <string>

#if defined(__CUDACC__)
#define SCREE_HD __host__ __device__
#else
#define SCREE_HD
#endif
/// Statements that only the host's version of a SCREE_HD function has.
#if defined(__CUDA_ARCH__)
#define SCREE_ON_HOST(...)
#else
#define SCREE_ON_HOST(...) __VA_ARGS__
#endif

namespace scree {

/// Bytes that a program has taken of a space.
struct MemoryUse {
  std::size_t now = 0;
  std::size_t peak = 0;  ///< since the last call of forget_peak()
};

/// The processor's cores, driven by Thrust's TBB system.
struct Host {
  static constexpr const char* name = "host";
  /// Uninitialised storage, 64-byte aligned. Throws std::bad_alloc.
  static void* allocate(std::size_t bytes);
  static void deallocate(void* memory) noexcept;
  static void synchronize() {}
  /// Bytes that allocate could still give, as the system sees it now.
  static std::size_t free_memory();
  /// Resident memory of the process: what was allocated and touched. 0 where the system does not tell.
  static MemoryUse memory_use();
  static void forget_peak();
};

/// One NVIDIA GPU, driven by Thrust's CUDA system on the default stream. Every build declares it, and only
/// one with nvcc has what it declares.
struct Device {
  static constexpr const char* name = "cuda";
  /// Uninitialised storage from the driver's stream-ordered pool. Throws std::bad_alloc.
  static void* allocate(std::size_t bytes);
  static void deallocate(void* memory) noexcept;
  /// Waits for everything launched so far; throws RunError if any of it failed.
  static void synchronize();
  /// Bytes that allocate could still give: what the driver has free and what the pool holds unused.
  static std::size_t free_memory();
  /// Of the pool.
  static MemoryUse memory_use();
  static void forget_peak();
};

// Which spaces a build has is known to the sources that ask for it (scree_space_sources in
// cmake/ScreeCompiler.cmake), so that the objects of all others are the same in builds with and without nvcc.
#if defined(SCREE_WITH_CUDA)
/// Applies the macro M to each space that this build has; used for explicit instantiation.
#if SCREE_WITH_CUDA
#define SCREE_FOR_EACH_SPACE(M) M(::scree::Host) M(::scree::Device)
#define SCREE_SPACES ::scree::Host, ::scree::Device
using DeviceIfBuilt = Device;
#else
#define SCREE_FOR_EACH_SPACE(M) M(::scree::Host)
#define SCREE_SPACES ::scree::Host
using DeviceIfBuilt = Host;
#endif
#endif

/// Byte copy between any two spaces, ordered with the work launched before it; a copy to Host is complete
/// on return. `To` and `From` are Host or Device.
template <class To, class From>
void copy_bytes(void* to, const void* from, std::size_t bytes);

/// What the machine offers to the Device space.
struct DeviceInfo {
  bool built = false;      ///< this binary has the Device space
  bool available = false;  ///< and a GPU that it can run on was found
  std::string name;        ///< the GPU's name, or why there is none
  std::size_t memory = 0;  ///< bytes of GPU memory
};
DeviceInfo device_info();

}  // namespace scree
