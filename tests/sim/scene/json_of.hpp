// A scene's tree as JSON, by what YAML 1.2 says of its scalars.
#pragma once

#include "sim/scene/document.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>

namespace scree {

/// Keys stay in their order, which numbers materials.
using OrderedJson = nlohmann::ordered_json;

/// Numbers are those of C, but for hexadecimal and infinite ones, which shipped scenes do not have.
inline OrderedJson json_of_scalar(const Node& node) {
  if (node.quoted) return node.text;
  if (node.text == "true" || node.text == "True" || node.text == "TRUE") return true;
  if (node.text == "false" || node.text == "False" || node.text == "FALSE") return false;
  char* end = nullptr;
  if (!node.text.starts_with('-')) {
    const unsigned long long whole = std::strtoull(node.text.c_str(), &end, 10);
    if (end != node.text.c_str() && *end == '\0') return whole;
  }
  const long long whole = std::strtoll(node.text.c_str(), &end, 10);
  if (end != node.text.c_str() && *end == '\0') return whole;
  const double real = std::strtod(node.text.c_str(), &end);
  if (end != node.text.c_str() && *end == '\0') return real;
  return node.text;
}

inline OrderedJson json_of(const Node& node) {
  if (node.kind == Node::Kind::null) return nullptr;
  if (node.kind == Node::Kind::scalar) return json_of_scalar(node);
  auto json = node.kind == Node::Kind::list ? OrderedJson::array() : OrderedJson::object();
  for (const Node& item : node.items) {
    if (node.kind == Node::Kind::list) {
      json.push_back(json_of(item));
    } else {
      json[item.key] = json_of(item);
    }
  }
  return json;
}

}  // namespace scree
