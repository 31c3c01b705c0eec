// YAML text as a tree whose nodes know their line and column. The parser is stricter than YAML: see
// parse_document().
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
  std::string text{};         ///< text of a scalar
  std::vector<Node> items{};  ///< items of a list or map
  std::string key;            ///< name of this node in the map that holds it
  SourceMark key_mark;

  /// Returns the item of a map with this key, or null.
  const Node* find(std::string_view name) const;
  Node* find(std::string_view name);

  static Node scalar(std::string text, bool quoted = false);
  static Node list(std::vector<Node> items);
  static Node map(std::vector<Node> items);
  Node named(std::string name) &&;
};

/// An error in the text itself. `what` names no file; `mark` gives the line and column.
struct SyntaxError {
  SourceMark mark;
  std::string what;
};

/// Parses one document of YAML or of JSON. Throws SyntaxError for broken YAML, and for what YAML allows but a
/// scene does not: bytes that are not UTF-8, control characters, tabs in indentation outside braces,
/// duplicate keys, keys that are not names or longer than 200 bytes, tags other than YAML's own, a second
/// document, a depth of more than 32 levels, and anchors that hold, or aliases that add, more than 100,000
/// nodes or 10 MB of text.
Node parse_document(const std::string& text);

/// Returns the tree, a map, as YAML that parses to the same tree, except that plain text gets quotes if it
/// has other characters than letters, digits, _ . + and -. Sections that hold maps have one item per line;
/// everything else is on one line, in braces or brackets.
std::string to_yaml(const Node& node);

/// Returns the tree as YAML on one line.
std::string to_flow_yaml(const Node& node);

}  // namespace scree
