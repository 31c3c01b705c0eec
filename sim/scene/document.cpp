// The parser of YAML text. It makes a tree of the events of yaml-cpp, and refuses what yaml-cpp accepts
// wrongly. No other file includes yaml-cpp.
#include "sim/scene/document.hpp"

#include "sim/scene/scalar.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <utility>

namespace scree {
namespace {

constexpr int max_depth = 32;
constexpr std::int64_t max_copied_nodes = 100'000;
constexpr std::int64_t max_copied_bytes = 10'000'000;
constexpr std::size_t max_key = 200;  // bytes; yaml-cpp finds no `:` beyond 1024, escapes included

SourceMark to_mark(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// Returns whether the second byte of a sequence of three or four is in the range that excludes overlong
/// forms, surrogates and what lies beyond U+10FFFF.
bool is_second_byte(unsigned lead, unsigned second) {
  switch (lead) {
    case 0xE0:
      return second >= 0xA0;
    case 0xED:
      return second <= 0x9F;
    case 0xF0:
      return second >= 0x90;
    case 0xF4:
      return second <= 0x8F;
    default:
      return true;
  }
}

/// Returns the length of the UTF-8 sequence that starts at `at`, or 0 if there is none (RFC 3629, section 4).
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
  };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xC0u) == 0x80u; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF && continues(1)) return 2;
  if (!is_second_byte(lead, byte(1))) return 0;
  if (lead >= 0xE0 && lead <= 0xEF && continues(1) && continues(2)) return 3;
  if (lead >= 0xF0 && lead <= 0xF4 && continues(1) && continues(2) && continues(3)) return 4;
  return 0;
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

/// Returns whether the document is a map in braces, as in JSON, which may be indented with tabs.
bool is_in_braces(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

/// Returns the value of the four hexadecimal digits of an escape \uXXXX at `at`, or nothing if there is no
/// such escape.
std::optional<unsigned> escaped_unit(std::string_view text, std::size_t at) {
  if (text.size() < at + 6 || text.substr(at, 2) != "\\u") return {};
  unsigned unit = 0;
  const char* end = text.data() + at + 6;
  if (std::from_chars(text.data() + at + 2, end, unit, 16).ptr != end) return {};
  return unit;
}

/// Replaces surrogate pairs by single escapes. JSON writes a character beyond U+FFFF as two escapes, a
/// surrogate pair (RFC 8259, section 7), YAML as one of eight digits.
std::string join_surrogates(std::string_view text) {
  std::string joined;
  joined.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const unsigned high = escaped_unit(text, at).value_or(0);
    const unsigned low = escaped_unit(text, at + 6).value_or(0);
    if (high >= 0xD800 && high < 0xDC00 && low >= 0xDC00 && low < 0xE000) {
      joined += fmt::format("\\U{:08X}", 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00));
      at += 12;
      continue;
    }
    const std::size_t taken = text[at] == '\\' ? 2 : 1;  // a backslash may escape another one
    joined += text.substr(at, taken);
    at += taken;
  }
  return joined;
}

/// Throws SyntaxError for wrong characters. yaml-cpp itself replaces bad bytes, stops at a control-D and
/// accepts tabs where YAML does not, all without an error. `tabs`: tabs are allowed in the indentation.
void check_characters(std::string_view text, bool tabs) {
  SourceMark mark{1, 1};
  bool indentation = true;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0)
      throw SyntaxError{mark,
                        fmt::format("byte 0x{:02X} is not UTF-8 text", static_cast<unsigned char>(text[at]))};
    const char c = text[at];
    if ((c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r') || c == 0x7F)
      throw SyntaxError{mark, fmt::format("control character 0x{:02X} in the text", static_cast<int>(c))};
    if (c == '\t' && indentation && !tabs) {
      const std::size_t next = text.find_first_not_of(" \t\r", at);
      if (next != std::string_view::npos && text[next] != '\n' && text[next] != '#')
        throw SyntaxError{mark, "a tab in the indentation; YAML is indented with spaces"};
      indentation = false;  // nothing but blanks and comments follows
    }
    if (c != ' ') indentation = false;
    at += length;
    ++mark.column;
    if (c == '\n') {
      mark = {mark.line + 1, 1};
      indentation = true;
    }
  }
}

struct Extent {
  std::int64_t nodes = 1;
  std::int64_t bytes = 0;  ///< bytes of text
  int depth = 1;
};

Extent extent_of(const Node& node) {
  Extent extent{.bytes = std::ssize(node.text) + std::ssize(node.key)};
  for (const Node& item : node.items) {
    const Extent part = extent_of(item);
    extent.nodes += part.nodes;
    extent.bytes += part.bytes;
    extent.depth = std::max(extent.depth, 1 + part.depth);
  }
  return extent;
}

void refuse_duplicates(const Node& map) {
  std::vector<const Node*> sorted;
  sorted.reserve(map.items.size());
  for (const Node& item : map.items) sorted.push_back(&item);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Node* a, const Node* b) { return a->key < b->key; });
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end(),
                                        [](const Node* a, const Node* b) { return a->key == b->key; });
  if (twice == sorted.end()) return;
  const SourceMark first = twice[0]->key_mark;
  throw SyntaxError{twice[1]->key_mark, fmt::format("{}: duplicate key, already given at {}:{}",
                                                    twice[0]->key, first.line, first.column)};
}

/// Builds the tree from the parser's events. The copies that anchors hold and that aliases add are bounded,
/// so no file can make the tree much larger than itself.
class TreeBuilder final : public YAML::EventHandler {
 public:
  Node root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(leaf(mark), anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end()) throw SyntaxError{to_mark(mark), "an alias inside its own anchor"};
    const auto& [node, extent] = found->second;
    count_copy(aliased_, extent, to_mark(mark), "aliases add");
    check_depth(to_mark(mark), extent.depth);
    add(node, 0);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const Meaning meaning = meaning_of(mark, tag, value);
    // The text of the file is UTF-8, but yaml-cpp turns these two escapes into single bytes.
    if (!is_utf8(value)) throw SyntaxError{to_mark(mark), "the escape \\N or \\_; write \\x85 or \\xA0"};
    Node node = leaf(mark);
    if (meaning != Meaning::nothing) {
      node.kind = Node::Kind::scalar;
      node.quoted = meaning == Meaning::text;
      node.text = value;
    }
    add(std::move(node), anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    if (tag != yaml_tag("seq")) refuse_tag(mark, tag);
    open(mark, anchor, Node::Kind::list);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    if (tag != yaml_tag("map")) refuse_tag(mark, tag);
    open(mark, anchor, Node::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    Node node;
    YAML::anchor_t anchor = 0;
    std::optional<Node> key;  ///< key of the map item whose value comes next
  };

  static void count_copy(Extent& copies, const Extent& extent, const SourceMark& mark, const char* what) {
    copies.nodes += extent.nodes;
    copies.bytes += extent.bytes;
    if (copies.nodes > max_copied_nodes)
      throw SyntaxError{mark, fmt::format("{} more than {} nodes", what, max_copied_nodes)};
    if (copies.bytes > max_copied_bytes)
      throw SyntaxError{mark, fmt::format("{} more than {} bytes", what, max_copied_bytes)};
  }
  static Node leaf(const YAML::Mark& mark) {
    Node node;
    node.mark = to_mark(mark);
    return node;
  }
  static std::string yaml_tag(const char* name) { return fmt::format("tag:yaml.org,2002:{}", name); }
  static void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (!tag.empty() && tag != "?")
      throw SyntaxError{
          to_mark(mark),
          fmt::format("tag {} (the scene language has no tags but those of YAML's core schema)", tag)};
  }

  enum class Meaning { text, plain, nothing };

  /// Returns what a scalar is by its tag, which must be one of YAML's own (core schema, section 10.3.2) or
  /// absent. From yaml-cpp a quoted scalar has the tag "!", as has one that is written with this tag, and a
  /// plain one has "?".
  static Meaning meaning_of(const YAML::Mark& mark, const std::string& tag, const std::string& value) {
    if (tag == "!" || tag == yaml_tag("str")) return Meaning::text;
    const auto require = [&](bool fits) {
      if (!fits) throw SyntaxError{to_mark(mark), fmt::format("the text is not what its tag {} says", tag)};
    };
    if (tag == yaml_tag("null")) {
      require(is_null_word(value));
      return Meaning::nothing;
    }
    if (tag == yaml_tag("bool")) {
      require(truth_of(value).has_value());
    } else if (tag == yaml_tag("int")) {
      require(is_whole_number(value));
    } else if (tag == yaml_tag("float")) {
      require(is_number(value));
    } else {
      refuse_tag(mark, tag);
    }
    return Meaning::plain;
  }
  void check_depth(const SourceMark& mark, int more) const {
    if (static_cast<int>(open_.size()) + more > max_depth)
      throw SyntaxError{mark, fmt::format("nested deeper than {} levels", max_depth)};
  }
  void open(const YAML::Mark& mark, YAML::anchor_t anchor, Node::Kind kind) {
    check_depth(to_mark(mark), 1);
    open_.push_back({leaf(mark), anchor, {}});
    open_.back().node.kind = kind;
  }
  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    done.node.items.shrink_to_fit();
    if (done.node.kind == Node::Kind::map) refuse_duplicates(done.node);
    add(std::move(done.node), done.anchor);
  }
  void add(Node node, YAML::anchor_t anchor) {
    if (anchor != 0) {
      const Extent extent = extent_of(node);
      count_copy(held_, extent, node.mark, "anchors hold");
      anchored_[anchor] = {node, extent};
    }
    if (open_.empty()) {
      root = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Node::Kind::map) {
      if (!parent.key) {
        if (node.kind != Node::Kind::scalar) throw SyntaxError{node.mark, "a key must be a name"};
        if (node.text.size() > max_key)
          throw SyntaxError{node.mark, fmt::format("a key longer than {} bytes", max_key)};
        parent.key = std::move(node);
        return;
      }
      node.key = std::move(parent.key->text);
      node.key_mark = parent.key->mark;
      parent.key.reset();
    }
    parent.node.items.push_back(std::move(node));
  }

  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::pair<Node, Extent>> anchored_;
  Extent held_{.nodes = 0};     // extent of the copies that anchors hold; nested ones count again
  Extent aliased_{.nodes = 0};  // extent of the copies that aliases add
};

}  // namespace

const Node* Node::find(std::string_view name) const {
  if (kind != Kind::map) return nullptr;
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Node& item) { return item.key == name; });
  return found == items.end() ? nullptr : &*found;
}

Node* Node::find(std::string_view name) { return const_cast<Node*>(std::as_const(*this).find(name)); }

Node Node::scalar(std::string text, bool quoted) {
  Node node;
  node.kind = Kind::scalar;
  node.quoted = quoted;
  node.text = std::move(text);
  return node;
}

Node Node::list(std::vector<Node> items) {
  Node node;
  node.kind = Kind::list;
  node.items = std::move(items);
  return node;
}

Node Node::map(std::vector<Node> items) {
  Node node = list(std::move(items));
  node.kind = Kind::map;
  return node;
}

Node Node::named(std::string name) && {
  key = std::move(name);
  return std::move(*this);
}

Node parse_document(const std::string& text) {
  const bool in_braces = is_in_braces(text);
  check_characters(text, in_braces);
  TreeBuilder builder;
  try {
    std::istringstream stream(in_braces ? join_surrogates(text) : text);
    YAML::Parser parser(stream);
    if (parser.HandleNextDocument(builder)) {
      TreeBuilder second;
      if (parser.HandleNextDocument(second))
        throw SyntaxError{second.root.mark, "a second YAML document; a scene is one document"};
    }
  } catch (const YAML::Exception& error) {
    throw SyntaxError{to_mark(error.mark), "broken YAML: " + error.msg};
  }
  return std::move(builder.root);
}

}  // namespace scree
