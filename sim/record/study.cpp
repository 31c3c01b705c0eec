#include "sim/record/study.hpp"

#include "sim/record/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace scree {

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
/// Errors below this value are rounding: they are left out of the fit of the order, and are drawn at this
/// value.
constexpr double rounding = 1e-12;

double number_of(const std::string& text) {
  double value = no_number;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size() ? value : no_number;
}

/// Returns the error for comparisons and plots, in which all errors that are rounding are equal.
double seen_error(const StudyPoint& point, std::size_t check) {
  return std::max(point.error(check), rounding);
}

/// Returns the text as a field of a CSV file, in quotes if it needs them.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

/// Returns the text so that it can be put between single quotes in a gnuplot script.
std::string plain(std::string text) {
  std::ranges::replace(text, '\'', ' ');
  return text;
}

}  // namespace

double StudyPoint::error(std::size_t check) const {
  if (check >= checks.size() || !std::isfinite(checks[check].error)) return HUGE_VAL;
  return checks[check].error;
}

std::vector<std::string> Study::checks() const {
  std::vector<std::string> words;
  const auto ran = std::ranges::find_if(points, [](const StudyPoint& p) { return !p.checks.empty(); });
  if (ran == points.end()) return words;
  for (const CheckResult& check : ran->checks) words.push_back(check.check);
  return words;
}

bool Study::has_no_error(std::size_t check) const {
  return std::ranges::any_of(points, [check](const StudyPoint& point) {
    return check < point.checks.size() && std::isfinite(point.checks[check].measured) &&
           !std::isfinite(point.checks[check].error);
  });
}

std::vector<std::size_t> pareto_front(const Study& study, std::size_t check) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    if (std::isfinite(study.points[k].error(check)) && std::isfinite(study.points[k].cost))
      order.push_back(k);
  }
  std::ranges::sort(order, {}, [&](std::size_t k) {
    return std::tuple(study.points[k].cost, seen_error(study.points[k], check), k);
  });
  std::vector<std::size_t> front;
  for (const std::size_t k : order) {
    if (front.empty() || seen_error(study.points[k], check) < seen_error(study.points[front.back()], check))
      front.push_back(k);
  }
  return front;
}

std::vector<Curve> curves_of(const Study& study) {
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const std::vector<Override>& settings = study.points[k].settings;
    const std::string others =
        settings.empty() ? "" : describe(std::vector<Override>(settings.begin() + 1, settings.end()));
    auto curve = std::ranges::find(curves, others, &Curve::settings);
    if (curve == curves.end()) curve = curves.insert(curves.end(), {others, {}});
    curve->points.push_back(k);
  }
  return curves;
}

double fitted_order(const Study& study, const Curve& curve, std::size_t check) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const std::size_t k : curve.points) {
    const StudyPoint& point = study.points[k];
    const double value = point.settings.empty() ? no_number : number_of(point.settings.front().value);
    const double error = point.error(check);
    if (!(value > 0) || !(error > rounding) || !std::isfinite(error)) continue;
    const double lx = std::log(value);
    const double ly = std::log(error);
    n += 1;
    x += lx;
    y += ly;
    xx += lx * lx;
    xy += lx * ly;
  }
  const double spread = n * xx - x * x;
  return n >= 3 && spread > 0 ? (n * xy - x * y) / spread : no_number;
}

std::vector<Reached> cheapest_to(const Study& study, std::size_t check) {
  std::vector<Reached> reached;
  const std::vector<std::size_t> front = pareto_front(study, check);
  if (front.empty()) return reached;
  for (const std::size_t k : front) {
    // The least power of ten that this point reaches and that the cheaper points do not.
    const double error = std::pow(10.0, std::ceil(std::log10(seen_error(study.points[k], check))));
    if (reached.empty() || error < reached.back().error) reached.push_back({error, k});
  }
  return reached;
}

std::string to_csv(const Study& study) {
  std::string csv;
  for (const Variation& variation : study.variations) csv += field(variation.key) + ',';
  csv += "wall_s_per_simulated_s,problem";
  for (const std::string& check : study.checks()) csv += ',' + field("error: " + check);
  csv += '\n';
  for (const StudyPoint& point : study.points) {
    for (const Override& set : point.settings) csv += field(set.value) + ',';
    csv += fmt::format("{},{}", point.cost, field(point.problem));
    for (std::size_t k = 0; k < study.checks().size(); ++k) csv += fmt::format(",{}", point.error(k));
    csv += '\n';
  }
  return csv;
}

std::string to_json(const Study& study) {
  Json json = {{"scene", study.scene}, {"vary", Json::object()}, {"points", Json::array()}};
  for (const Variation& variation : study.variations) json["vary"][variation.key] = variation.values;
  for (const StudyPoint& point : study.points) {
    Json row = {{"settings", Json::object()}, {"wall_s_per_simulated_s", point.cost}};
    for (const Override& set : point.settings) row["settings"][set.path] = set.value;
    if (!point.problem.empty()) row["problem"] = point.problem;
    row["checks"] = Json::array();
    for (const CheckResult& check : point.checks) row["checks"].push_back(json_of(check));
    json["points"].push_back(row);
  }
  const std::vector<std::string> checks = study.checks();
  json["checks"] = Json::array();
  for (std::size_t k = 0; k < checks.size(); ++k) {
    Json orders = Json::array();
    for (const Curve& curve : curves_of(study))
      orders.push_back({{"settings", curve.settings}, {"order", fitted_order(study, curve, k)}});
    json["checks"].push_back({{"check", checks[k]}, {"front", pareto_front(study, k)}, {"orders", orders}});
  }
  return json.dump(2) + '\n';
}

std::string plot_script(const Study& study, std::size_t check, const std::string& name) {
  std::string script = "# Run by gnuplot: draws the SVG and the PNG beside it.\n";
  double lowest = HUGE_VAL, highest = -HUGE_VAL;  // powers of ten
  const auto add_block = [&](const std::string& block, const std::vector<std::size_t>& points) {
    script += fmt::format("${} << END\n", block);
    for (const std::size_t k : points) {
      const StudyPoint& point = study.points[k];
      if (!std::isfinite(point.error(check)) || !std::isfinite(point.cost)) continue;
      script += fmt::format("{} {}\n", point.cost, seen_error(point, check));
      lowest = std::min(lowest, std::ceil(std::log10(seen_error(point, check))) - 1);
      highest = std::max(highest, std::ceil(std::log10(seen_error(point, check))));
    }
    script += "END\n";
  };
  const std::vector<Curve> curves = curves_of(study);
  std::string lines;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const bool drawn = std::ranges::any_of(curves[k].points, [&](std::size_t p) {
      return std::isfinite(study.points[p].error(check)) && std::isfinite(study.points[p].cost);
    });
    if (!drawn) continue;
    add_block(fmt::format("curve{}", k), curves[k].points);
    const std::string title = curves[k].settings.empty() ? study.variations.front().key : curves[k].settings;
    lines += fmt::format(", \\\n  $curve{} with linespoints lw 3 pt 7 ps 1 title '{}'", k, plain(title));
  }
  add_block("front", pareto_front(study, check));
  script += fmt::format(
      "set logscale xy\n"
      "set format xy '10^{{%T}}'\n"
      "set grid lc rgb '#e8e8e8'\n"
      "set key bmargin center horizontal noenhanced\n"
      "set bmargin 7\n"
      "set colorsequence podo\n"
      "set title '{}: error of {}' noenhanced\n"
      "set xlabel 'wall time per simulated second (s)'\n"
      "set ylabel 'error (under {:g}: rounding)'\n"
      "set yrange [1e{}:1e{}]\n",
      plain(study.scene), plain(study.checks().at(check)), rounding, lowest, std::max(highest, lowest + 1));
  for (const auto& [terminal, extension] :
       {std::pair("svg size 900,640 background 'white' font 'DejaVu Sans,13'", "svg"),
        std::pair("pngcairo size 1350,960 font 'DejaVu Sans,14'", "png")}) {
    script += fmt::format(
        "set terminal {}\nset output '{}.{}'\n"
        "plot $front with steps lw 9 lc rgb '#dddddd' title 'front'{}\n",
        terminal, name, extension, lines);
  }
  return script;
}

}  // namespace scree
