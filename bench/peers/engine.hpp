// What the benchmark asks of an engine: to take a scene, to step it, and to show its bodies.
#pragma once

#include "core/bodies.hpp"
#include "core/error.hpp"
#include "sim/scene/scene.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scree::bench {

class Engine {
 public:
  virtual ~Engine() = default;
  /// One step, of the length given to make_engine.
  virtual void step() = 0;
  /// Writes where the bodies are and how they move into `bodies`, which starts as the table of the scene.
  virtual void read(BodyTable& bodies) const = 0;
};

/// The scene in an engine (bullet, ode, scree) that works with one thread and lets no body sleep; `step` in
/// s. The scene must outlive it. Throws InputError where the engine, the setting, or a body of the scene is
/// unknown to it.
std::unique_ptr<Engine> make_engine(const std::string& engine, const std::string& setting, const Scene& scene,
                                    double step);

/// Of the settings of an engine, the one with the name. Throws InputError if there is none.
template <class Setting>
const Setting& find_setting(const std::map<std::string, Setting>& settings, const std::string& name,
                            const std::string& engine) {
  const auto found = settings.find(name);
  if (found == settings.end()) throw InputError(engine + " has no setting " + name);
  return found->second;
}

/// To be thrown for the bodies that the peers have no like of, or move by other rules.
inline InputError refused_by(const std::string& engine) {
  return InputError(engine + " is given spheres, boxes and planes alone, free or fixed");
}

/// The scene's forces, which an engine has to be given again for every step. Throws InputError where one
/// comes or goes.
const std::vector<AppliedForce>& constant_forces(const Scene& scene, const std::string& engine);

// One file each.
std::unique_ptr<Engine> make_bullet(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_ode(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_scree(const std::string& setting, const Scene& scene, double step);

}  // namespace scree::bench
