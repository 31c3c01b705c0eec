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

constexpr double seen = 1e-9;           // of the largest curve of a chart: less is rounding
constexpr std::size_t most_curves = 8;  // that can be told apart in one picture

/// Makes charts of columns.
class Charts {
 public:
  explicit Charts(const Columns& metrics) : metrics_(metrics) {}

  /// One column as it is; none if there is no such column.
  std::vector<Curve> curve(const std::string& title, const std::string& name) const {
    const Column* column = metrics_.find(name);
    return column == nullptr ? std::vector<Curve>{} : std::vector<Curve>{{title, *column}};
  }
  /// Change since the first row.
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
  /// The columns PREFIX name SUFFIX, called by their names.
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

  /// Those that have more than one value.
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
  /// The largest that can be drawn.
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
          .curves = Charts::together({of.curve("kinetic", "energy_kinetic"),
                                      of.change("potential, change", "energy_potential"),
                                      of.curve("lost in impacts", "energy_dissipated_restitution"),
                                      of.curve("lost to friction", "energy_dissipated_friction"),
                                      of.curve("lost to correction", "energy_dissipated_correction"),
                                      of.curve("work done on bodies", "energy_work"),
                                      of.curve("drift of rotation", "energy_integration"),
                                      of.curve("come and gone", "energy_exchange")})},
         "Each from its own definition, none as a remainder.");
  of.add(chapter,
         {.title = "Energy that nothing explains",
          .unit = "share of the largest energy",
          .is_logarithmic = true,
          .curves = of.curve("unexplained", "energy_unexplained")},
         "What is left when all of the above is added up: the error of the books.");
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
         "Of a radius, or of a box's smallest half extent.");
  of.add(chapter,
         {.title = "Contacts and pairs",
          .unit = "number",
          .curves = Charts::together({of.curve("contacts that carry", "contacts_count"),
                                      of.curve("pairs of the PCS", "pairs_count")})},
         "What the broad phase handed on, and what came of it.");
  of.add(
      chapter,
      {.title = "Contacts a body", .unit = "number", .curves = of.curve("coordination", "coordination_mean")},
      "That carry, counted for both of their bodies.");
  return chapter;
}

Chapter motion(const Charts& of) {
  Chapter chapter{"Motion", {}};
  of.add(chapter,
         {.title = "Speed",
          .unit = "speed (m/s)",
          .curves = Charts::together({of.curve("fastest", "speed_max"), of.curve("rms", "speed_rms")})},
         "Of the free bodies.");
  of.add(
      chapter,
      {.title = "Bodies", .unit = "number", .curves = Charts::that_change(of.curve("there", "bodies_count"))},
      "That have come and not gone.");
  of.add(chapter, {.title = "Centre of mass", .unit = "place (m)", .curves = of.components("centre")},
         "Of the free bodies.");
  of.add(chapter, {.title = "Momentum", .unit = "momentum (kg m/s)", .curves = of.components("momentum")},
         "Of the free bodies; what holds still takes what they lose.");
  of.add(chapter,
         {.title = "Angular momentum",
          .unit = "about the origin (kg m²/s)",
          .curves = of.components("angular_momentum")},
         "Of the free bodies.");
  return chapter;
}

/// Of bodies that have a name and move.
Chapter named_bodies(const Charts& of) {
  Chapter chapter{"Bodies by name", {}};
  for (const char* axis : {"x", "y", "z"}) {
    const auto named = [&](const char* quantity) {
      return Charts::that_change(of.each("", fmt::format("_{}_{}", quantity, axis)));
    };
    of.add(chapter,
           {.title = fmt::format("Place along {}", axis), .unit = "place (m)", .curves = named("position")},
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
      "Over the last step of each row; negative: it goes.");
  return chapter;
}

/// Between rows.
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
