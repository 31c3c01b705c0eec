// Error messages of the scene reader: line and column, path of the key, nearest known word.
#include "sim/scene/reader.hpp"

#include "sim/scene/hints.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace scree {
namespace {

constexpr std::size_t most_told = 8;

/// Returns Levenshtein's distance, computed one row at a time; a swap of neighbours counts 2.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t change = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, diagonal + 1, row[j] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
  // Words longer than any name of the language cannot be meant, and would make the search slow.
  if (word.size() > 64) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(word.size() / 3, 2) + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < candidate.size()) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& candidates) {
  const std::string_view near = nearest(word, candidates);
  return near.empty() ? "" : fmt::format(" (did you mean {}?)", near);
}

std::string hint_for(std::string_view section, std::string_view word,
                     const std::vector<std::string_view>& candidates) {
  const std::string_view advice = advice_for(section, word);
  return advice.empty() ? suggestion(word, candidates) : fmt::format("; {}", advice);
}

std::string to_text(const std::vector<PathPart>& path) {
  std::string text;
  for (const PathPart& part : path) {
    if (part.index >= 0) {
      text += fmt::format("[{}]", part.index);
    } else {
      if (!text.empty()) text += '.';
      text += part.key;
    }
  }
  return text;
}

std::string printable(std::string_view text) {
  std::string line;
  for (const char c : text) {
    if ((c >= 0 && c < ' ') || c == 0x7F) {
      line += fmt::format("\\x{:02X}", static_cast<int>(c));
    } else {
      line += c;
    }
  }
  return line;
}

void Reader::fail(const SourceMark& mark, std::string_view what) const {
  const std::string path = to_text(path_);
  throw InputError(printable(fmt::format("{}: {}{}{}", place(mark), path, path.empty() ? "" : ": ", what)));
}

void Reader::fail_at(std::string_view key, const Node& map, std::string_view what) {
  const Node* item = map.find(key);
  const Step step(*this, key);
  fail(item ? item->mark : map.mark, what);
}

void Reader::note(const InputError& error) {
  if (errors_++ < most_told) told_.emplace_back(error.what());
}

void Reader::finish() const {
  if (errors_ == 0) return;
  std::string text = fmt::format("{}", fmt::join(told_, "\n"));
  if (errors_ > told_.size())
    text += fmt::format("\nand {}{} more errors", gives_up() ? "at least " : "", errors_ - told_.size());
  throw InputError(text);
}

// Line 0 marks a value that an override gave; the column is then the number of the override, from 1.
std::string Reader::place(const SourceMark& mark) const {
  if (mark.line > 0) return fmt::format("{}:{}:{}", file_, mark.line, mark.column);
  const Override& set = overrides_.at(static_cast<std::size_t>(mark.column) - 1);
  return fmt::format("--set {}={}", set.path, set.value);
}

void Reader::mark_override(Node& node, std::size_t index) {
  node.mark = node.key_mark = {0, static_cast<int>(index) + 1};
  for (Node& item : node.items) mark_override(item, index);
}

}  // namespace scree
