// Helpers of the tests with hostile input: they report a breach, check a message and make a file in memory.
#pragma once

#include <string>
#include <string_view>

namespace scree {

/// Throws std::logic_error with this message.
[[noreturn]] void breach(const std::string& what);

/// Calls breach() unless the message about bad input names a place and has no control characters, so that a
/// terminal can show it.
void require_message(std::string_view message);

/// Returns the path of a file in memory with these bytes. It is valid until the next call.
const std::string& file_of(std::string_view bytes);

}  // namespace scree
