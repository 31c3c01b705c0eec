#include "sim/dynamics/lanes/lanes.hpp"
#include "sim/resident/visit_kernels.hpp"

namespace scree::resident {

const VisitKernels& visit_kernels() {
  static const VisitKernels& widest = visit_kernels(lanes::supported_kernels().back().name);
  return widest;
}

}  // namespace scree::resident
