// drop_height SCENE BODY [KEY=VALUE]...: runs a scene until one of its bodies is at rest or time.end is
// reached, and prints on the way the height of the body (m) and the error of the energy. With a demo of
// scree, from 3 m:
//     drop_height /usr/share/scree/configs/01_bouncing_ball.yaml ball "bodies[1].at[2]=3" time.end=10
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <scree/simulation.hpp>
#include <string>
#include <vector>

namespace {

/// Returns whether the body neither rises nor falls, nor is about to: at the top of a bounce its velocity is
/// zero, too, but its acceleration is that of free fall.
bool rests(scree::Simulation& simulation, const std::string& body) {
  return simulation.steps() > 0 && std::abs(simulation.measure(body + ".velocity.z")) < 1e-6 &&
         std::abs(simulation.measure(body + ".acceleration.z")) < 1e-6;
}

void say(scree::Simulation& simulation, std::int32_t id, const char* what) {
  std::printf("t %6.3f s   height %8.5f m   energy off by %.1e   %s\n", simulation.time(),
              simulation.read_body(id).position[2], simulation.measure("energy.unexplained"), what);
}

void drop(const std::string& scene, const std::string& body, const std::vector<scree::Override>& overrides) {
  scree::Simulation simulation(scene, overrides);
  const auto named = simulation.body_names().find(body);
  if (named == simulation.body_names().end())
    throw scree::InputError(scene + ": there is no body called " + body);
  const std::int32_t id = named->second;

  while (!simulation.finished() && !rests(simulation, body)) {
    if (simulation.steps() % 250 == 0) say(simulation, id, "");
    simulation.step();
  }
  say(simulation, id, rests(simulation, body) ? "at rest" : "at the end of the scene");
  for (const scree::LoadedContact& contact : simulation.loaded_contacts())
    if (contact.i == id || contact.j == id)
      std::printf("held by body %d with %.4f N\n", contact.i == id ? contact.j : contact.i,
                  std::hypot(contact.force[0], contact.force[1], contact.force[2]));
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) {
    std::fprintf(stderr, "usage: drop_height SCENE BODY [KEY=VALUE]...\n");
    return EXIT_FAILURE;
  }
  std::vector<scree::Override> overrides;
  for (std::size_t k = 2; k < words.size(); ++k) {
    const std::size_t equals = words[k].find('=');
    overrides.push_back(
        {words[k].substr(0, equals), equals < words[k].size() ? words[k].substr(equals + 1) : ""});
  }
  try {
    drop(words[0], words[1], overrides);
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {  // scree::InputError and scree::RunError say what to correct
    std::fprintf(stderr, "drop_height: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
