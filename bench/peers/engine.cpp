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

}  // namespace scree::bench
