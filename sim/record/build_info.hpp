// What this binary is and where it runs, as the manifest and `scree info` tell it.
#pragma once

#include <string>

namespace scree {

struct BuildInfo {
  std::string version;
  std::string commit;      ///< of git; "+" at the end: the working tree differed; "unknown" outside git
  std::string build_type;  ///< CMake's
  std::string compiler;    ///< name and version
};
BuildInfo build_info();

struct MachineInfo {
  std::string cpu;  ///< model name; empty where the system does not tell
  unsigned cores = 0;
};
MachineInfo machine_info();

}  // namespace scree
