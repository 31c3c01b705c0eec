// The types of values of the scene language, as data from which messages, JSON Schema and reference are made.
#pragma once

#include "sim/scene/document.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A range of allowed numbers. `above`: low itself is not allowed; `below`: high itself is not.
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
    list,     ///< a list of items of the type parts[0]
    named,    ///< a map from names of the user's choice to parts[0]
    section,  ///< a map with the keys of `section`
    any_of,   ///< one of `parts`, told apart by form
  };

  Kind kind = Kind::number;
  Range range{};                     ///< allowed range of an integer or a number
  std::string unit{};                ///< empty: no unit
  std::vector<std::string> words{};  ///< the allowed words of a type `word`
  std::string pattern{};             ///< allowed text, as a regular expression; empty: any text
  std::string pattern_words{};       ///< the pattern in words
  std::int64_t least = 0;            ///< least number of items of a list or of names
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

/// Returns the type in words, such as "a number > 0 (m)", which complete "must be ...".
std::string words_of(const Type& type);

/// Returns whether the node has the form of the type (the values in it may still be wrong).
bool has_form(const Node& node, const Type& type);

/// Returns the index of the node's word among those of the type, if it is one of them. The words true and
/// false must not be in quotes, and may be True, TRUE and so on.
std::optional<std::size_t> find_word(const Node& node, const Type& type);

/// Returns the node in a few words, for "must be ..., not ...".
std::string shown(const Node& node);

}  // namespace scree
