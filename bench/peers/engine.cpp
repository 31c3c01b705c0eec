#include "bench/peers/engine.hpp"

#include <map>

namespace scree::bench {

std::unique_ptr<Engine> make_engine(const std::string& engine, const std::string& setting, const Scene& scene,
                                    double step) {
  static const std::map<std::string, decltype(&make_scree)> makers = {
      {"bullet", make_bullet}, {"ode", make_ode}, {"scree", make_scree}};
  const auto maker = makers.find(engine);
  if (maker == makers.end()) throw InputError("engine " + engine + ": one of bullet, ode, scree");
  return maker->second(setting, scene, step);
}

const std::vector<AppliedForce>& constant_forces(const Scene& scene, const std::string& engine) {
  for (const AppliedForce& load : scene.forces)
    if (load.during.from > 0 || load.during.until < scene.time.end)
      throw InputError(engine + " is given forces alone that act all the time");
  return scene.forces;
}

}  // namespace scree::bench
