// Numbers made smaller as HDF5's filters `shuffle` and `deflate` do it, so that it reads what is written
// here.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace scree {

/// Numbers of `width` bytes each; the bytes of the same significance come together, then RFC 1950.
std::string compressed(std::span<const std::byte> numbers, int width);

/// The other way. Throws RunError unless it gives exactly as many bytes as there is room for.
void decompress(std::span<const std::byte> from, int width, std::span<std::byte> numbers);

}  // namespace scree
