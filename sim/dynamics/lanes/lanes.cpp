#include "sim/dynamics/lanes/lanes.hpp"

namespace scree::lanes {

const Kernels& kernels() {
  static const Kernels& widest = *supported_kernels().back().kernels;
  return widest;
}

}  // namespace scree::lanes
