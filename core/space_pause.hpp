// Waits without sleeping.
#pragma once

#include <thread>

namespace scree {

/// Yields the processor for a moment to another thread that shares it.
inline void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace scree
