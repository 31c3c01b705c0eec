// scree render: draws the pictures of a run again, from its trajectory.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/cli/film.hpp"
#include "sim/cli/film_look.hpp"
#include "sim/cli/output_folder.hpp"
#include "sim/cli/picture_context.hpp"
#include "sim/cli/process_pool.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <unistd.h>
#include <vector>

namespace scree::cli {

namespace {

/// The columns of the trajectory that pictures need; -1 for one that the trajectory does not have.
struct StateColumns {
  int position, id, mobility, orientation, velocity;
};

/// Returns the columns for the pictures of the scene. Throws InputError if the pictures show what the
/// trajectory does not have. `contacts`: whether the run has a file of contacts.
StateColumns columns_for(const Scene& scene, const TrajectoryReader& trajectory, bool contacts) {
  const auto refuse = [](const char* what, const char* advice) {
    throw InputError(fmt::format("the trajectory has no {}, which these pictures show; {}", what, advice));
  };
  const StateColumns columns{trajectory.column("position"), trajectory.column("id"),
                             trajectory.column("mobility"), trajectory.column("orientation"),
                             trajectory.column("velocity")};
  if (shows_broad_phase(scene.render))
    refuse("pairs and no grid",
           "only scree run can draw these, so choose another render.color or render.overlay");
  if (shows_contacts(scene.render) && !contacts)
    refuse("contacts",
           "choose another render.color or render.overlay, or run the scene again with "
           "record.trajectory.contacts=true");
  const bool shows_speed =
      scene.render.color == ColorBy::speed || scene.render.color == ColorBy::kinetic_energy;
  if (shows_speed && columns.velocity < 0)
    refuse("velocity",
           "choose another render.color, or run the scene again with record.trajectory.velocity=true");
  const bool has_more_than_spheres = std::ranges::any_of(
      scene.bodies.shape, [](Shape shape) { return shape != Shape::sphere && shape != Shape::plane; });
  if (has_more_than_spheres && columns.orientation < 0)
    refuse("orientation", "run the scene again with record.trajectory.orientation=true");
  if (columns.position < 0 || columns.id < 0 || columns.mobility < 0)
    refuse("positions, ids and mobilities", "run the scene again");
  return columns;
}

/// The states of a trajectory as frames to draw.
class States {
 public:
  /// `run`: the folder of the run.
  States(const Scene& scene, const std::filesystem::path& run)
      : scene_(scene), trajectory_(run / trajectory_name) {
    if (has_contacts(run)) contacts_.emplace(run / contacts_name);
    columns_ = columns_for(scene, trajectory_, contacts_.has_value());
    if (contacts_ && contacts_->index().frames().size() != frames().size())
      throw InputError(fmt::format("{} has other frames than the trajectory beside it", contacts_name));
  }
  static bool has_contacts(const std::filesystem::path& run) {
    return std::filesystem::exists(run / contacts_name);
  }

  const std::vector<TrajectoryFrame>& frames() const { return trajectory_.index().frames(); }

  render::Frame read(const FilmLook& look, std::size_t frame) {
    return frame_of(scene_, look, snapshot(frame),
                    shows_contacts(scene_.render) ? contact_forces(*contacts_, frame, scene_.bodies.count())
                                                  : std::vector<ContactForce>());
  }

 private:
  Snapshot snapshot(std::size_t frame) {
    const TrajectoryFrame& about = trajectory_.index().frames()[frame];
    Snapshot snapshot{about.time, about.step, scene_.bodies};
    BodyTable& bodies = snapshot.bodies;
    std::ranges::fill(bodies.mobility, Mobility::absent);
    const std::vector<double> ids = numbers(frame, columns_.id);
    const std::vector<double> mobility = numbers(frame, columns_.mobility);
    const std::vector<double> position = numbers(frame, columns_.position);
    const std::vector<double> orientation = numbers(frame, columns_.orientation);
    const std::vector<double> velocity = numbers(frame, columns_.velocity);
    for (std::size_t row = 0; row < ids.size(); ++row) {
      const bool is_known = ids[row] >= 0 && ids[row] < static_cast<double>(bodies.count());
      if (!is_known || mobility[row] > static_cast<double>(Mobility::absent))
        throw InputError("the trajectory is of other bodies than scene.yaml beside it");
      const auto k = static_cast<std::size_t>(ids[row]);
      bodies.mobility[k] = static_cast<Mobility>(mobility[row]);
      bodies.position[k] = Eigen::Map<const Vec3>(&position[3 * row]);
      if (!velocity.empty()) bodies.velocity[k] = Eigen::Map<const Vec3>(&velocity[3 * row]);
      if (orientation.empty()) continue;
      const double* q = &orientation[4 * row];
      bodies.orientation[k] = Quat(q[0], q[1], q[2], q[3]).normalized();
    }
    return snapshot;
  }

  std::vector<double> numbers(std::size_t frame, int column) {
    return column < 0 ? std::vector<double>{} : trajectory_.numbers(frame, static_cast<std::size_t>(column));
  }

  const Scene& scene_;
  TrajectoryReader trajectory_;
  std::optional<TrajectoryReader> contacts_;
  StateColumns columns_;
};

/// The frames that a process draws: part k of all frames in their order.
struct Part {
  std::size_t first, last;  ///< first frame of this part and of the next one

  Part(std::size_t frames, int k, int parts)
      : first(frames * static_cast<std::size_t>(k) / static_cast<std::size_t>(parts)),
        last(frames * static_cast<std::size_t>(k + 1) / static_cast<std::size_t>(parts)) {}
};

/// The message of a process to its parent.
struct PartResult {
  std::string renderer;  ///< the renderer that it has used
  std::string trouble;   ///< the error that stopped it; empty if there was none

  std::string text() const { return renderer + '\n' + trouble; }
  static PartResult from(const ProcessResult& result) {
    if (!result.death.empty()) return {{}, result.death};
    const std::size_t end = result.text.find('\n');
    return {result.text.substr(0, end), result.text.substr(end + 1)};
  }
};

/// Draws part k of the frames. Runs in a child process and never throws. The trajectory is opened here, since
/// processes that share an open file share its position.
PartResult draw_part(const Scene& scene, const RenderArguments& arguments, const RunFolder& folder, int k,
                     int parts) {
  PartResult result;
  try {
    States states(scene, arguments.run);
    const std::vector<TrajectoryFrame>& frames = states.frames();
    const Part part(frames.size(), k, parts);
    Film film(scene, folder, arguments.context,
              [&result](std::string_view trouble) { result.trouble = trouble; });
    for (std::size_t f = 0; f < part.first; ++f) film.pass_over(frames[f].step);
    for (std::size_t f = part.first; f < part.last; ++f)
      film.record(frames[f].step, [&] { return states.read(film.look(), f); });
    film.finish_frames();
    result.renderer = film.renderer();
  } catch (const std::exception& error) {
    result.trouble = error.what();
  }
  return result;
}

/// Returns the number of processes: one for each core, but no more than there are frames, or than half of the
/// free memory has room for. A process holds a few states, which are read, drawn or waiting, of some 200
/// bytes a body.
int jobs_for(const RenderArguments& arguments, const Scene& scene, std::size_t frames) {
  const double room =
      0.5 * static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double need = 2e8 + 6 * 200 * static_cast<double>(scene.bodies.count());
  const int fitting = std::min(static_cast<int>(machine_info().cores), static_cast<int>(room / need));
  const int wanted = arguments.jobs > 0 ? arguments.jobs : fitting;
  return std::clamp(wanted, 1, std::max(static_cast<int>(frames), 1));
}

/// Returns the overrides for the run's scene. Another colour goes without the range of the run's colours,
/// which is one of another quantity. Throws InputError if a key outside of `render` is to change.
std::vector<Override> render_overrides(const RenderArguments& arguments) {
  std::vector<Override> overrides = arguments.overrides;
  for (const Override& override : arguments.overrides) {
    if (override.path != "render" && !override.path.starts_with("render."))
      throw InputError(
          fmt::format("--set {}: only keys of `render` can change for a run that is done", override.path));
    if (override.path == "render.color") overrides.insert(overrides.begin(), {"render.range", "auto"});
  }
  return overrides;
}

}  // namespace

int render_again(const RenderArguments& arguments) {
  const std::vector<Override> overrides = render_overrides(arguments);
  const TrajectoryReader trajectory(arguments.run / trajectory_name);
  const Scene scene = read_scene(arguments.run / "scene.yaml", overrides);
  columns_for(scene, trajectory, States::has_contacts(arguments.run));
  expect_context(arguments.context);
  const RunFolder folder(
      output_folder(arguments.output, arguments.run, "render"),
      arguments.overwrite ? RunFolder::Earlier::replaced : RunFolder::Earlier::refused_results);
  Console console(folder / "log.txt", AtomicFile::Opening::anew);

  const std::vector<TrajectoryFrame>& frames = trajectory.index().frames();
  const int jobs = jobs_for(arguments, scene, frames.size());
  std::vector<std::string> renderers;
  in_processes(
      jobs, jobs, [&](int k) { return draw_part(scene, arguments, folder, k, jobs).text(); },
      [&](int, const ProcessResult& result) {
        const auto [renderer, trouble] = PartResult::from(result);
        if (!trouble.empty()) console.warn(trouble);
        if (!renderer.empty() && !std::ranges::count(renderers, renderer)) renderers.push_back(renderer);
      });
  if (!console.warnings().empty()) {
    console.say("pictures: frames are missing, and there is no movie");
    console.close();
    return status_run_failed;
  }
  Film film(scene, folder, arguments.context,
            [&console](std::string_view trouble) { console.warn(trouble); });
  for (const TrajectoryFrame& frame : frames) film.pass_over(frame.step);
  film.make_movie();
  console.say(fmt::format("pictures: {} frames in {}{}; {} processes, {}", film.frames(),
                          folder.frames().string(),
                          film.movie().empty() ? "" : ", " + (folder / film.movie().c_str()).string(), jobs,
                          fmt::join(renderers, " and ")));
  console.close();
  return console.warnings().empty() ? status_done : status_run_failed;
}

}  // namespace scree::cli
