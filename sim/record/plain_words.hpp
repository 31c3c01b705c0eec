// The text in which a file of a run says where its parts are: words and numbers, a space between them.
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace scree {

/// Takes the next word, up to a space or the end of the line.
std::string_view take_word(std::string_view& line);

/// Takes the next number. Throws RunError unless it is one from `least` to `most`.
std::int64_t take_number(std::string_view& line, std::int64_t least, std::int64_t most);
/// Takes the next finite number. Throws RunError unless it is one.
double take_real(std::string_view& line);

/// "real 8 3": kind, width, columns.
std::string words_of(const FieldType& type);
/// Takes them. Throws RunError unless some state or trajectory has such a field.
FieldType take_type(std::string_view& line);

}  // namespace scree
