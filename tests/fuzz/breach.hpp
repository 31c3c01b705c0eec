// What hostile input must never bring about, and a file of it.
#pragma once

#include <string>
#include <string_view>

namespace scree {

/// Throws std::logic_error.
[[noreturn]] void breach(const std::string& what);

/// What is said of bad input names a place, and is fit for a terminal.
void require_message(std::string_view message);

/// The path of a file in memory with these bytes, which holds until the next call.
const std::string& file_of(std::string_view bytes);

}  // namespace scree
