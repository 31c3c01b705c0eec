// scree info: prints the identity of this program and what it finds on this machine.
#include "core/error.hpp"
#include "core/space.hpp"
#include "render/renderer.hpp"
#include "sim/cli/commands.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/outcome.hpp"

#include <fmt/format.h>

namespace scree::cli {

namespace {

std::string gpu() {
  const DeviceInfo device = device_info();
  if (!device.built) return "not in this build";
  if (!device.available) return "none: " + device.name;
  return fmt::format("{}, {:.1f} GiB", device.name, static_cast<double>(device.memory) / (1 << 30));
}

std::string pictures(render::ContextChoice context) try {
  return render::make_renderer(context, 16, 16)->name();
} catch (const RunError& error) {
  return fmt::format("none: {}", error.what());
}

}  // namespace

int info() {
  const BuildInfo build = build_info();
  const MachineInfo machine = machine_info();
  fmt::print("scree      {}\n", build.version);
  fmt::print("commit     {}\n", build.commit);
  fmt::print("build      {}, {}\n", build.build_type, build.compiler);
  fmt::print("libraries  {}\n", SCREE_LIBRARIES);
  fmt::print("host       {}, {} cores\n", machine.cpu.empty() ? "unknown processor" : machine.cpu,
             machine.cores);
  fmt::print("cuda       {}\n", gpu());
  fmt::print("pictures   {}\n", pictures(render::ContextChoice::automatic));
  fmt::print("--context  osmesa: {}\n", pictures(render::ContextChoice::osmesa));
  fmt::print("           egl: {}\n", pictures(render::ContextChoice::egl));
  return status_done;
}

}  // namespace scree::cli
