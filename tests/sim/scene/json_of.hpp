// Converts a scene's tree to JSON, by the rules of YAML 1.2 for scalars.
#pragma once

#include "sim/scene/document.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>

namespace scree {

/// Keys stay in their order, which numbers the materials.
using OrderedJson = nlohmann::ordered_json;

/// Converts a scalar. Numbers are those of C, which differ in hexadecimal and infinite ones; shipped scenes
/// have none of these.
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
