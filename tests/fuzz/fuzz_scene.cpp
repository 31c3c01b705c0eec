// libFuzzer's entry; scripts/fuzz.sh runs it.
#include "tests/fuzz/hostile_input.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scree::read_hostile_scene({reinterpret_cast<const char*>(data), size});
  return 0;
}
