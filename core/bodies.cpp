#include "core/bodies.hpp"

#include <xxhash.h>

namespace scree {

void permute(BodyTable& bodies, const std::vector<std::int32_t>& order) {
  for_each_field(
      [&order](const char*, auto& field) {
        auto old = field;
        for (std::size_t k = 0; k < order.size(); ++k) field[k] = old[static_cast<std::size_t>(order[k])];
      },
      bodies);
}

std::uint64_t hash_of(const BodyTable& bodies) {
  XXH3_state_t* state = XXH3_createState();
  XXH3_64bits_reset(state);
  for_each_field(
      [state](const char*, const auto& field) {
        XXH3_64bits_update(state, field.data(), field.size() * sizeof(field[0]));
      },
      bodies);
  const std::uint64_t hash = XXH3_64bits_digest(state);
  XXH3_freeState(state);
  return hash;
}

}  // namespace scree
