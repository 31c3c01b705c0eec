// The two places where data lives and code runs. The files space*.hpp and space.cpp of this folder are the
// only ones that depend on which compiler reads them; everything else is a template on Host or Device.
#pragma once

#include <cstddef>
#include <string>

#if defined(__CUDACC__)
#define SCREE_HD __host__ __device__
#else
#define SCREE_HD
#endif
/// Marks statements that only the host's version of a SCREE_HD function has.
#if defined(__CUDA_ARCH__)
#define SCREE_ON_HOST(...)
#else
#define SCREE_ON_HOST(...) __VA_ARGS__
#endif

namespace scree {

/// The memory that a program uses in a space (bytes).
struct MemoryUse {
  std::size_t now = 0;
  std::size_t peak = 0;  ///< since the last call of forget_peak()
};

/// The cores of the processor, driven by Thrust's TBB system.
struct Host {
  static constexpr const char* name = "host";
  /// Returns uninitialised storage, aligned to 64 bytes. Throws std::bad_alloc.
  static void* allocate(std::size_t bytes);
  static void deallocate(void* memory) noexcept;
  static void synchronize() {}
  /// Returns the bytes that allocate() could still give, as the system reports them now.
  static std::size_t free_memory();
  /// Returns the resident memory of the process, which was allocated and touched; 0 where the system does not
  /// report it.
  static MemoryUse memory_use();
  static void forget_peak();
};

/// One NVIDIA GPU, driven by Thrust's CUDA system on the default stream. Every build declares this type, but
/// only a build with nvcc defines its functions.
struct Device {
  static constexpr const char* name = "cuda";
  /// Returns uninitialised storage from the driver's stream-ordered pool. Throws std::bad_alloc.
  static void* allocate(std::size_t bytes);
  static void deallocate(void* memory) noexcept;
  /// Waits for all work launched so far; throws RunError if any of it failed.
  static void synchronize();
  /// Returns the bytes that allocate() could still give: those that the driver has free, and the unused ones
  /// of the pool.
  static std::size_t free_memory();
  /// Returns the memory in use of the pool.
  static MemoryUse memory_use();
  static void forget_peak();
};

// Only the sources that name every space of the build know which spaces it has (scree_space_sources in
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

/// Copies bytes between any two spaces, ordered with the work launched before; a copy to Host is complete on
/// return. `To` and `From` are Host or Device.
template <class To, class From>
void copy_bytes(void* to, const void* from, std::size_t bytes);

/// The GPU that this machine offers to the Device space.
struct DeviceInfo {
  bool built = false;      ///< this binary has the Device space
  bool available = false;  ///< it has, and a GPU on which it can run was found
  std::string name;        ///< the GPU's name, or why there is none
  std::size_t memory = 0;  ///< bytes of GPU memory
};
DeviceInfo device_info();

}  // namespace scree
