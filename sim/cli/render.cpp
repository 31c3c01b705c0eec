// scree render: the pictures of a run again, from its trajectory.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/film.hpp"
#include "sim/cli/film_look.hpp"
#include "sim/cli/output_folder.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree::cli {

namespace {

/// What pictures need of a body, and where the trajectory has it.
struct StateColumns {
  int position, id, mobility, orientation, velocity;
};

/// Throws InputError where the pictures that the scene asks for show what the trajectory does not have.
StateColumns columns_for(const Scene& scene, const TrajectoryReader& trajectory) {
  const auto refuse = [](const char* what) {
    throw InputError(fmt::format("the trajectory has no {}, which these pictures show", what));
  };
  const StateColumns columns{trajectory.column("position"), trajectory.column("id"),
                             trajectory.column("mobility"), trajectory.column("orientation"),
                             trajectory.column("velocity")};
  if (needs_contacts_or_grid(scene.render)) refuse("contacts and no grid");
  const bool shows_speed =
      scene.render.color == ColorBy::speed || scene.render.color == ColorBy::kinetic_energy;
  if (shows_speed && columns.velocity < 0) refuse("velocity");
  const bool has_more_than_spheres = std::ranges::any_of(
      scene.bodies.shape, [](Shape shape) { return shape != Shape::sphere && shape != Shape::plane; });
  if (has_more_than_spheres && columns.orientation < 0) refuse("orientation");
  if (columns.position < 0 || columns.id < 0 || columns.mobility < 0) refuse("places");
  return columns;
}

class States {
 public:
  States(const Scene& scene, TrajectoryReader& trajectory)
      : scene_(scene), trajectory_(trajectory), columns_(columns_for(scene, trajectory)) {}

  Snapshot read(std::size_t frame) {
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

 private:
  std::vector<double> numbers(std::size_t frame, int column) {
    return column < 0 ? std::vector<double>{} : trajectory_.numbers(frame, static_cast<std::size_t>(column));
  }

  const Scene& scene_;
  TrajectoryReader& trajectory_;
  StateColumns columns_;
};

}  // namespace

int render_again(const RenderArguments& arguments) {
  for (const Override& override : arguments.overrides) {
    if (override.path != "render" && !override.path.starts_with("render."))
      throw InputError(fmt::format("--set {}: pictures of a run that is done can have another render alone",
                                   override.path));
  }
  TrajectoryReader trajectory(arguments.run / trajectory_name);
  Scene scene = read_scene(arguments.run / "scene.yaml", arguments.overrides);
  States states(scene, trajectory);
  const RunFolder folder(output_folder(arguments.output, arguments.run, "render"),
                         arguments.overwrite ? RunFolder::Earlier::replaced : RunFolder::Earlier::refused);
  Console console(folder / "log.txt", AtomicFile::Opening::anew);
  Film film(scene, folder, console);
  const std::vector<TrajectoryFrame>& frames = trajectory.index().frames();
  for (std::size_t f = 0; f < frames.size(); ++f)
    film.record(frames[f].step, [&] { return frame_of(scene, states.read(f)); });
  film.finish();
  console.say(fmt::format("pictures: {} frames in {}{}", film.frames(), folder.frames().string(),
                          film.movie().empty() ? "" : ", " + (folder / film.movie().c_str()).string()));
  console.close();
  return console.warnings().empty() ? status_done : status_run_failed;
}

}  // namespace scree::cli
