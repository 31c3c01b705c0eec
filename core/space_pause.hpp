// Waiting without sleeping.
#pragma once

#include <thread>

namespace scree {

/// Leaves the processor to whoever shares it, for a moment.
inline void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

}  // namespace scree
