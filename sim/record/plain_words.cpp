#include "sim/record/plain_words.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>

namespace scree {

namespace {

/// The words in the order of FieldType::Kind.
constexpr std::array<std::string_view, 4> kind_words = {"integer", "natural", "real", "bytes"};

/// Reads a number. Returns whether the whole word is one.
template <class T>
bool reads_as(std::string_view word, T& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

std::string_view take_word(std::string_view& line) {
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(std::min(word.size() + 1, line.size()));
  return word;
}

std::int64_t take_number(std::string_view& line, std::int64_t least, std::int64_t most) {
  const std::string_view word = take_word(line);
  std::int64_t number = 0;
  if (!reads_as(word, number) || number < least || number > most)
    throw RunError(fmt::format("is not valid: {:?} is no number from {} to {}", word, least, most));
  return number;
}

double take_real(std::string_view& line) {
  const std::string_view word = take_word(line);
  double number = 0;
  if (!reads_as(word, number) || !std::isfinite(number))
    throw RunError(fmt::format("is not valid: {:?} is no number", word));
  return number;
}

std::string words_of(const FieldType& type) {
  return fmt::format("{} {} {}", kind_words[static_cast<std::size_t>(type.kind)], type.width, type.columns);
}

FieldType take_type(std::string_view& line) {
  using Kind = FieldType::Kind;
  constexpr std::int64_t most_columns = 1 << 16;
  const auto kind =
      static_cast<std::size_t>(std::ranges::find(kind_words, take_word(line)) - kind_words.begin());
  if (kind == kind_words.size()) throw RunError("is not valid: a field is of no kind");
  const auto width = static_cast<int>(take_number(line, 1, sizeof(double)));
  const auto columns = static_cast<int>(take_number(line, 1, most_columns));
  const FieldType type{static_cast<Kind>(kind), width, columns};
  const int least = type.kind == Kind::real ? 4 : 1;
  const int most = type.kind == Kind::bytes ? 1 : 8;
  if (type.width < least || type.width > most || !std::has_single_bit(static_cast<unsigned>(type.width)))
    throw RunError(fmt::format("is not valid: a number is {} bytes wide", type.width));
  return type;
}

}  // namespace scree
