// A page of HTML that needs nothing but itself.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scree::report {

/// Text with what HTML would take for its own written out.
std::string escaped(std::string_view text);

/// The whole page: its head with the style, and the body, which is HTML.
std::string page(std::string_view title, std::string_view body);

/// A part of it under a heading; nothing if there is nothing in it.
std::string section(std::string_view title, std::string_view content);

/// Cells are HTML. The first row is the head.
std::string table(const std::vector<std::vector<std::string>>& rows);

/// A picture with the PNG file in it. Throws RunError if that cannot be read.
std::string picture(const std::filesystem::path& png, std::string_view caption);

/// A picture with the SVG in it.
std::string drawing(std::string_view svg, std::string_view title, std::string_view caption);

/// What is shown when it is asked for.
std::string folded(std::string_view summary, std::string_view content);

}  // namespace scree::report
