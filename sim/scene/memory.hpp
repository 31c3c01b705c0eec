// Estimates of how much memory a run needs, before any of it is allocated.
#pragma once

#include <string>

namespace scree {

/// The numbers that determine the memory of a run. They are doubles, because products of counts in a scene
/// may exceed every integer type.
struct MemoryLoad {
  double bodies = 0;
  double free_bodies = 0;
  double names = 0;       ///< number of bodies with a name
  double name_bytes = 0;  ///< number of letters in all names
  bool pictures = true;
};

/// The memory that a run needs (bytes).
struct MemoryNeed {
  double program = 0;   ///< the program, and its pictures
  double bodies = 0;    ///< states of the bodies in all copies, and their names
  double contacts = 0;  ///< contacts of free bodies in a dense packing: 6 at each body, each shared by two
  double total() const { return program + bodies + contacts; }
};
MemoryNeed memory_need(const MemoryLoad& load);

/// The memory that a run may take.
struct MemoryBudget {
  double bytes = 0;
  bool pictures = true;  ///< whether the run draws pictures
};

/// Returns the memory of this machine, or the part that this process may take if that is less (bytes).
double machine_memory();

/// Returns words such as "730 MiB", rounded up to two digits, which is as exact as the estimate.
std::string bytes_words(double bytes);

}  // namespace scree
