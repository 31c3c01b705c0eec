// The engine scree behind the interface of the benchmark.
#include "bench/options.hpp"
#include "bench/peers/engine.hpp"
#include "core/error.hpp"
#include "sim/step/simulation.hpp"

#include <fmt/format.h>

namespace scree::bench {

namespace {

class ScreeEngine : public Engine {
 public:
  explicit ScreeEngine(const Scene& scene) : simulation_(scene, {SpaceChoice::host, 1}) {}

  void step() override { simulation_.step(); }

  void read(BodyTable& bodies) const override {
    Snapshot snapshot;
    simulation_.snapshot(snapshot);
    bodies = std::move(snapshot.bodies);
  }

 private:
  Simulation simulation_;
};

}  // namespace

/// Makes the engine. A setting is `default`, or a list such as
/// response.iterations=20,response.tolerance=1e-4. The scene is read again with the setting, so that it is
/// checked like any other scene.
std::unique_ptr<Engine> make_scree(const std::string& setting, const Scene& scene, double step) {
  std::vector<Override> overrides = {{"time.step", fmt::format("{}", step)}};
  for (const std::string& item : split(setting == "default" ? "" : setting)) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos) throw InputError("setting " + item + ": scree's are key=value");
    overrides.push_back({item.substr(0, equals), item.substr(equals + 1)});
  }
  return std::make_unique<ScreeEngine>(read_scene(scene.source, overrides));
}

}  // namespace scree::bench
