// Types in words, and which form a node has.
#include "sim/scene/type.hpp"

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

/// "a number > 0 (m)" as the items of a list: "numbers > 0 (m)".
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
  const bool plain = node.kind == Node::Kind::scalar && !node.quoted;
  switch (type.kind) {
    case Type::Kind::integer:
    case Type::Kind::number:
      return looks_like_number(node);
    case Type::Kind::text:
      return node.kind == Node::Kind::scalar;
    case Type::Kind::word:
      return plain && std::find(type.words.begin(), type.words.end(), node.text) != type.words.end();
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

bool looks_like_number(const Node& node) {
  if (node.kind != Node::Kind::scalar || node.quoted || node.text.empty()) return false;
  std::string_view text = node.text;
  if (text[0] == '+' || text[0] == '-') text.remove_prefix(1);
  if (text.empty()) return false;
  if (text[0] == '.') text.remove_prefix(1);
  if (text.empty()) return false;
  static constexpr std::string_view not_finite[] = {"inf", "Inf", "INF", "nan", "NaN", "NAN"};
  return (text[0] >= '0' && text[0] <= '9') ||
         std::find(std::begin(not_finite), std::end(not_finite), text) != std::end(not_finite);
}

}  // namespace scree
