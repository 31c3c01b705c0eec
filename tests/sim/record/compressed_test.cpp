#include "sim/record/compressed.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace scree {
namespace {

std::vector<std::byte> bytes_of(const std::vector<double>& numbers) {
  std::vector<std::byte> bytes(numbers.size() * sizeof(double));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// Places along a line: what neighbours share is worth finding.
std::vector<std::byte> places() {
  std::vector<double> numbers;
  for (int k = 0; k < 10000; ++k) numbers.push_back(1 + 1e-4 * k);
  return bytes_of(numbers);
}

std::span<const std::byte> as_bytes(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(Compressed, ComesBackAsItWas) {
  for (const int width : {1, 4, 8}) {
    for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
      std::vector<std::byte> numbers(count * static_cast<std::size_t>(width));
      for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<std::byte>(k * 37 % 251);
      std::vector<std::byte> back(numbers.size());
      decompress(as_bytes(compressed(numbers, width)), width, back);
      EXPECT_EQ(back, numbers) << width << " x " << count;
    }
  }
}

TEST(Compressed, NumbersThatAreAlikeTakeLessRoomByTheirBytes) {
  const std::vector<std::byte> numbers = places();
  const std::size_t one_by_one = compressed(numbers, 1).size();
  EXPECT_LT(compressed(numbers, sizeof(double)).size(), one_by_one * 3 / 4);
}

TEST(Compressed, WhatIsNoneOrOfAnotherLengthIsRefused) {
  const std::vector<std::byte> numbers = places();
  std::string packed = compressed(numbers, 8);
  std::vector<std::byte> room(numbers.size());
  EXPECT_THROW(decompress(as_bytes(packed), 8, std::span(room).first(room.size() - 8)), RunError);
  std::vector<std::byte> more(numbers.size() + 8);
  EXPECT_THROW(decompress(as_bytes(packed), 8, more), RunError);
  EXPECT_THROW(decompress(as_bytes(packed).first(packed.size() / 2), 8, room), RunError);
  EXPECT_THROW(decompress({}, 8, room), RunError);
  packed[packed.size() / 2] ^= 1;
  EXPECT_THROW(decompress(as_bytes(packed), 8, room), RunError);
}

}  // namespace
}  // namespace scree
