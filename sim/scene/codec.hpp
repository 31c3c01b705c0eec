// Codecs. A codec is a type of the scene language together with the functions that read it into a C++ value
// and write it from one. Small codecs combine into sections, and sections into the table of keys.
#pragma once

#include "core/math.hpp"
#include "sim/scene/reader.hpp"
#include "sim/scene/type.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

template <class T>
struct Codec {
  Type type;
  /// Reads a node into the value. Throws InputError, with the node's line and column, unless the node is of
  /// the type.
  std::function<void(T&, const Node&, Reader&)> read;
  /// Returns the value as a node, or nothing if the value is left out of a scene, such as an absent optional.
  std::function<std::optional<Node>(const T&)> write;
};

/// The message about a key that belongs to a later version of the language.
inline constexpr const char* future_text = "is part of the scene language but not in this version";

Codec<double> number(const Range& range = any_value, std::string unit = {});
Codec<std::int64_t> large_integer(const Range& range);
Codec<std::uint64_t> seed_integer();
Codec<int> integer(const Range& range);
Codec<bool> boolean();
/// Makes the codec of a name that messages, measures and paths can use: a letter or _, then letters, digits,
/// _ and -.
Codec<std::string> identifier();
/// Makes the codec of text that can name a file: not empty, no slash or control character, no dot at its
/// start.
Codec<std::string> file_name();
Codec<std::string> text();
bool is_identifier(std::string_view word);
bool is_file_name(std::string_view word);

[[noreturn]] void fail_form(const Node& node, const Type& type, const Reader& reader);
/// Returns the index of the node's word among those of the type; throws InputError if it is none of them.
std::size_t read_word(const Node& node, const Type& type, const Reader& reader);
Type word_type(std::vector<std::string> words);
Type list_type(const Type& item, std::int64_t least, std::int64_t most);

/// Makes the codec of a few words, each of which stands for a value.
template <class T>
Codec<T> word(std::vector<std::pair<std::string, T>> words) {
  std::vector<std::string> names;
  for (const auto& [name, value] : words) names.push_back(name);
  const Type type = word_type(std::move(names));
  return {type,
          [words, type](T& value, const Node& node, Reader& reader) {
            value = words[read_word(node, type, reader)].second;
          },
          [words](const T& value) -> std::optional<Node> {
            for (const auto& [name, meaning] : words)
              if (meaning == value) return Node::scalar(name);
            return {};
          }};
}

/// Reads the items of a list. Messages name the index of the item, and an error in one item does not hide
/// errors in the others.
template <class T>
void read_items(std::vector<T>& values, const Node& node, Reader& reader, const Codec<T>& item) {
  values.clear();
  for (std::size_t i = 0; i < node.items.size() && !reader.gives_up(); ++i) {
    const Reader::Step step(reader, i);
    try {
      item.read(values.emplace_back(), node.items[i], reader);
    } catch (const InputError& error) {
      reader.note(error);
    }
  }
}

template <class T>
Codec<std::vector<T>> list_of(Codec<T> item, std::int64_t least = 0, std::int64_t most = INT64_MAX) {
  const Type type = list_type(item.type, least, most);
  return {type,
          [item, type](std::vector<T>& values, const Node& node, Reader& reader) {
            const auto size = static_cast<std::int64_t>(node.items.size());
            if (node.kind != Node::Kind::list || size < type.least || size > type.most)
              fail_form(node, type, reader);
            read_items(values, node, reader, item);
          },
          [item](const std::vector<T>& values) -> std::optional<Node> {
            if (values.empty()) return {};
            std::vector<Node> items;
            for (const T& value : values) items.push_back(*item.write(value));
            return Node::list(std::move(items));
          }};
}

/// Makes the codec of a list of known length N, which is read into anything with operator[].
template <class Values, std::size_t N, class T>
Codec<Values> fixed_list(Codec<T> item) {
  const Type type = list_type(item.type, N, N);
  return {type,
          [item, type](Values& values, const Node& node, Reader& reader) {
            if (node.kind != Node::Kind::list || node.items.size() != N) fail_form(node, type, reader);
            for (std::size_t i = 0; i < N; ++i) {
              const Reader::Step step(reader, i);
              item.read(values[i], node.items[i], reader);
            }
          },
          [item](const Values& values) -> std::optional<Node> {
            std::vector<Node> items;
            for (std::size_t i = 0; i < N; ++i) items.push_back(*item.write(values[i]));
            return Node::list(std::move(items));
          }};
}
template <std::size_t N, class T>
Codec<std::array<T, N>> array_of(Codec<T> item) {
  return fixed_list<std::array<T, N>, N>(std::move(item));
}
inline Codec<Vec3> vector(std::string unit, const Range& range = any_value) {
  return fixed_list<Vec3, 3>(number(range, std::move(unit)));
}

/// Makes the codec of a value that may be absent.
template <class T>
Codec<std::optional<T>> optional(Codec<T> codec) {
  return {codec.type,
          [codec](std::optional<T>& value, const Node& node, Reader& reader) {
            codec.read(value.emplace(), node, reader);
          },
          [codec](const std::optional<T>& value) -> std::optional<Node> {
            return value ? codec.write(*value) : std::nullopt;
          }};
}

/// Makes the codec of a value with several alternatives. A node is read by the first alternative whose form
/// it has; a value is written by the first alternative that can write it.
template <class T>
Codec<T> any_of(std::vector<Codec<T>> alternatives) {
  Type type{.kind = Type::Kind::any_of};
  for (const Codec<T>& codec : alternatives) type.parts.push_back(codec.type);
  const auto codecs = std::make_shared<const std::vector<Codec<T>>>(std::move(alternatives));
  return {type,
          [codecs, type](T& value, const Node& node, Reader& reader) {
            for (const Codec<T>& codec : *codecs)
              if (has_form(node, codec.type)) return codec.read(value, node, reader);
            fail_form(node, type, reader);
          },
          [codecs](const T& value) -> std::optional<Node> {
            for (const Codec<T>& codec : *codecs)
              if (std::optional<Node> node = codec.write(value)) return node;
            return {};
          }};
}

/// Makes the codec of a value or the word `auto`, which leaves the value to scree.
template <class T>
Codec<std::optional<T>> or_auto(Codec<T> codec) {
  const Codec<std::optional<T>> automatic{
      word_type({"auto"}), [](std::optional<T>& value, const Node&, Reader&) { value.reset(); },
      [](const std::optional<T>& value) {
        return value ? std::nullopt : std::optional(Node::scalar("auto"));
      }};
  return any_of<std::optional<T>>({automatic, optional(std::move(codec))});
}

template <class T>
struct Key {
  KeyType type;
  std::function<void(T&, const Node&, Reader&)> read;
  std::function<std::optional<Node>(const T&)> write;
};

/// Makes a key that is stored in a member of T (or of a base of T).
template <class T, class Base, class M>
Key<T> key(std::string name, M Base::*member, const Codec<M>& codec, Presence presence, std::string help) {
  return {{std::move(name), presence, codec.type, {}, std::move(help)},
          [member, codec](T& object, const Node& node, Reader& reader) {
            codec.read(object.*member, node, reader);
          },
          [member, codec](const T& object) { return codec.write(object.*member); }};
}

/// Makes a key of the language that this version refuses, with a message that says so.
template <class T>
Key<T> future(std::string name, std::string help) {
  return {{std::move(name), Presence::future, {}, {}, std::move(help)}, {}, {}};
}

/// Returns the index of a member's key in the section. Throws InputError for an unknown key, with the nearest
/// known one.
std::size_t find_key(const Node& member, const SectionType& section, Reader& reader);
void require_keys(const Node& node, const SectionType& section, Reader& reader);

/// Makes the codec of a map with the given keys. `rule` checks the keys together, after each of them has been
/// found right. If T has a member `node`, it is set to the node, and a member `mark` is set to the node's
/// line and column, for later checks.
template <class T>
Codec<T> section(std::string name, std::string help, std::vector<Key<T>> list,
                 std::function<void(const T&, const Node&, Reader&)> rule = {}) {
  auto described = std::make_shared<SectionType>();
  described->name = std::move(name);
  described->help = std::move(help);
  for (Key<T>& k : list) {
    if (k.type.presence == Presence::optional)
      if (const std::optional<Node> fallback = k.write(T{}); fallback && fallback->kind != Node::Kind::map)
        k.type.fallback = to_flow_yaml(*fallback);
    described->keys.push_back(k.type);
  }
  Type type{.kind = Type::Kind::section};
  type.section = described;
  // The keys are shared, because copies of codecs within codecs would double at every level.
  const auto keys = std::make_shared<const std::vector<Key<T>>>(std::move(list));
  return {type,
          [keys, type, rule](T& object, const Node& node, Reader& reader) {
            if (node.kind != Node::Kind::map) fail_form(node, type, reader);
            const std::size_t errors_before = reader.errors();
            if constexpr (requires { object.node = &node; }) object.node = &node;
            if constexpr (requires { object.mark = node.mark; }) object.mark = node.mark;
            for (const Node& member : node.items) {
              if (reader.gives_up()) return;
              const Reader::Step step(reader, member.key);
              try {
                (*keys)[find_key(member, *type.section, reader)].read(object, member, reader);
              } catch (const InputError& error) {
                reader.note(error);
              }
            }
            require_keys(node, *type.section, reader);
            if (rule && reader.errors() == errors_before) rule(object, node, reader);
          },
          [keys](const T& object) -> std::optional<Node> {
            std::vector<Node> items;
            for (const Key<T>& k : *keys)
              if (k.type.presence != Presence::future)
                if (std::optional<Node> item = k.write(object))
                  items.push_back(std::move(*item).named(k.type.name));
            return Node::map(std::move(items));
          }};
}

/// Makes the codec of a map from at most `most` names to sections. T has a member `name`. The order is that
/// of the file.
template <class T>
Codec<std::vector<T>> named(Codec<T> codec, std::int64_t most) {
  Type type{.kind = Type::Kind::named, .most = most};
  type.parts.push_back(codec.type);
  return {type,
          [codec, type](std::vector<T>& values, const Node& node, Reader& reader) {
            if (node.kind != Node::Kind::map || std::ssize(node.items) > type.most)
              fail_form(node, type, reader);
            for (const Node& member : node.items) {
              const Reader::Step step(reader, member.key);
              try {
                if (!is_identifier(member.key))
                  reader.fail(member.key_mark, "must be " + identifier().type.pattern_words);
                codec.read(values.emplace_back(), member, reader);
                values.back().name = member.key;
              } catch (const InputError& error) {
                reader.note(error);
              }
            }
          },
          [codec](const std::vector<T>& values) -> std::optional<Node> {
            if (values.empty()) return {};
            std::vector<Node> items;
            for (const T& value : values) items.push_back(std::move(*codec.write(value)).named(value.name));
            return Node::map(std::move(items));
          }};
}

}  // namespace scree
