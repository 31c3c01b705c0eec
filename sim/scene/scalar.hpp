// Scalars as YAML 1.2 tells them apart (core schema, section 10.3): what is written without quotes may be
// nothing, true or false, or a number; all else is text, as is everything in quotes.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace scree {

/// Whether the word stands for nothing: null, ~, or no word at all.
bool is_null_word(std::string_view text);

/// What true, True, TRUE and their opposites say.
std::optional<bool> truth_of(std::string_view text);

/// Of 0x1F and 0o17: the number, unless it has more than 64 bits.
std::optional<std::uint64_t> in_other_base(std::string_view text);

bool is_whole_number(std::string_view text);

/// Whole or not, finite or not.
bool is_number(std::string_view text);

}  // namespace scree
