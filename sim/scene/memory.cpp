// Estimates of memory. The constants are from measured runs: lattices of 100,000 and 400,000 spheres, apart
// and touching.
#include "sim/scene/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <unistd.h>

namespace scree {

MemoryNeed memory_need(const MemoryLoad& load) {
  constexpr double program = 6e7;
  constexpr double pictures = 1.2e8;
  constexpr double body = 1400;  // bytes per body in scene, simulation, solver, broad phase and records
  constexpr double dense =
      6200;  // bytes per free body for pairs, manifolds, rows of the solver, remembered impulses
  constexpr double name = 96;  // bytes per name for an entry of a map, besides the letters
  return {.program = program + (load.pictures ? pictures : 0),
          .bodies = body * load.bodies + name * load.names + load.name_bytes,
          .contacts = dense * load.free_bodies};
}

double machine_memory() {
  const double physical =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  // The limit of the control group, version 2, is a number, or the word max. Containers limit memory in this
  // way.
  double allowed = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> allowed && allowed > 0 ? std::min(physical, allowed) : physical;
}

std::string bytes_words(double bytes) {
  constexpr std::array<const char*, 6> units = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  std::size_t unit = 0;
  for (bytes /= 1024; bytes >= 1000 && unit + 1 < units.size(); ++unit) bytes /= 1024;
  const double digit = bytes < 10 ? 0.1 : bytes < 100 ? 1 : 10;
  return fmt::format("{:.6g} {}", std::ceil(bytes / digit) * digit, units[unit]);
}

}  // namespace scree
