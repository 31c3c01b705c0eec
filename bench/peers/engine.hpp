// What the benchmark asks of an engine: to take a scene, to step it, and to show its bodies.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/scene.hpp"

#include <memory>
#include <string>

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

// One file each.
std::unique_ptr<Engine> make_bullet(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_ode(const std::string& setting, const Scene& scene, double step);
std::unique_ptr<Engine> make_scree(const std::string& setting, const Scene& scene, double step);

}  // namespace scree::bench
