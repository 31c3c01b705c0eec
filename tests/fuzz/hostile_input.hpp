// Input of any bytes, and what may come of it: what it says, or an InputError. Shared by the fuzzers, which
// make such bytes, and by the test that reads those which were kept.
#pragma once

#include <string_view>

namespace scree {

/// Reads the bytes as a scene. Lines that begin with `--set ` are no part of it, but overrides. Throws
/// std::logic_error if what came is neither an InputError with a place nor a scene in order: all of its
/// numbers finite, and its resolved text a scene that resolves to itself.
void read_hostile_scene(std::string_view bytes);

/// Reads the bytes as a body file, by itself and for a scene. Throws std::logic_error likewise.
void read_hostile_body_file(std::string_view bytes);

}  // namespace scree
