// The interface of an engine in the benchmark: it takes a scene, steps it, and shows its bodies.
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
  /// Takes one step, of the length given to make_engine.
  virtual void step() = 0;
  /// Writes the positions and velocities of the bodies into `bodies`, which must start as the table of the
  /// scene.
  virtual void read(BodyTable& bodies) const = 0;
};

/// Makes an engine (bullet, ode, scree) with the scene. It works with one thread and lets no body sleep.
/// `step` is in s. The scene must outlive the engine. Throws InputError if the engine or the setting is
/// unknown, or if the engine cannot take a body of the scene.
std::unique_ptr<Engine> make_engine(const std::string& engine, const std::string& setting, const Scene& scene,
                                    double step);

/// Returns the setting of an engine that has the name. Throws InputError if there is none.
template <class Setting>
const Setting& find_setting(const std::map<std::string, Setting>& settings, const std::string& name,
                            const std::string& engine) {
  const auto found = settings.find(name);
  if (found == settings.end()) throw InputError(engine + " has no setting " + name);
  return found->second;
}

/// Returns the error to throw for bodies that the peers do not have, or that they move by other rules.
inline InputError refused_by(const std::string& engine) {
  return InputError(engine + " is given spheres, boxes and planes alone, free or fixed");
}

/// Returns the scene's forces, which must be given to an engine again for every step. Throws InputError if a
/// force does not act all the time.
const std::vector<AppliedForce>& constant_forces(const Scene& scene, const std::string& engine);

// Each of these is defined in its own file.
std::unique_ptr<Engine> make_bullet(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_ode(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_scree(const std::string& setting, const Scene& scene, double step);

}  // namespace scree::bench
