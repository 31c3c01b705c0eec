// Runs code in a space that is chosen when the program runs. For sources that name every space of the build
// (scree_space_sources in cmake/ScreeCompiler.cmake).
#pragma once

#include "core/error.hpp"
#include "core/space.hpp"

namespace scree {

#if defined(SCREE_WITH_CUDA)
/// Returns act(Device{}) if `on_device`, otherwise act(Host{}); both must have the same type. Throws
/// InputError if `on_device` and there is no GPU to run on, or the build has no Device.
template <class Act>
auto in_chosen_space(bool on_device, const Act& act) {
  if (!on_device) return act(Host{});
  const DeviceInfo info = device_info();
  if (!info.available) throw InputError("--device cuda: there is no GPU to run on: " + info.name);
  return act(DeviceIfBuilt{});
}
#endif

}  // namespace scree
