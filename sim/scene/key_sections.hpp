// The sections of the table of keys that have files of their own, and helpers to make them.
#pragma once

#include "sim/scene/keys.hpp"

#include <string>
#include <utility>

namespace scree {

inline constexpr Presence required = Presence::required;
inline constexpr Presence optionally = Presence::optional;

/// Sets the default of a key whose member cannot show it, because an absent value differs from a given one.
template <class T>
Key<T> with_default(Key<T> key, std::string fallback) {
  key.type.fallback = std::move(fallback);
  return key;
}

// body_keys.cpp
Codec<BodyEntry> body_section();

// method_keys.cpp
Codec<ResponseSettings> response_section();
Codec<BroadPhaseSettings> broadphase_section();
Codec<NarrowPhaseSettings> narrowphase_section();
Codec<ModelSettings> model_section();

// render_keys.cpp
Codec<RenderSettings> render_section();

}  // namespace scree
