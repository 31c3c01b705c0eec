// The text with which a file of a run describes its parts: words and numbers, separated by spaces.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace scree {

/// Takes the next word, up to a space or the end of the line.
std::string_view take_word(std::string_view& line);

/// Takes the next number. Throws RunError if it is not a number from `least` to `most`.
std::int64_t take_number(std::string_view& line, std::int64_t least, std::int64_t most);
/// Takes the next number, a real one. Throws RunError if it is not a finite number.
double take_real(std::string_view& line);

/// Returns a type in words: kind, width and number of columns, such as "real 8 3".
std::string words_of(const FieldType& type);
/// Takes the words of a type. Throws RunError if no state and no trajectory has a field of this type.
FieldType take_type(std::string_view& line);

}  // namespace scree
