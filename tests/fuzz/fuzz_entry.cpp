// The entry point of libFuzzer for the reader SCREE_READ; scripts/fuzz.sh runs it.
#include "tests/fuzz/hostile_input.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scree::SCREE_READ({reinterpret_cast<const char*>(data), size});
  return 0;
}
