// How much memory a run needs, before any of it is taken.
#pragma once

#include <string>

namespace scree {

/// What decides it. Doubles, because products of counts in a scene may exceed every integer.
struct MemoryLoad {
  double bodies = 0;
  double free_bodies = 0;
  double names = 0;       ///< bodies with a name
  double name_bytes = 0;  ///< letters of all names
  bool pictures = true;
};

/// Bytes.
struct MemoryNeed {
  double program = 0;   ///< and the pictures
  double bodies = 0;    ///< their state in all its copies, and their names
  double contacts = 0;  ///< of the free bodies in a dense packing, where each has 6, each shared by two
  double total() const { return program + bodies + contacts; }
};
MemoryNeed memory_need(const MemoryLoad& load);

/// What a run may take.
struct MemoryBudget {
  double bytes = 0;
  bool pictures = true;  ///< whether it draws
};

/// What this machine has, or what this process may take of it if that is less (bytes).
double machine_memory();

/// "730 MiB", rounded up to what an estimate is worth.
std::string bytes_words(double bytes);

}  // namespace scree
