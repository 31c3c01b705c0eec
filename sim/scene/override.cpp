// Applies overrides: walks the tree of a scene and the table of keys side by side.
#include "sim/scene/override.hpp"

#include "sim/scene/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace scree {
namespace {

[[noreturn]] void fail(const Override& set, std::string_view what) {
  throw InputError(printable(fmt::format("--set {}={}: {}", set.path, set.value, what)));
}

/// Splits a path such as bodies[2].velocity[0] into parts, which are views of set.path.
std::vector<PathPart> parse_path(const Override& set) {
  std::vector<PathPart> parts;
  const std::string_view path = set.path;
  std::size_t at = 0;
  while (at < path.size() || parts.empty()) {
    if (at < path.size() && path[at] == '[') {
      std::int64_t index = -1;
      const auto [end, error] = std::from_chars(path.data() + at + 1, path.data() + path.size(), index);
      const auto close = static_cast<std::size_t>(end - path.data());
      if (error != std::errc{} || index < 0 || close >= path.size() || path[close] != ']')
        fail(set, fmt::format("{} is no index such as [2]", path.substr(at)));
      parts.push_back({{}, index});
      at = close + 1;
      continue;
    }
    if (!parts.empty() && path[at++] != '.')
      fail(set, fmt::format("expected . or [ before {}", path.substr(at - 1)));
    const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
    if (end == at) fail(set, "the path has an empty part");
    parts.push_back({path.substr(at, end - at), -1});
    at = end;
  }
  return parts;
}

/// Returns the alternatives of a type: those of any_of, or the type itself.
std::vector<const Type*> alternatives(const Type& type) {
  if (type.kind != Type::Kind::any_of) return {&type};
  std::vector<const Type*> all;
  for (const Type& part : type.parts)
    for (const Type* alternative : alternatives(part)) all.push_back(alternative);
  return all;
}

class Walk {
 public:
  Walk(const Override& set, std::size_t index) : set_(set), index_(index), path_(parse_path(set)) {}

  /// Returns the node to which the path leads, and creates it if need be.
  Node& find(Node& root, const Type& type) {
    Node* node = &root;
    const Type* here = &type;
    for (done_ = 0; done_ < path_.size(); ++done_) {
      const PathPart& part = path_[done_];
      node =
          part.index >= 0 ? &item(*node, *here, part.index, &here) : &member(*node, *here, part.key, &here);
    }
    return *node;
  }

 private:
  std::string before() const {
    return done_ == 0 ? "the scene"
                      : to_text({path_.begin(), path_.begin() + static_cast<std::ptrdiff_t>(done_)});
  }

  Node& item(Node& node, const Type& type, std::int64_t index, const Type** next) const {
    for (const Type* alternative : alternatives(type)) {
      if (alternative->kind != Type::Kind::list) continue;
      const auto size = static_cast<std::int64_t>(node.items.size());
      if (node.kind != Node::Kind::list || index >= size)
        fail(set_, fmt::format("{} has {} items, so there is no [{}]", before(),
                               node.kind == Node::Kind::list ? size : 0, index));
      *next = &alternative->parts[0];
      return node.items[static_cast<std::size_t>(index)];
    }
    fail(set_, fmt::format("{} is no list", before()));
  }

  Node& member(Node& node, const Type& type, std::string_view name, const Type** next) const {
    std::vector<std::string_view> known;
    std::string_view section;
    for (const Type* alternative : alternatives(type)) {
      if (alternative->kind == Type::Kind::named) {
        for (const Node& entry : node.items) known.push_back(entry.key);
        *next = &alternative->parts[0];
        if (Node* found = node.find(name)) return *found;
      }
      if (alternative->kind != Type::Kind::section) continue;
      section = alternative->section->name;
      for (const KeyType& key : alternative->section->keys) {
        known.push_back(key.name);
        if (key.name != name) continue;
        if (key.presence == Presence::future) fail(set_, fmt::format("{} {}", name, future_text));
        *next = &key.type;
        return created(node, key);
      }
    }
    const auto is_list = [](const Type* alternative) { return alternative->kind == Type::Kind::list; };
    if (known.empty() && std::ranges::any_of(alternatives(type), is_list))
      fail(set_, fmt::format("{0} is a list, so there is no {1}: write {0}[0], {0}[1], ...", before(), name));
    if (known.empty()) fail(set_, fmt::format("{} has no keys, so there is no {}", before(), name));
    fail(set_, fmt::format("{} has no {}{}", before(), name, hint_for(section, name, known)));
  }

  /// Returns the member of a node for this key, and creates it with its default if need be. A node that is no
  /// map (`model: auto`, say) becomes one.
  Node& created(Node& node, const KeyType& key) const {
    if (node.kind != Node::Kind::map) {
      Node map = Node::map({}).named(node.key);
      Reader::mark_override(map, index_);
      node = std::move(map);
    }
    if (Node* found = node.find(key.name)) return *found;
    Node fresh = key.fallback.empty() ? Node{} : parse_document(key.fallback);
    fresh.key = key.name;
    Reader::mark_override(fresh, index_);
    return node.items.emplace_back(std::move(fresh));
  }

  const Override& set_;
  std::size_t index_;
  std::vector<PathPart> path_;
  std::size_t done_ = 0;
};

}  // namespace

void apply_overrides(Node& root, const Type& type, const std::vector<Override>& overrides) {
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    const Override& set = overrides[i];
    Node& target = Walk(set, i).find(root, type);
    Node value;
    try {
      value = parse_document(set.value);
    } catch (const SyntaxError& error) {
      fail(set, error.what);
    }
    value.key = target.key;
    target = std::move(value);
    Reader::mark_override(target, i);
  }
}

}  // namespace scree
