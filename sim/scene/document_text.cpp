// The writer of a tree of nodes as YAML text.
#include "sim/scene/document.hpp"
#include "sim/scene/scalar.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {

/// Returns whether the text without quotes is read as one scalar, and not as null, in any context.
bool is_plain(std::string_view text) {
  if (is_null_word(text)) return false;
  const auto is_alphanumeric = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return std::any_of(text.begin(), text.end(), is_alphanumeric) &&
         std::all_of(text.begin(), text.end(), [&](char c) {
           return is_alphanumeric(c) || c == '_' || c == '.' || c == '+' || c == '-';
         });
}

void append_quoted(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    if ((c >= 0 && c < ' ') || c == 0x7F) {
      out += c == '\n'   ? "\\n"
             : c == '\r' ? "\\r"
             : c == '\t' ? "\\t"
                         : fmt::format("\\x{:02x}", static_cast<int>(c));
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
}

void append_scalar(std::string& out, std::string_view text, bool quoted) {
  if (quoted || !is_plain(text)) {
    append_quoted(out, text);
  } else {
    out += text;
  }
}

void append_key(std::string& out, std::string_view key) {
  append_scalar(out, key, false);
  out += ':';
}

void append_flow(std::string& out, const Node& node) {
  if (node.kind == Node::Kind::null) {
    out += "null";
  } else if (node.kind == Node::Kind::scalar) {
    append_scalar(out, node.text, node.quoted);
  } else {
    const bool map = node.kind == Node::Kind::map;
    out += map ? '{' : '[';
    for (const Node& item : node.items) {
      if (&item != node.items.data()) out += ", ";
      if (map) {
        append_key(out, item.key);
        out += ' ';
      }
      append_flow(out, item);
    }
    out += map ? '}' : ']';
  }
}

bool holds_maps(const Node& node) {
  return std::any_of(node.items.begin(), node.items.end(),
                     [](const Node& item) { return item.kind == Node::Kind::map; });
}

}  // namespace

std::string to_flow_yaml(const Node& node) {
  std::string out;
  append_flow(out, node);
  return out;
}

std::string to_yaml(const Node& node) {
  if (node.items.empty()) return "{}\n";
  std::string out;
  for (const Node& section : node.items) {
    append_key(out, section.key);
    if (!holds_maps(section)) {
      out += ' ';
      append_flow(out, section);
      out += '\n';
      continue;
    }
    out += '\n';
    for (const Node& item : section.items) {
      out += "  ";
      if (section.kind == Node::Kind::map) {
        append_key(out, item.key);
        out += ' ';
      } else {
        out += "- ";
      }
      append_flow(out, item);
      out += '\n';
    }
  }
  return out;
}

}  // namespace scree
