// Describes types in words, and tests which form a node has.
#include "sim/scene/type.hpp"

#include "sim/scene/scalar.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace scree {
namespace {

std::string words_of(const Range& range) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  if (low && high && !range.above && !range.below)
    return fmt::format(" from {} to {}", range.low, range.high);
  std::string words;
  if (low) words += fmt::format(" {} {}", range.above ? ">" : ">=", range.low);
  if (low && high) words += " and";
  if (high) words += fmt::format(" {} {}", range.below ? "<" : "<=", range.high);
  return words;
}

/// Returns the words for the items of a list: "numbers > 0 (m)" for "a number > 0 (m)".
std::string plural_of(const Type& type) {
  const std::string one = words_of(type);
  if (type.kind == Type::Kind::number) return "numbers" + one.substr(std::string_view("a number").size());
  if (type.kind == Type::Kind::integer)
    return "whole numbers" + one.substr(std::string_view("a whole number").size());
  return "items, each " + one;
}

}  // namespace

std::string words_of(const Type& type) {
  const std::string unit = type.unit.empty() ? "" : fmt::format(" ({})", type.unit);
  switch (type.kind) {
    case Type::Kind::integer:
      if (type.range.low == type.range.high) return fmt::format("{}", type.range.low);
      return "a whole number" + words_of(type.range) + unit;
    case Type::Kind::number:
      return "a number" + words_of(type.range) + unit;
    case Type::Kind::text:
      return type.pattern.empty() ? "text" : type.pattern_words;
    case Type::Kind::word:
      return fmt::format("{}{}", type.words.size() > 1 ? "one of " : "", fmt::join(type.words, ", "));
    case Type::Kind::list: {
      if (type.least == type.most)
        return fmt::format("a list of {} {}", type.least, plural_of(type.parts[0]));
      return "a list of " + plural_of(type.parts[0]);
    }
    case Type::Kind::named:
      return fmt::format("a map of at most {} names", type.most);
    case Type::Kind::section: {
      std::vector<std::string_view> names;
      for (const KeyType& key : type.section->keys)
        if (key.presence != Presence::future) names.push_back(key.name);
      return fmt::format("a map {{{}}}", fmt::join(names, ", "));
    }
    case Type::Kind::any_of: {
      std::vector<std::string> parts;
      for (const Type& part : type.parts) parts.push_back(words_of(part));
      return fmt::format("{}", fmt::join(parts, ", or "));
    }
  }
  return {};
}

bool has_form(const Node& node, const Type& type) {
  switch (type.kind) {
    case Type::Kind::integer:
    case Type::Kind::number:
      return node.kind == Node::Kind::scalar && !node.quoted && is_number(node.text);
    case Type::Kind::text:
      return node.kind == Node::Kind::scalar;
    case Type::Kind::word:
      return find_word(node, type).has_value();
    case Type::Kind::list:
      return node.kind == Node::Kind::list;
    case Type::Kind::named:
    case Type::Kind::section:
      return node.kind == Node::Kind::map;
    case Type::Kind::any_of:
      return std::any_of(type.parts.begin(), type.parts.end(),
                         [&](const Type& part) { return has_form(node, part); });
  }
  return false;
}

std::optional<std::size_t> find_word(const Node& node, const Type& type) {
  if (node.kind != Node::Kind::scalar) return {};
  const auto is_meant = [&](const std::string& word) {
    const std::optional<bool> truth = truth_of(word);
    return truth ? !node.quoted && truth_of(node.text) == truth : node.text == word;
  };
  const auto found = std::find_if(type.words.begin(), type.words.end(), is_meant);
  if (found == type.words.end()) return {};
  return static_cast<std::size_t>(found - type.words.begin());
}

std::string shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::scalar:
      return node.text.size() > 40 ? fmt::format("\"{}...\"", node.text.substr(0, 40))
                                   : fmt::format("{0}{1}{0}", node.quoted ? "\"" : "", node.text);
    case Node::Kind::list:
      return fmt::format("a list of {}", node.items.size());
    case Node::Kind::map:
      return fmt::format("a map of {}", node.items.size());
  }
  return {};
}

}  // namespace scree
