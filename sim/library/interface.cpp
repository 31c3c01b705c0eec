// The functions of Simulation that only users of the library need. The program does without them, since it
// uses the parts that they join.
#include "core/archive.hpp"
#include "core/error.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/checkpoint.hpp"
#include "sim/record/run_identity.hpp"
#include "sim/scene/measure.hpp"
#include "sim/step/simulation.hpp"

#include <fmt/format.h>

namespace scree {

namespace {

Vector plain(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::string version() { return build_info().version; }

Simulation::Simulation(const std::filesystem::path& scene, const std::vector<Override>& overrides,
                       const SimulationOptions& options)
    : Simulation(read_scene(scene, overrides), options) {}

Simulation Simulation::from_text(const std::string& scene, const std::filesystem::path& name,
                                 const std::vector<Override>& overrides, const SimulationOptions& options) {
  return Simulation(parse_scene(scene, name, overrides), options);
}

const std::string& Simulation::scene_name() const { return scene().name; }
const std::string& Simulation::resolved_scene() const { return scene().resolved; }
const std::map<std::string, std::int32_t>& Simulation::body_names() const { return scene().body_names; }

double Simulation::measure(std::string_view name) {
  const Measure measure = parse_measure(name, scene());
  return evaluate(measure, observe(is_of_overlaps(measure)), [this](std::int32_t id) { return body(id); });
}

std::vector<LoadedContact> Simulation::loaded_contacts() const {
  std::vector<LoadedContact> contacts;
  for (const ContactForce& contact : contact_forces())
    contacts.push_back({contact.i, contact.j, plain(contact.force), plain(contact.point)});
  return contacts;
}

// The archive's parts have the same names here as in the program's checkpoints.

void Simulation::save_checkpoint(const std::filesystem::path& file) {
  SavedState state;
  Archive archive = Archive::saving(state);
  RunIdentity identity = identity_of(scene(), space_name());
  archive.part("run", identity);
  archive.part("simulation", *this);
  write_checkpoint(file, state);
}

void Simulation::load_checkpoint(const std::filesystem::path& file) {
  const SavedState state = read_checkpoint(file);
  Archive archive = Archive::loading(state);
  RunIdentity saved;
  archive.part("run", saved);
  const RunIdentity present = identity_of(scene(), space_name());
  if (const std::string difference = difference_of(saved, present); !difference.empty())
    throw InputError(fmt::format("{}: {}", file.string(), difference));
  // What is wrong with a file may show only when a part of it has been loaded.
  SavedState before;
  Archive::saving(before).part("simulation", *this);
  try {
    archive.part("simulation", *this);
  } catch (...) {
    Archive::loading(before).part("simulation", *this);
    throw;
  }
}

}  // namespace scree
