// Compression of numbers as by the filters `shuffle` and `deflate` of HDF5, so that HDF5 can read the result.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace scree {

/// Compresses numbers of `width` bytes each: the bytes of the same significance are put together, and the
/// result is compressed as in RFC 1950.
std::string compressed(std::span<const std::byte> numbers, int width);

/// Decompresses into `numbers`. Throws RunError unless the result has exactly the size of `numbers`.
void decompress(std::span<const std::byte> from, int width, std::span<std::byte> numbers);

}  // namespace scree
