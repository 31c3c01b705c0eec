// Checksums of bytes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace scree {

/// 64-bit XXH3.
std::uint64_t hash_of(const void* data, std::size_t bytes);

}  // namespace scree
