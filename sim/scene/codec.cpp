// Codecs of single values, and the messages about keys that are unknown or missing.
#include "sim/scene/codec.hpp"

#include "sim/scene/scalar.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <type_traits>

namespace scree {
namespace {

/// The largest whole number of 64 bits that can be converted to a T.
template <class T>
constexpr auto most_whole = static_cast<std::uint64_t>(
    std::is_integral_v<T> ? static_cast<std::uint64_t>(std::numeric_limits<T>::max()) : UINT64_MAX);

/// Reads a whole plain scalar as a T. The forms allowed are those of YAML's core schema.
template <class T>
T parse_plain(const Node& node, const Type& type, const Reader& reader) {
  if (!has_form(node, type)) fail_form(node, type, reader);
  if (const std::optional<std::uint64_t> whole = in_other_base(node.text); whole && *whole <= most_whole<T>)
    return static_cast<T>(*whole);
  std::string_view text = node.text;
  if (text[0] == '+') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    reader.fail(node.mark, fmt::format("{} is out of range", shown(node)));
  if (error != std::errc{} || end != text.data() + text.size()) fail_form(node, type, reader);
  // The whole number -0 is read as 0, as other programs do that a scene may have gone through; -0.0 keeps its
  // sign.
  return value == T{} && is_whole_number(node.text) ? T{} : value;
}

template <class T>
std::string number_text(const T& value) {
  if constexpr (std::is_same_v<T, double>)
    if (value == 0 && std::signbit(value)) return "-0.0";
  return fmt::format("{}", value);
}

template <class T>
Codec<T> numeric(const Type& type) {
  return {type,
          [type](T& value, const Node& node, Reader& reader) {
            value = parse_plain<T>(node, type, reader);
            const auto as_double = static_cast<double>(value);
            if (!std::isfinite(as_double) || !type.range.holds(as_double)) fail_form(node, type, reader);
          },
          [](const T& value) { return std::optional(Node::scalar(number_text(value))); }};
}

template <class T>
Codec<T> whole(const Range& range) {
  return numeric<T>({.kind = Type::Kind::integer, .range = range});
}

Codec<std::string> text_like(std::string pattern, std::string words, bool (*allowed)(std::string_view)) {
  Type type{.kind = Type::Kind::text};
  type.pattern = std::move(pattern);
  type.pattern_words = std::move(words);
  return {type,
          [type, allowed](std::string& value, const Node& node, Reader& reader) {
            if (node.kind != Node::Kind::scalar || !allowed(node.text)) fail_form(node, type, reader);
            value = node.text;
          },
          [](const std::string& value) -> std::optional<Node> {
            if (value.empty()) return {};
            return Node::scalar(value, !is_identifier(value));
          }};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

Codec<double> number(const Range& range, std::string unit) {
  return numeric<double>({.kind = Type::Kind::number, .range = range, .unit = std::move(unit)});
}
Codec<std::int64_t> large_integer(const Range& range) { return whole<std::int64_t>(range); }
Codec<std::uint64_t> seed_integer() { return whole<std::uint64_t>(not_negative); }
Codec<int> integer(const Range& range) { return whole<int>(range); }
Codec<bool> boolean() { return word<bool>({{"true", true}, {"false", false}, {"on", true}, {"off", false}}); }

Codec<std::string> identifier() {
  return text_like("^[A-Za-z_][A-Za-z0-9_-]*$", "a name: a letter or _, then letters, digits, _ and -",
                   is_identifier);
}
Codec<std::string> file_name() {
  return text_like("^[^./\\u0000-\\u001f][^/\\u0000-\\u001f]*$",
                   "a name without slashes, not starting with a dot", is_file_name);
}
Codec<std::string> text() {
  return text_like({}, {}, [](std::string_view) { return true; });
}

bool is_identifier(std::string_view word) {
  return !word.empty() && is_letter(word[0]) && std::all_of(word.begin(), word.end(), [](char c) {
    return is_letter(c) || is_digit(c) || c == '-';
  });
}

bool is_file_name(std::string_view word) {
  return !word.empty() && word[0] != '.' && std::all_of(word.begin(), word.end(), [](char c) {
    return c != '/' && static_cast<unsigned char>(c) >= ' ';
  });
}

void fail_form(const Node& node, const Type& type, const Reader& reader) {
  const bool is_for_quotes = node.quoted && has_form(Node::scalar(node.text), type);
  reader.fail(node.mark, fmt::format("must be {}, not {}{}", words_of(type), shown(node),
                                     is_for_quotes ? ", which is text: take the quotes away" : ""));
}

std::size_t read_word(const Node& node, const Type& type, const Reader& reader) {
  if (const std::optional<std::size_t> word = find_word(node, type)) return *word;
  if (node.kind != Node::Kind::scalar || has_form(Node::scalar(node.text), type))
    fail_form(node, type, reader);
  reader.fail(node.mark, fmt::format("must be {}, not {}{}", words_of(type), shown(node),
                                     suggestion(node.text, {type.words.begin(), type.words.end()})));
}

Type word_type(std::vector<std::string> words) {
  Type type{.kind = Type::Kind::word};
  type.words = std::move(words);
  return type;
}

Type list_type(const Type& item, std::int64_t least, std::int64_t most) {
  Type type{.kind = Type::Kind::list, .least = least, .most = most};
  type.parts.push_back(item);
  return type;
}

std::size_t find_key(const Node& member, const SectionType& section, Reader& reader) {
  const auto found = std::find_if(section.keys.begin(), section.keys.end(),
                                  [&](const KeyType& key) { return key.name == member.key; });
  if (found == section.keys.end()) {
    std::vector<std::string_view> known;
    for (const KeyType& key : section.keys) known.push_back(key.name);
    std::string hint = hint_for(section.name, member.key, known);
    if (hint.empty()) hint = fmt::format(" (known here: {})", fmt::join(known, ", "));
    reader.fail(member.key_mark, "unknown key" + hint);
  }
  if (found->presence == Presence::future) reader.fail(member.key_mark, future_text);
  return static_cast<std::size_t>(found - section.keys.begin());
}

void require_keys(const Node& node, const SectionType& section, Reader& reader) {
  for (const KeyType& key : section.keys) {
    if (key.presence != Presence::required || node.find(key.name)) continue;
    const Reader::Step step(reader, key.name);
    reader.fail(node.mark, fmt::format("is missing; it must be {}", words_of(key.type)));
  }
}

}  // namespace scree
