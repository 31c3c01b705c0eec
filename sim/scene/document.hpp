// YAML text as a tree that knows where everything stands. Stricter than YAML: see parse_document().
#pragma once

#include "sim/scene/scene.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

struct Node {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  bool quoted = false;  ///< a scalar in quotes, or tagged !!str: text, whatever it looks like
  SourceMark mark;
  std::string text{};         ///< of a scalar
  std::vector<Node> items{};  ///< of a list or map
  std::string key;            ///< name of this node in the map that holds it
  SourceMark key_mark;

  /// The item of a map with this key, or null.
  const Node* find(std::string_view name) const;
  Node* find(std::string_view name);

  static Node scalar(std::string text, bool quoted = false);
  static Node list(std::vector<Node> items);
  static Node map(std::vector<Node> items);
  Node named(std::string name) &&;
};

/// A fault of the text itself; `what` names no file, `mark` says where.
struct SyntaxError {
  SourceMark mark;
  std::string what;
};

/// Parses one YAML document, or one of JSON. Throws SyntaxError for broken YAML, and for what YAML allows but
/// a scene does not: bytes that are not UTF-8, control characters, tabs in indentation outside of braces,
/// duplicate keys, keys that are not names or longer than 200 bytes, tags but YAML's own, a second document,
/// depth beyond 32, anchors that hold, or aliases that add, more than 100,000 nodes or 10 MB of text.
Node parse_document(const std::string& text);

/// The tree, a map, as YAML that parses to the same tree, but for quotes around plain text of more than
/// letters, digits, _ . + and -. Long lists and maps have one item per line, the rest is in braces.
std::string to_yaml(const Node& node);

/// The same on one line.
std::string to_flow_yaml(const Node& node);

}  // namespace scree
