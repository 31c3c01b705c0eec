#include "sim/scene/variations.hpp"

#include "core/error.hpp"
#include "sim/scene/text_lines.hpp"

#include <fmt/format.h>

#include <string_view>

namespace scree {

namespace {

/// Splits the text at the commas that are not within brackets or braces.
std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  int depth = 0;
  for (std::size_t k = 0; k <= text.size(); ++k) {
    const char c = k < text.size() ? text[k] : ',';
    depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    if (c != ',' || (depth > 0 && k < text.size())) continue;
    parts.emplace_back(trimmed(text.substr(start, k - start)));
    start = k + 1;
  }
  return parts;
}

}  // namespace

Variation parse_variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw InputError(fmt::format("--vary {}: not KEY=V1,V2,...", text));
  std::string_view values = trimmed(std::string_view(text).substr(equals + 1));
  if (values.starts_with('[') && values.ends_with(']')) values = values.substr(1, values.size() - 2);
  Variation variation{text.substr(0, equals), split(values)};
  for (const std::string& value : variation.values) {
    if (value.empty()) throw InputError(fmt::format("--vary {}: a value is missing", text));
  }
  return variation;
}

std::vector<std::vector<Override>> combinations(const std::vector<Variation>& variations) {
  std::vector<std::vector<Override>> all(1);
  for (const Variation& variation : variations) {
    std::vector<std::vector<Override>> longer;
    for (const std::vector<Override>& shorter : all) {
      for (const std::string& value : variation.values) {
        longer.push_back(shorter);
        longer.back().push_back({variation.key, value});
      }
    }
    all = std::move(longer);
  }
  return all;
}

std::string describe(const std::vector<Override>& settings) {
  std::string words;
  for (const Override& set : settings) {
    words += fmt::format("{}{}={}", words.empty() ? "" : " ", set.path, set.value);
  }
  return words;
}

}  // namespace scree
