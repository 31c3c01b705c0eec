// A page of HTML that needs no other files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scree::report {

/// Returns the text with the characters that have a meaning in HTML replaced by their entities.
std::string escaped(std::string_view text);

/// Returns the whole page: a head with the style, and the body, which is HTML.
std::string page(std::string_view title, std::string_view body);

/// Returns a part of the page under a heading; an empty text if there is no content.
std::string section(std::string_view title, std::string_view content);

/// Returns a table. Its cells are HTML, and the first row is the head.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// Returns a figure that contains the bytes of the PNG file. Throws RunError if the file cannot be read.
std::string picture(const std::filesystem::path& png, std::string_view caption);

/// Returns a figure that contains the SVG.
std::string drawing(std::string_view svg, std::string_view title, std::string_view caption);

/// Returns content that is folded under a summary until the reader opens it.
std::string folded(std::string_view summary, std::string_view content);

}  // namespace scree::report
