// The compression, in the only file that includes zlib.
#include "sim/record/compressed.hpp"

#include "core/error.hpp"

#include <new>
#include <vector>
#include <zlib.h>

namespace scree {

namespace {

/// Transposes a matrix of bytes: the byte at [b][k] of `from` comes to [k][b] of `to`.
void transpose(const std::byte* from, std::byte* to, std::size_t rows, std::size_t columns) {
  for (std::size_t column = 0; column < columns; ++column) {
    for (std::size_t row = 0; row < rows; ++row) to[column * rows + row] = from[row * columns + column];
  }
}

const Bytef* input(const std::byte* bytes) { return reinterpret_cast<const Bytef*>(bytes); }

}  // namespace

std::string compressed(std::span<const std::byte> numbers, int width) {
  // This is the fastest level: the slowest takes three times as long for 2 % of the size
  // (docs/decisions/0032).
  constexpr int level = 1;
  const auto bytes = static_cast<std::size_t>(width);
  std::vector<std::byte> shuffled(numbers.size());
  transpose(numbers.data(), shuffled.data(), numbers.size() / bytes, bytes);
  uLongf size = compressBound(shuffled.size());
  std::string out(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(out.data()), &size, input(shuffled.data()), shuffled.size(), level);
  if (status != Z_OK) throw std::bad_alloc();  // all other errors are ruled out here
  out.resize(size);
  return out;
}

void decompress(std::span<const std::byte> from, int width, std::span<std::byte> numbers) {
  const auto bytes = static_cast<std::size_t>(width);
  std::vector<std::byte> shuffled(numbers.size());
  uLongf size = shuffled.size();
  const int status =
      uncompress(reinterpret_cast<Bytef*>(shuffled.data()), &size, input(from.data()), from.size());
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK || size != shuffled.size()) throw RunError("compressed numbers are damaged");
  transpose(shuffled.data(), numbers.data(), bytes, numbers.size() / bytes);
}

}  // namespace scree
