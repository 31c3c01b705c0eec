#include "sim/record/report/plots.hpp"

#include "core/error.hpp"
#include "core/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace scree::report {

namespace {

constexpr std::size_t most_rows = 1200;  // rows of a curve; the picture is 560 pixels wide

constexpr const char* plot_style =
    "set grid lc rgb '#e6e6e6'\n"
    "set border lc rgb '#555555'\n"
    "set key above left horizontal noenhanced samplen 1.5\n"
    "set xlabel 'time (s)'\n"
    "set format y '%g'\n";

// Colours that can be told apart by their lightness too (Okabe and Ito 2008).
constexpr const char* colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                  "#e69f00", "#56b4e9", "#000000", "#888888"};

/// Returns the text in single quotes.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + '\'';
}

bool is_drawn(const Plot& plot, double value) {
  return std::isfinite(value) && (!plot.is_logarithmic || value > 0);
}

std::string script_of(const Plot& plot, std::size_t number) {
  std::string script = fmt::format(
      "reset\n{}set terminal svg size 560,340 dynamic font 'DejaVu Sans,13' background 'white' name "
      "'plot{}'\n"
      "set output\n",
      plot_style, number);
  const auto out = std::back_inserter(script);
  fmt::format_to(out, "set ylabel {} noenhanced\n", in_quotes(plot.unit));
  if (plot.is_logarithmic) script += "set logscale y\nset format y '10^{%L}'\n";
  std::string lines;
  for (std::size_t k = 0; k < plot.curves.size(); ++k) {
    const Curve& curve = plot.curves[k];
    fmt::format_to(out, "$curve{} << END\n", k);
    for (const std::size_t row : rows_to_draw(curve.values, most_rows)) {
      const double value = curve.values[row];
      // An empty line makes gnuplot interrupt the curve.
      if (is_drawn(plot, value))
        fmt::format_to(out, "{} {}\n", plot.time[row], value);
      else
        script += '\n';
    }
    script += "END\n";
    fmt::format_to(std::back_inserter(lines), "{}$curve{} with lines lw 2 lc rgb '{}' title {}",
                   k == 0 ? "plot " : ", ", k, colors[k % std::size(colors)], in_quotes(curve.title));
  }
  return script + lines + "\nset output\n";
}

}  // namespace

std::vector<std::size_t> rows_to_draw(const Column& values, std::size_t most) {
  const std::size_t n = values.size();
  std::vector<std::size_t> rows;
  if (n <= most) {
    for (std::size_t k = 0; k < n; ++k) rows.push_back(k);
    return rows;
  }
  const std::size_t runs = std::max<std::size_t>(most / 2, 1);
  for (std::size_t r = 0; r < runs; ++r) {
    const std::size_t begin = r * n / runs, end = (r + 1) * n / runs;
    std::size_t least = begin, greatest = begin;
    for (std::size_t k = begin; k < end; ++k) {
      if (std::isnan(values[least]) || values[k] < values[least]) least = k;
      if (std::isnan(values[greatest]) || values[k] > values[greatest]) greatest = k;
    }
    rows.push_back(std::min(least, greatest));
    if (least != greatest) rows.push_back(std::max(least, greatest));
  }
  return rows;
}

std::vector<std::string> draw(const std::vector<Plot>& plots) {
  std::string script;
  for (std::size_t k = 0; k < plots.size(); ++k) script += script_of(plots[k], k);
  const std::string output = run_program({"gnuplot"}, script);
  std::vector<std::string> pictures;
  constexpr std::string_view first = "<svg", last = "</svg>";
  for (std::size_t at = 0; (at = output.find(first, at)) != std::string::npos;) {
    const std::size_t end = output.find(last, at);
    if (end == std::string::npos) break;
    pictures.push_back(output.substr(at, end + last.size() - at));
    at = end;
  }
  if (pictures.size() != plots.size())
    throw RunError(fmt::format("gnuplot drew {} of {} plots", pictures.size(), plots.size()));
  return pictures;
}

}  // namespace scree::report
