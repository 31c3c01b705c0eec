// The identity of this binary and of the machine, as the manifest and `scree info` show them.
#pragma once

#include <string>

namespace scree {

struct BuildInfo {
  std::string version;
  std::string commit;      ///< git commit; "+" at the end: the working tree differed; "unknown" outside git
  std::string build_type;  ///< CMake's build type
  std::string compiler;    ///< name and version of the compiler
};
BuildInfo build_info();

struct MachineInfo {
  std::string cpu;  ///< model name; empty if the system does not give it
  unsigned cores = 0;
};
MachineInfo machine_info();

}  // namespace scree
