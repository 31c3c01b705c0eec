// What a value of the scene language may be, as data: messages, JSON Schema and reference are made of it.
#pragma once

#include "sim/scene/document.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Allowed numbers. `above`: low itself is not allowed; `below`: high itself is not.
struct Range {
  double low = -HUGE_VAL;
  double high = HUGE_VAL;
  bool above = false;
  bool below = false;

  bool holds(double x) const { return (above ? x > low : x >= low) && (below ? x < high : x <= high); }
};
inline constexpr Range any_value{};
inline constexpr Range above_zero{0, HUGE_VAL, true, false};
inline constexpr Range not_negative{0, HUGE_VAL, false, false};
constexpr Range between(double low, double high) { return {low, high, false, false}; }
constexpr Range inside(double low, double high) { return {low, high, true, true}; }
constexpr Range at_least(double low) { return {low, HUGE_VAL, false, false}; }

struct SectionType;

struct Type {
  enum class Kind {
    integer,
    number,
    text,
    word,     ///< one of `words`
    list,     ///< of parts[0]
    named,    ///< a map from names of the user's choice to parts[0]
    section,  ///< a map with the keys of `section`
    any_of,   ///< one of `parts`, told apart by form
  };

  Kind kind = Kind::number;
  Range range{};                     ///< of integer and number
  std::string unit{};                ///< empty: none
  std::vector<std::string> words{};  ///< of word
  std::string pattern{};             ///< of text: what is allowed, as a regular expression
  std::string pattern_words{};       ///< the same in words
  std::int64_t least = 0;            ///< items of a list, or names
  std::int64_t most = INT64_MAX;
  std::vector<Type> parts{};
  std::shared_ptr<const SectionType> section{};
};

enum class Presence { required, optional, future };

struct KeyType {
  std::string name;
  Presence presence = Presence::optional;
  Type type;
  std::string fallback;  ///< the default as YAML; empty: none
  std::string help;
};

struct SectionType {
  std::string name;
  std::string help;
  std::vector<KeyType> keys;
};

/// "a number > 0 (m)": completes "must be ...".
std::string words_of(const Type& type);

/// Whether the node has the form of the type (the values in it may still be wrong).
bool has_form(const Node& node, const Type& type);

/// The place of the node's word among those of the type, if it is one of them. true and false are no text:
/// they stand without quotes, and may begin with a capital.
std::optional<std::size_t> find_word(const Node& node, const Type& type);

/// The node in a few words, for "must be ..., not ...".
std::string shown(const Node& node);

}  // namespace scree
