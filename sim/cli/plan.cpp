// scree plan: what a scene will model and what it needs, before anything runs.
#include "sim/cli/commands.hpp"
#include "sim/model.hpp"
#include "sim/record/metrics.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/time_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scree::cli {

namespace {

// In the order of Shape and Mobility.
constexpr std::array<const char*, 4> shape_words = {"spheres", "boxes", "planes", "tubes"};
constexpr std::array<const char*, 3> mobility_words = {"free", "fixed", "prescribed"};

void print_row(const char* subject, const std::string& text) { fmt::print("{:<13}{}\n", subject, text); }

std::int64_t count_shape(const Scene& scene, Shape shape) {
  return std::ranges::count(scene.bodies.shape, shape);
}

void print_bodies(const Scene& scene) {
  std::array<std::array<std::int64_t, mobility_words.size()>, shape_words.size()> counts = {};
  for (std::size_t k = 0; k < scene.bodies.shape.size(); ++k) {
    ++counts[static_cast<std::size_t>(scene.bodies.shape[k])]
            [static_cast<std::size_t>(scene.bodies.mobility[k])];
  }
  print_row("bodies", fmt::format("{}", scene.bodies.count()));
  for (std::size_t shape = 0; shape < counts.size(); ++shape) {
    for (std::size_t mobility = 0; mobility < mobility_words.size(); ++mobility) {
      if (counts[shape][mobility] == 0) continue;
      print_row("", fmt::format("{} {}: {}", mobility_words[mobility], shape_words[shape],
                                counts[shape][mobility]));
    }
  }
}

void print_model(const ModelPlan& plan) {
  const auto feature = [](const char* name, const Feature& f) {
    print_row("", fmt::format("{:<12} {:<4} {}", name, f.on ? "on" : "off", f.reason));
  };
  print_row("model", "");
  feature("rotation", plan.rotation);
  feature("gyroscopic", plan.gyroscopic);
  feature("friction", plan.friction);
  feature("restitution", plan.restitution);
  if (plan.restitution.on) {
    print_row("",
              fmt::format("contacts bounce that close faster than {:.4g} m/s", plan.restitution_threshold));
  }
}

std::string broad_phase_words(const BroadPhaseSettings& settings) {
  switch (settings.method) {
    case BroadPhaseMethod::hierarchical_grid:
      break;
    case BroadPhaseMethod::uniform_grid:
      return "uniform grid";
    case BroadPhaseMethod::brute_force:
      return "brute force";
  }
  return "hierarchical grid, " +
         (settings.levels == 0 ? "levels chosen from the sizes" : fmt::format("{} levels", settings.levels));
}

std::string narrow_phase_words(const Scene& scene) {
  if (count_shape(scene, Shape::box) == 0) return "closed forms";
  switch (scene.narrowphase.box_box) {
    case BoxBoxMethod::automatic:
      break;
    case BoxBoxMethod::sat:
      return "closed forms; boxes by separating axes";
    case BoxBoxMethod::ccd_gjk:
      return "closed forms; boxes by libccd's GJK and EPA";
    case BoxBoxMethod::ccd_mpr:
      return "closed forms; boxes by libccd's MPR";
  }
  return "closed forms; boxes by the measured best way";
}

/// Of the state in its three copies (scene, simulation, picture) and of the contacts of a dense packing,
/// where a body has 6, each shared by two. Per contact and for the program itself: as measured on lattices of
/// spheres.
double memory_estimate(const Scene& scene) {
  constexpr double bytes_of_program = 6e7;
  constexpr double bytes_of_pictures = 1.2e8;
  constexpr double bytes_per_contact = 2300;  // pairs, manifolds, rows of the solver and remembered impulses
  double bytes_per_body = 3 * bytes_per_contact;
  for_each_field([&](const char*, const auto& field) { bytes_per_body += 3 * sizeof(field[0]); },
                 scene.bodies);
  return bytes_of_program + (scene.render.enabled ? bytes_of_pictures : 0) +
         static_cast<double>(scene.bodies.count()) * bytes_per_body;
}

struct OutputPlan {
  std::int64_t rows = 0;
  std::int64_t frames = 0;
  double bytes = 0;
};

OutputPlan plan_output(const Scene& scene, const TimeGrid& grid) {
  constexpr double bytes_per_number = 20;
  constexpr double bytes_per_timing_row = 2000;  // some 30 stages
  constexpr double bytes_per_pixel = 1.1;  // PNG of a scene full of small bodies, and its share of the movie
  OutputPlan plan{.rows = Cadence(grid, scene.record.metrics_every).due(grid.last())};
  const double row =
      bytes_per_number * static_cast<double>(metric_names(scene).size()) + bytes_per_timing_row;
  plan.bytes = row * static_cast<double>(plan.rows);
  if (!scene.render.enabled) return plan;
  plan.frames = Cadence(grid, 1 / scene.render.fps).due(grid.last());
  plan.bytes += bytes_per_pixel * scene.render.width * scene.render.height * static_cast<double>(plan.frames);
  return plan;
}

std::string output_words(const Scene& scene, const OutputPlan& plan) {
  std::string words = fmt::format("{} rows of metrics", plan.rows);
  if (plan.frames == 0) return words + ", no pictures";
  return words + fmt::format(", {} frames of {} x {}", plan.frames, scene.render.width, scene.render.height);
}

/// Rounded to what an estimate is worth.
std::string bytes_words(double bytes) {
  constexpr std::array<const char*, 4> units = {"KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  for (bytes /= 1024; bytes >= 1000 && unit + 1 < units.size(); ++unit) bytes /= 1024;
  return fmt::format("about {} {}", bytes < 10 ? std::ceil(bytes * 10) / 10 : std::ceil(bytes / 10) * 10,
                     units[unit]);
}

}  // namespace

int plan(const PlanArguments& arguments) {
  const Scene scene = read_scene(arguments.scene, arguments.overrides);
  const TimeGrid grid(scene.time);
  const OutputPlan output = plan_output(scene, grid);
  print_row("scene", fmt::format("{} ({}), seed {}", scene.name, scene.source.string(), scene.seed));
  print_bodies(scene);
  print_row("time", fmt::format("{} s in {} steps of {} s, substeps {}", scene.time.end, grid.last(),
                                scene.time.step, scene.time.substeps));
  print_model(plan_model(scene));
  print_row("broad phase", broad_phase_words(scene.broadphase));
  print_row("narrow phase", narrow_phase_words(scene));
  print_row("checks",
            fmt::format("{}{}", scene.checks.size(), scene.label.empty() ? "" : ", label " + scene.label));
  print_row("output", output_words(scene, output));
  print_row("disk", bytes_words(output.bytes));
  print_row("memory", bytes_words(memory_estimate(scene)));
  return status_done;
}

int print_schema() {
  fmt::print("{}\n", scene_schema());
  return status_done;
}

int print_reference() {
  fmt::print("{}\n", scene_reference());
  return status_done;
}

}  // namespace scree::cli
