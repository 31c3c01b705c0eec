// scree plan: says what a scene will model and what it needs, without running it.
#include "core/tolerances.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/difficulty.hpp"
#include "sim/cli/trial.hpp"
#include "sim/laws/heap.hpp"
#include "sim/model/model.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/record/metrics.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/trajectory_columns.hpp"
#include "sim/scene/memory.hpp"
#include "sim/scene/time_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace scree::cli {

namespace {

// The words in the order of Shape and of Mobility.
constexpr std::array<const char*, 8> shape_words = {"spheres",   "boxes",    "planes",    "tubes",
                                                    "triangles", "capsules", "cylinders", "polyhedra"};
constexpr std::array<const char*, 3> mobility_words = {"free", "fixed", "prescribed"};

void print_row(const char* subject, const std::string& text) { fmt::print("{:<13}{}\n", subject, text); }

std::int64_t count_shape(const Scene& scene, Shape shape) {
  return std::ranges::count(scene.bodies.shape, shape);
}

void print_notes(const Scene& scene) {
  for (const std::string& note : scene.notes) print_row("note", note);
}

void print_bodies(const Scene& scene) {
  std::array<std::array<std::int64_t, mobility_words.size()>, shape_words.size()> counts = {};
  for (std::size_t k = 0; k < scene.bodies.shape.size(); ++k) {
    ++counts[static_cast<std::size_t>(scene.bodies.shape[k])]
            [static_cast<std::size_t>(scene.bodies.mobility[k])];
  }
  print_row("bodies", fmt::format("{}", scene.bodies.count()));
  for (std::size_t shape = 0; shape < shape_words.size(); ++shape) {
    for (std::size_t mobility = 0; mobility < mobility_words.size(); ++mobility) {
      if (counts[shape][mobility] == 0) continue;
      print_row("", fmt::format("{} {}: {}", mobility_words[mobility], shape_words[shape],
                                counts[shape][mobility]));
    }
  }
  for (const Lifetime& lifetime : scene.lifetimes) {
    print_row("",
              fmt::format(
                  "{} there from {} s{}", lifetime.bodies.count, lifetime.span.from,
                  std::isfinite(lifetime.span.until) ? fmt::format(" until {} s", lifetime.span.until) : ""));
  }
}

void print_emitters(const Scene& scene) {
  for (const Emitter& emitter : scene.emitters) {
    const double last = emitter.start + (emitter.bodies.count - 1) / emitter.rate;
    print_row("", fmt::format("{} one after another, {:.4g} a second, from {} s {}", emitter.bodies.count,
                              emitter.rate, emitter.start,
                              last <= scene.time.end ? fmt::format("to {:.4g} s", last)
                                                     : "past the end: the last ones never appear"));
  }
}

/// Returns x rounded down to two digits.
double rounded_down(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::floor(x / unit) * unit;
}

/// Prints the number of steps in the shortest period of a body that oscillates: the body moves straight in
/// each step.
void print_motion(const Scene& scene) {
  constexpr double few_steps = 20;
  double frequency = 0;
  for (const Motion& motion : scene.motions)
    if (motion.oscillate) frequency = std::max(frequency, motion.oscillate->frequency);
  if (frequency > 0) {
    const double steps = 1 / (frequency * scene.time.step / scene.time.substeps.value_or(1));
    print_row("motion",
              fmt::format("{:.3g} steps to the shortest swing{}", steps,
                          steps < few_steps ? fmt::format(": few; try step <= {:.2g}",
                                                          rounded_down(scene.time.step * steps / few_steps))
                                            : ""));
  }
  if (!scene.servos.empty())
    print_row("servos",
              fmt::format("{} that hold a force: steps are taken on the processor", scene.servos.size()));
}

/// Prints the periodic cell, and how fast bodies may be in it: with faster ones steps need smaller substeps,
/// or fail.
void print_period(const Scene& scene) {
  const Period& period = scene.bodies.period;
  if (!period.exists) return;
  std::vector<std::string> axes;
  for (int a = 0; a < 3; ++a) {
    if (!period.is_along(a)) continue;
    axes.push_back(
        fmt::format("{}: {:.6g} m to {:.6g} m", "xyz"[a], period.low[a], period.low[a] + period.length[a]));
  }
  print_row("periodic", fmt::format("{}", fmt::join(axes, ", ")));
  const double h = scene.time.step / scene.time.substeps.value_or(1);
  print_row("", fmt::format("no image is missed up to {:.3g} m/s in a substep of {:.3g} s",
                            period.most_margin / (tolerance::travel_factor * h), h));
}

/// Beyond these values a run goes on, but its results may be poor. Contacts are found as far away as bodies
/// travel in a substep: single impacts on a wall as thick as the ball are right up to a travel of 4, and some
/// fail from 8 on; two bodies meet at twice the speed.
constexpr double largest_travel = 2;
constexpr double advised_travel = 1;
constexpr double large_mass_ratio = 100;
constexpr double large_size_ratio = 20;

void print_difficulty(const Scene& scene) {
  const Difficulty d = difficulty_of(scene);
  if (d.largest_size > 0)
    print_row("sizes", fmt::format("{:.3g} m (smallest radius or half edge) to {:.3g} m (largest radius)",
                                   d.least_size, d.largest_size));
  if (d.smallest_size == 0 || d.speed == 0) return;
  if (!std::isfinite(d.speed)) {
    print_row("speed", "too large to compute with: check velocities and spins, since a run fails at once");
    return;
  }
  const double travel = d.travel(scene.time.step / scene.time.substeps.value_or(1));
  print_row("speed", fmt::format("up to {:.3g} m/s{}", d.speed,
                                 d.fall > 0 ? fmt::format(", after a fall of {:.3g} m", d.fall) : ""));
  print_row("", fmt::format("v dt / smallest size = {:.2g}{}", travel,
                            travel > largest_travel
                                ? fmt::format(": bodies may pass through each other; try step <= {:.2g}",
                                              rounded_down(scene.time.step * advised_travel / travel))
                                : ": small enough"));
  if (d.mass_ratio > large_mass_ratio)
    print_row("mass ratio",
              fmt::format("{:.3g}: heavy bodies on light ones need many sweeps; raise response.iterations or "
                          "time.substeps if overlaps are large",
                          d.mass_ratio));
  if (d.largest_size > large_size_ratio * d.least_size)
    print_row("size ratio",
              fmt::format("{:.3g}: the small bodies need a short time.step, and the large ones have many "
                          "contacts",
                          d.largest_size / d.least_size));
}

void print_model(const ModelPlan& plan) {
  print_row("model", "");
  for (const Feature& f : plan.features())
    print_row("", fmt::format("{:<16} {:<4} {}", f.name, f.on ? "on" : "off", f.reason));
  if (plan.restitution.on) {
    const RestitutionThreshold& threshold = plan.restitution_threshold;
    print_row(
        "",
        threshold.any > 0 ? fmt::format("contacts bounce if they close faster than {:.4g} m/s", threshold.any)
        : threshold.lossy > 0
            ? fmt::format("contacts bounce if they close faster than (1 - e) * {:.4g} m/s", threshold.lossy)
            : "every contact bounces, however slow");
  }
}

std::string broad_phase_words(const BroadPhaseSettings& settings) {
  const std::string levels =
      settings.levels == 0 ? "levels chosen from the sizes" : fmt::format("{} levels", settings.levels);
  switch (settings.method) {
    case BroadPhaseMethod::hierarchical_grid:
      break;
    case BroadPhaseMethod::alternative_grid:
      return "alternative grid, " + levels;
    case BroadPhaseMethod::uniform_grid:
      return "uniform grid";
    case BroadPhaseMethod::sweep_and_prune:
      return "sweep and prune";
    case BroadPhaseMethod::lbvh:
      return "bounding volume hierarchy";
    case BroadPhaseMethod::brute_force:
      return "brute force";
  }
  return "hierarchical grid, " + levels;
}

const char* convex_words(ConvexMethod method) {
  switch (method) {
    case ConvexMethod::automatic:
    case ConvexMethod::axes:
      break;
    case ConvexMethod::ccd_gjk:
      return "libccd's GJK and EPA where they overlap";
    case ConvexMethod::ccd_mpr:
      return "libccd's MPR where they overlap";
  }
  return "separating axes and GJK";
}

/// Returns the number of triangles, and the method for shapes other than boxes and spheres; empty if there
/// are neither. The contacts of both are found on Host.
std::string general_words(const Scene& scene) {
  std::string words;
  if (const std::int64_t triangles = count_shape(scene, Shape::triangle))
    words += fmt::format("; {} triangles of meshes", triangles);
  if (count_shape(scene, Shape::capsule) + count_shape(scene, Shape::cylinder) +
          count_shape(scene, Shape::polyhedron) >
      0)
    words += fmt::format("; capsules, cylinders and polyhedra by {}", convex_words(scene.narrowphase.convex));
  return words.empty() ? words : words + "; on the processor";
}

std::string mesh_words(const MeshBodies& mesh) {
  const MeshReport& report = mesh.report;
  const std::string name =
      mesh.name.empty() ? std::filesystem::path(mesh.file).filename().string() : mesh.name;
  std::string words = fmt::format("{}: {} triangles", name, mesh.bodies.count);
  if (report.left_out > 0)
    words += fmt::format(" ({} triangles without area or given twice are left out)", report.left_out);
  words += report.welded > 0 ? fmt::format("; {} corners welded to others, by up to {:.2g} m", report.welded,
                                           report.farthest)
                             : "; no corners to weld";
  if (report.split > 0) words += fmt::format("; {} triangles split at corners on their edges", report.split);
  words += fmt::format("; open edges: {}", report.open);
  if (report.crowded > 0) words += fmt::format("; edges of three triangles or more: {}", report.crowded);
  return words;
}

void print_meshes(const Scene& scene) {
  for (const MeshBodies& mesh : scene.meshes) print_row("mesh", mesh_words(mesh));
}

std::string box_words(const Scene& scene) {
  if (count_shape(scene, Shape::box) == 0) return "closed forms";
  switch (scene.narrowphase.box_box) {
    case BoxBoxMethod::automatic:
      break;
    case BoxBoxMethod::sat:
      return "closed forms; boxes by separating axes";
    case BoxBoxMethod::ccd_gjk:
      return "closed forms; boxes by libccd's GJK and EPA, on the processor";
    case BoxBoxMethod::ccd_mpr:
      return "closed forms; boxes by libccd's MPR, on the processor";
  }
  return "closed forms; boxes by the fastest method measured";
}

std::string narrow_phase_words(const Scene& scene) { return box_words(scene) + general_words(scene); }

MemoryNeed memory_of(const Scene& scene) {
  const double bodies = static_cast<double>(scene.bodies.count());
  MemoryLoad load{
      .bodies = bodies,
      .free_bodies = static_cast<double>(std::ranges::count(scene.bodies.mobility, Mobility::free)),
      .names = static_cast<double>(scene.body_names.size()),
      .pictures = scene.render.enabled};
  for (const auto& [name, id] : scene.body_names) load.name_bytes += static_cast<double>(name.size());
  return memory_need(load);
}

std::string memory_words(const Scene& scene) {
  const MemoryNeed need = memory_of(scene);
  return fmt::format(
      "about {}, {} for each body and {} more for each in a dense packing; this machine has {}",
      bytes_words(need.total()), bytes_words(need.bodies / static_cast<double>(scene.bodies.count())),
      bytes_words(need.contacts / static_cast<double>(scene.bodies.count())), bytes_words(machine_memory()));
}

std::string response_words(const ResponseSettings& settings) {
  std::string words =
      settings.iterations ? fmt::format("at most {} sweeps,", *settings.iterations) : "sweeps";
  words += fmt::format(" until the impulses change by less than {:g} of their size",
                       settings.tolerance.value_or(tolerance::response_change));
  if (!settings.tolerance && settings.mode != ResponseMode::accurate)
    words += fmt::format("; from {} contact points on, by less than {:g} ({:g} where they flow)",
                         fewest_heap_points, tolerance::heap_change / settings.quality,
                         tolerance::heap_change_in_flow / settings.quality);
  return words;
}

struct OutputPlan {
  std::int64_t rows = 0;
  std::int64_t frames = 0;
  std::int64_t trajectory_frames = 0;
  double bytes = 0;
};

/// Returns the bytes of a frame of the trajectory before compression, which saves little while everything
/// moves.
double trajectory_frame_bytes(const Scene& scene) {
  double row = 0;
  for (const BodyColumnSource& source : body_columns_of(*scene.record.trajectory))
    row += source.is_constant ? 0 : source.column.type.row();
  constexpr int contacts_of_a_body = 3;  // contacts per sphere in a dense heap
  if (scene.record.trajectory->contacts.value_or(false)) row += contacts_of_a_body * contact_bytes(scene);
  return row * static_cast<double>(scene.bodies.count());
}

OutputPlan plan_output(const Scene& scene, const TimeGrid& grid) {
  constexpr double bytes_per_number = 20;
  constexpr double bytes_per_timing_row = 2000;  // for some 30 stages
  constexpr double bytes_per_pixel = 1.1;  // in a PNG full of small bodies, and in its share of the movie
  OutputPlan plan{.rows = Cadence(grid, scene.record.metrics_every).due(grid.last())};
  const double row =
      bytes_per_number * static_cast<double>(metric_names(scene).size()) + bytes_per_timing_row;
  constexpr double bytes_per_final_row = 300;
  constexpr double bytes_per_saved_body = 600;  // for settled spheres, docs/reliability.md
  constexpr int checkpoints = 3;                // two are kept while a third one is written
  plan.bytes =
      row * static_cast<double>(plan.rows) +
      (bytes_per_final_row + checkpoints * bytes_per_saved_body) * static_cast<double>(scene.bodies.count());
  if (scene.record.trajectory) {
    constexpr int copies = 2;  // the journal is removed only when the file is there
    plan.trajectory_frames = Cadence(grid, trajectory_period(scene)).due(grid.last());
    plan.bytes += copies * trajectory_frame_bytes(scene) * static_cast<double>(plan.trajectory_frames);
  }
  if (!scene.render.enabled) return plan;
  plan.frames = Cadence(grid, 1 / scene.render.fps).due(grid.last());
  plan.bytes += bytes_per_pixel * scene.render.width * scene.render.height * static_cast<double>(plan.frames);
  return plan;
}

std::string output_words(const Scene& scene, const OutputPlan& plan) {
  std::string words = fmt::format("{} rows of metrics", plan.rows);
  if (plan.trajectory_frames > 0)
    words += fmt::format(", {} frames of the trajectory{}", plan.trajectory_frames,
                         scene.record.trajectory->contacts.value_or(false) ? " and of the contacts" : "");
  if (plan.frames == 0) return words + ", no pictures";
  return words + fmt::format(", {} frames of {} x {}", plan.frames, scene.render.width, scene.render.height);
}

std::string substep_words(const Scene& scene) {
  if (!scene.time.substeps)
    return fmt::format("1 to {} substeps each, chosen by the overlaps", most_substeps(scene));
  return fmt::format("{} substep{} each", *scene.time.substeps, *scene.time.substeps == 1 ? "" : "s");
}

}  // namespace

int plan(const PlanArguments& arguments) {
  const Scene scene = read_scene(arguments.scene, arguments.overrides);
  check_seeds(scene, arguments.overrides);
  const TimeGrid grid(scene.time);
  const OutputPlan output = plan_output(scene, grid);
  print_row("scene", fmt::format("{} ({}), seed {}", scene.name, scene.source.string(), scene.seed));
  print_notes(scene);
  print_bodies(scene);
  print_meshes(scene);
  print_emitters(scene);
  print_period(scene);
  print_row("time", fmt::format("{} s in {} steps of {} s, {}", scene.time.end, grid.last(), scene.time.step,
                                substep_words(scene)));
  print_difficulty(scene);
  print_motion(scene);
  print_model(plan_model(scene));
  print_row("broad phase", broad_phase_words(scene.broadphase));
  print_row("narrow phase", narrow_phase_words(scene));
  print_row("response", response_words(scene.response));
  print_row("checks",
            fmt::format("{}{}", scene.checks.size(), scene.label.empty() ? "" : ", label " + scene.label));
  print_row("output", output_words(scene, output));
  print_row("disk", "about " + bytes_words(output.bytes));
  print_row("memory", memory_words(scene));
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
