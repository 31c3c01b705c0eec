#include "sim/record/build_info.hpp"

#include "scree_commit.hpp"

#include <fstream>
#include <thread>

namespace scree {

BuildInfo build_info() { return {SCREE_VERSION, SCREE_COMMIT, SCREE_BUILD_TYPE, SCREE_COMPILER}; }

MachineInfo machine_info() {
  MachineInfo machine{.cpu = {}, .cores = std::thread::hardware_concurrency()};
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; machine.cpu.empty() && std::getline(file, line);) {
    if (line.starts_with("model name")) machine.cpu = line.substr(line.find(':') + 2);
  }
  return machine;
}

}  // namespace scree
