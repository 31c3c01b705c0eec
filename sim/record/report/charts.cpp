#include "sim/record/report/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace scree::report {

namespace {

constexpr double seen = 1e-9;  // share of the largest curve of a chart below which a curve is rounding
constexpr std::size_t most_curves = 8;  // number of curves that can be told apart in one picture

/// Makes charts from the columns of metrics.csv.
class Charts {
 public:
  explicit Charts(const Columns& metrics) : metrics_(metrics) {}

  /// Returns one column as it is; no curve if there is no such column.
  std::vector<Curve> curve(const std::string& title, const std::string& name) const {
    const Column* column = metrics_.find(name);
    return column == nullptr ? std::vector<Curve>{} : std::vector<Curve>{{title, *column}};
  }
  /// Returns the change of a column since the first row.
  std::vector<Curve> change(const std::string& title, const std::string& name) const {
    std::vector<Curve> curves = curve(title, name);
    for (Curve& c : curves) {
      const double first = c.values.empty() ? 0 : c.values.front();
      for (double& value : c.values) value -= first;
    }
    return curves;
  }
  std::vector<Curve> components(const std::string& name) const {
    return together({curve("x", name + "_x"), curve("y", name + "_y"), curve("z", name + "_z")});
  }
  /// Returns the columns PREFIX name SUFFIX, with the titles `name`.
  std::vector<Curve> each(std::string_view prefix, std::string_view suffix) const {
    std::vector<Curve> curves;
    for (const std::string& name : metrics_.names)
      if (name.size() > prefix.size() + suffix.size() && name.starts_with(prefix) && name.ends_with(suffix))
        curves.push_back(
            {name.substr(prefix.size(), name.size() - prefix.size() - suffix.size()), *metrics_.find(name)});
    return curves;
  }
  static std::vector<Curve> together(std::vector<std::vector<Curve>> parts) {
    std::vector<Curve> all;
    for (auto& part : parts) std::ranges::move(part, std::back_inserter(all));
    return all;
  }

  /// Returns the curves that have more than one value.
  static std::vector<Curve> that_change(std::vector<Curve> curves) {
    std::erase_if(curves, [](const Curve& curve) {
      double least = HUGE_VAL, greatest = -HUGE_VAL;
      for (const double value : curve.values) {
        least = std::fmin(least, value);
        greatest = std::fmax(greatest, value);
      }
      return !(greatest > least);
    });
    return curves;
  }

  void add(Chapter& chapter, Plot plot, std::string caption) const {
    if (plot.time.empty()) plot.time = *metrics_.find("time");
    double largest = 0;
    for (const Curve& curve : plot.curves) largest = std::fmax(largest, magnitude(plot, curve));
    const double least = plot.is_logarithmic ? 0 : seen * largest;
    std::erase_if(plot.curves, [&](const Curve& curve) { return !(magnitude(plot, curve) > least); });
    if (plot.curves.size() > most_curves) {
      fmt::format_to(std::back_inserter(caption), " The first {} of {}.", most_curves, plot.curves.size());
      plot.curves.resize(most_curves);
    }
    if (!plot.curves.empty()) chapter.charts.push_back({std::move(plot), std::move(caption)});
  }

 private:
  /// Returns the largest value that can be drawn.
  static double magnitude(const Plot& plot, const Curve& curve) {
    double largest = 0;
    for (const double value : curve.values)
      if (std::isfinite(value)) largest = std::fmax(largest, plot.is_logarithmic ? value : std::fabs(value));
    return largest;
  }

  const Columns& metrics_;
};

Chapter energy(const Charts& of) {
  Chapter chapter{"Energy", {}};
  of.add(chapter,
         {.title = "Where the energy is, and where it went",
          .unit = "energy (J)",
          .curves = Charts::together(
              {of.curve("kinetic", "energy_kinetic"), of.change("potential, change", "energy_potential"),
               of.curve("lost in impacts", "energy_dissipated_restitution"),
               of.curve("lost to friction", "energy_dissipated_friction"),
               of.curve("lost to correction", "energy_dissipated_correction"),
               of.curve("work done on bodies", "energy_work"),
               of.curve("error of free rotation", "energy_integration"),
               of.curve("of bodies that appeared, less those removed", "energy_exchange")})},
         "Each curve is computed by itself; none is the difference of the others.");
  of.add(chapter,
         {.title = "Unexplained energy",
          .unit = "share of the largest energy",
          .is_logarithmic = true,
          .curves = of.curve("unexplained", "energy_unexplained")},
         "The part of the change that the curves above do not add up to.");
  return chapter;
}

Chapter contacts(const Charts& of) {
  Chapter chapter{"Contacts", {}};
  of.add(chapter,
         {.title = "Overlap",
          .unit = "depth (m)",
          .is_logarithmic = true,
          .curves = Charts::together({of.curve("worst", "penetration_max"),
                                      of.curve("99th percentile", "penetration_p99"),
                                      of.curve("mean", "penetration_mean")})},
         "Of all pairs that overlap at the end of a step, planes included.");
  of.add(chapter,
         {.title = "Overlap by size",
          .unit = "share of the smaller body",
          .is_logarithmic = true,
          .curves = Charts::together({of.curve("worst", "penetration_relative_max"),
                                      of.curve("mean", "penetration_relative_mean")})},
         "As a share of the smaller body's radius, or smallest half edge.");
  of.add(chapter,
         {.title = "Contacts and pairs",
          .unit = "number",
          .curves = Charts::together({of.curve("contact points under load", "contacts_count"),
                                      of.curve("pairs from the broad phase", "pairs_count")})},
         "Pairs whose bounding boxes overlap, and contact points that carry a force.");
  of.add(chapter,
         {.title = "Contacts per body",
          .unit = "number",
          .curves = of.curve("coordination", "coordination_mean")},
         "Contacts under load; each counts for both of its bodies.");
  return chapter;
}

Chapter motion(const Charts& of) {
  Chapter chapter{"Motion", {}};
  of.add(chapter,
         {.title = "Speed",
          .unit = "speed (m/s)",
          .curves = Charts::together({of.curve("fastest", "speed_max"), of.curve("rms", "speed_rms")})},
         "Of the free bodies.");
  of.add(chapter,
         {.title = "Bodies",
          .unit = "number",
          .curves = Charts::that_change(of.curve("present", "bodies_count"))},
         "Bodies that have appeared and were not removed.");
  of.add(chapter, {.title = "Centre of mass", .unit = "position (m)", .curves = of.components("centre")},
         "Of the free bodies.");
  of.add(chapter, {.title = "Momentum", .unit = "momentum (kg m/s)", .curves = of.components("momentum")},
         "Sum over the free bodies; fixed and moved bodies take the rest.");
  of.add(chapter,
         {.title = "Angular momentum",
          .unit = "about the origin (kg m²/s)",
          .curves = of.components("angular_momentum")},
         "Of the free bodies.");
  return chapter;
}

/// Makes the chapter of the bodies that have a name and move.
Chapter named_bodies(const Charts& of) {
  Chapter chapter{"Bodies by name", {}};
  for (const char* axis : {"x", "y", "z"}) {
    const auto named = [&](const char* quantity) {
      return Charts::that_change(of.each("", fmt::format("_{}_{}", quantity, axis)));
    };
    of.add(chapter,
           {.title = fmt::format("Position along {}", axis),
            .unit = "position (m)",
            .curves = named("position")},
           "Of the bodies that move.");
    of.add(chapter,
           {.title = fmt::format("Velocity along {}", axis),
            .unit = "velocity (m/s)",
            .curves = named("velocity")},
           "Of the bodies that move.");
  }
  return chapter;
}

Chapter sources_and_regions(const Charts& of) {
  Chapter chapter{"Sources and regions", {}};
  of.add(chapter, {.title = "Bodies from emitters", .unit = "number", .curves = of.each("emission_", "")},
         "Those that were requested, and those that found room.");
  of.add(
      chapter,
      {.title = "Bodies that regions took out", .unit = "number", .curves = of.each("region_", "_removed")},
      "Since the start.");
  of.add(chapter, {.title = "Bodies in regions", .unit = "number", .curves = of.each("region_", "_count")},
         "Free bodies whose centre is there.");
  of.add(chapter,
         {.title = "Filled share of regions", .unit = "share", .curves = of.each("region_", "_fraction")},
         "Of the volume, by bodies.");
  of.add(
      chapter,
      {.title = "Mass that comes into regions", .unit = "flux (kg/s)", .curves = of.each("region_", "_flux")},
      "Change over the last step before each row; negative: mass leaves.");
  return chapter;
}

/// Makes the chapter of the cost, which is measured between two rows.
Chapter speed_of_the_run(const Charts& of, const WallTimes& wall) {
  Chapter chapter{"Cost", {}};
  Column time, cost;
  for (std::size_t k = 1; k < wall.time.size(); ++k) {
    time.push_back(wall.time[k]);
    cost.push_back((wall.wall[k] - wall.wall[k - 1]) / (wall.time[k] - wall.time[k - 1]));
  }
  of.add(chapter,
         {.title = "Cost of a simulated second",
          .unit = "wall time / simulated time",
          .is_logarithmic = true,
          .curves = {{"between rows", cost}},
          .time = time},
         "Drawing and writing included, where steps waited for them.");
  return chapter;
}

}  // namespace

std::vector<Chapter> chapters_of(const Columns& metrics, const WallTimes& wall) {
  const Charts of(metrics);
  std::vector<Chapter> chapters = {energy(of),       contacts(of),
                                   motion(of),       sources_and_regions(of),
                                   named_bodies(of), speed_of_the_run(of, wall)};
  std::erase_if(chapters, [](const Chapter& chapter) { return chapter.charts.empty(); });
  return chapters;
}

}  // namespace scree::report
