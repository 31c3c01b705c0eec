// Checksums of bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scree {

/// Returns the 64-bit XXH3 of the bytes.
std::uint64_t hash_of(const void* data, std::size_t bytes);

}  // namespace scree
