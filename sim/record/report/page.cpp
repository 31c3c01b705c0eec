#include "sim/record/report/page.hpp"

#include "core/error.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace scree::report {

namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light; --ink: #1d2329; --soft: #5b6670; --line: #dde2e6; --paper: #fff; --ground: #f4f6f7;
        --good: #1a7f4b; --bad: #b3261e; --warn: #8a5a00; --bar: #0072b2; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1rem 4rem; max-width: 76rem; background: var(--ground); color: var(--ink);
       font: 16px/1.5 system-ui, 'DejaVu Sans', sans-serif; }
h1 { margin: 0; font-size: 1.9rem; line-height: 1.2; overflow-wrap: anywhere; }
h2 { margin: 2.4rem 0 .8rem; font-size: 1.25rem; }
h3 { margin: 0; font-size: 1rem; }
p { margin: .3rem 0; }
.lead { color: var(--soft); }
.status { display: inline-block; padding: .1rem .6rem; border-radius: 1rem; color: #fff; font-size: .95rem;
          vertical-align: .25rem; background: var(--warn); }
.status.done { background: var(--good); } .status.failed { background: var(--bad); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(10.5rem, 1fr)); gap: .7rem; margin: 1.2rem 0; }
.tile, figure, .notice, .box { background: var(--paper); border: 1px solid var(--line); border-radius: .5rem; }
.tile { padding: .6rem .8rem; } .tile b { display: block; font-size: 1.25rem; font-variant-numeric: tabular-nums; }
.tile span { color: var(--soft); font-size: .85rem; }
.notice { margin: .5rem 0; padding: .6rem .9rem; border-left: .35rem solid var(--warn); overflow-wrap: anywhere; }
.notice.bad { border-left-color: var(--bad); } .notice.good { border-left-color: var(--good); }
.grid { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr)); gap: .9rem; }
.grid.wide { grid-template-columns: repeat(auto-fill, minmax(min(100%, 30rem), 1fr)); }
figure { margin: 0; padding: .7rem; min-width: 0; }
figure img, figure svg { display: block; width: 100%; height: auto; border-radius: .25rem; }
figcaption { margin-top: .4rem; color: var(--soft); font-size: .88rem; }
.box { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; font-size: .92rem; font-variant-numeric: tabular-nums; }
th, td { padding: .4rem .7rem; text-align: left; border-top: 1px solid var(--line); vertical-align: top; }
thead th { border-top: 0; color: var(--soft); font-weight: 600; }
.pass { color: var(--good); font-weight: 600; } .fail { color: var(--bad); font-weight: 600; }
.bar { display: block; min-width: 2px; height: .8rem; margin-top: .35rem; border-radius: .2rem; background: var(--bar); }
details { margin: .7rem 0; } summary { cursor: pointer; font-weight: 600; }
pre { margin: .5rem 0; padding: .8rem; overflow-x: auto; background: var(--paper); border: 1px solid var(--line);
      border-radius: .5rem; font-size: .85rem; }
code { overflow-wrap: anywhere; }
@media print { body { background: #fff; max-width: none; } figure, tr { break-inside: avoid; } }
)";

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw RunError(fmt::format("cannot read {}", file.string()));
  return bytes;
}

/// Encodes bytes as in RFC 4648, section 4.
std::string base64(const std::string& bytes) {
  using namespace boost::archive::iterators;
  using Iterator = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Iterator(bytes.begin()), Iterator(bytes.end()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escaped(title), style, body);
}

std::string section(std::string_view title, std::string_view content) {
  if (content.empty()) return {};
  return fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", escaped(title), content);
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"box\"><table>\n<thead>";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const char* cell = r == 0 ? "th" : "td";
    html += "<tr>";
    for (const std::string& text : rows[r]) html += fmt::format("<{}>{}</{}>", cell, text, cell);
    html += r == 0 ? "</tr></thead>\n<tbody>\n" : "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string picture(const std::filesystem::path& png, std::string_view caption) {
  return fmt::format(
      "<figure><img alt=\"{}\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
      escaped(caption), base64(read_bytes(png)), escaped(caption));
}

std::string drawing(std::string_view svg, std::string_view title, std::string_view caption) {
  return fmt::format("<figure><h3>{}</h3>\n{}\n<figcaption>{}</figcaption></figure>\n", escaped(title), svg,
                     escaped(caption));
}

std::string folded(std::string_view summary, std::string_view content) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped(summary), content);
}

}  // namespace scree::report
