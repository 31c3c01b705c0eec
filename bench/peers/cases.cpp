#include "bench/peers/cases.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>

namespace scree::bench {

namespace {

/// Returns the energy with which the free bodies, all spheres, would arrive at the plane z = 0 (J).
double arrival_energy(const Scene& scene) {
  const BodyTable& all = scene.bodies;
  double energy = 0;
  for (std::size_t k = 0; k < all.position.size(); ++k) {
    if (all.mobility[k] != Mobility::free) continue;
    const double height = all.position[k].z() - all.size[k].x();
    energy += (0.5 * all.velocity[k].squaredNorm() - scene.gravity.z() * height) / all.inverse_mass[k];
  }
  return energy;
}

double energy_end(const Scene& scene, const Findings& f) { return f.energy_change / arrival_energy(scene); }
double energy_worst(const Scene& scene, const Findings& f) {
  return f.worst_energy_change / arrival_energy(scene);
}
/// Returns the energy in spin. It should be 0, because without friction nothing can make a ball spin.
double energy_in_spin(const Scene& scene, const Findings& f) { return f.spin_energy / arrival_energy(scene); }

const Vec3& launch(const Scene& scene) { return scene.bodies.velocity.back(); }
const ContactLaw& law(const Scene& scene) {
  return scene.law(scene.bodies.material.front(), scene.bodies.material.back());
}

/// Returns the relative error of the speed of rolling. A sphere that starts without spin rolls at 5/7 of its
/// initial speed, for any friction.
double rolling_speed(const Scene& scene, const Findings& f) {
  return f.newest.velocity.back().x() / (launch(scene).x() * 5 / 7) - 1;
}

/// Returns the relative error of the distance to rest, which by Coulomb friction is v^2 / (2 mu g).
double stop_distance(const Scene& scene, const Findings& f) {
  const double expected = launch(scene).squaredNorm() / (2 * law(scene).friction * scene.gravity.norm());
  return (f.newest.position.back() - scene.bodies.position.back()).x() / expected - 1;
}

double drift(const Scene&, const Findings& f) { return f.worst_drift; }
double penetration(const Scene&, const Findings& f) { return f.worst_penetration; }
double relative_mean(const Scene&, const Findings& f) { return f.penetration.relative_mean; }
double relative_max(const Scene&, const Findings& f) { return f.penetration.relative_max; }
double rms_speed(const Scene&, const Findings& f) { return f.rms_speed; }

/// Returns the share of the pellets, which are all bodies but the plate, that are behind the plate at the
/// end.
double passed(const Scene& scene, const Findings& f) {
  const double plate = scene.bodies.position.front().x();
  const auto behind = std::count_if(f.newest.position.begin() + 1, f.newest.position.end(),
                                    [&](const Vec3& at) { return at.x() > plate; });
  return static_cast<double>(behind) / static_cast<double>(scene.bodies.position.size() - 1);
}
/// Returns the largest relative error of the speeds after the impact, which should be e times those before.
double rebound(const Scene& scene, const Findings& f) {
  const double expected = -law(scene).restitution * launch(scene).x();
  double worst = 0;
  for (std::size_t k = 1; k < f.newest.velocity.size(); ++k)
    worst = std::max(worst, std::abs(f.newest.velocity[k].x() / expected - 1));
  return worst;
}

double squared_energy_change(const Scene&, const Findings& f) { return f.energy_change * f.energy_change; }
double squared_penetration(const Scene&, const Findings& f) { return f.squared_penetration; }

/// Returns the sum of the squared velocity errors of the board and the first ball. A force drags the board,
/// the second body, over the ground, the first body, from under balls that roll on it. All accelerations are
/// constant; the scene and the docs have the formula.
double squared_velocity_errors(const Scene& scene, const Findings& f) {
  const BodyTable& all = scene.bodies;
  const auto balls = static_cast<double>(all.position.size() - 2);
  const double board = 1 / all.inverse_mass[1], ball = 1 / all.inverse_mass[2];  // kg
  const Vec3 force = scene.forces.front().force;
  const double ground_friction = scene.law(all.material[0], all.material[1]).friction;
  const double pull = force.norm() - ground_friction * scene.gravity.norm() * (board + balls * ball);
  const double on_ball = pull / board / (3.5 / ball + balls / board);  // friction on each ball (N)
  const Vec3 along = f.time * force.normalized();
  return (f.newest.velocity[1] - (pull - balls * on_ball) / board * along).squaredNorm() +
         (f.newest.velocity[2] - on_ball / ball * along).squaredNorm();
}

constexpr Measure end_penetration_mean = {"penetration mean", "r", relative_mean};
constexpr Measure end_penetration_max = {"penetration max", "r", relative_max};
constexpr Measure mean_squared_energy_change = {"mean (E - E0)^2", "J^2", squared_energy_change, true};
constexpr const char* simbenchmark = "validation/simbenchmark";

// A bounce and a stack are judged often enough to find their worst state, and seldom enough that reading the
// process clock costs nothing compared with the steps between. Heaps are judged at their end. SimBenchmark's
// cases are judged after every step, because their metrics require it; for the cheapest case, whose steps
// take 8 us, that adds a seventh to the time.
const std::vector<Case> cases = {
    {"bounce", 0.25, 0, 0, {{"energy end", "", energy_end}, {"energy worst", "", energy_worst}}},
    {"roll", 0.25, 0, 0, {{"rolling speed", "", rolling_speed}}},
    {"slide", 0.25, 0, 0, {{"stop distance", "", stop_distance}}},
    {"stack", 0.05, 0, 0, {{"drift of the top", "m", drift}, {"penetration worst", "m", penetration}}},
    {"massratio", 0.05, 0, 0, {{"penetration worst", "m", penetration}, {"drift of the top", "m", drift}}},
    {"pile", 0, 3, 2, {end_penetration_mean, end_penetration_max, {"rms speed", "m/s", rms_speed}}},
    {"boxpile", 0, 3, 2, {end_penetration_mean, end_penetration_max}},
    {"gas", 0.25, 0, 0, {{"energy end", "", energy_end}, {"energy in spin", "", energy_in_spin}}},
    {"bullet", 0, 0, 0, {{"passed", "", passed}, {"rebound", "", rebound}}},
    {"rolling", 0, 0, 0, {{"mean squared error", "(m/s)^2", squared_velocity_errors, true}}, simbenchmark},
    {"bouncing", 0, 0, 0, {mean_squared_energy_change}, simbenchmark},
    {"666", 0, 0, 0, {{"mean sum of depth^2", "m^2", squared_penetration, true}}, simbenchmark},
    {"elastic_666", 0, 0, 0, {mean_squared_energy_change}, simbenchmark},
};

}  // namespace

Errors::Errors(const Case& wanted, const Scene& scene)
    : case_(wanted), scene_(scene), values_(wanted.measures.size()) {}

void Errors::see(const Findings& findings) {
  seen_ += 1;
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const double error = case_.measures[k].error(scene_, findings);
    values_[k] = case_.measures[k].mean ? values_[k] + (error - values_[k]) / seen_ : error;
  }
}

const Case& find_case(const std::string& name) {
  std::string known;
  for (const Case& c : cases) {
    if (c.name == name) return c;
    known += std::string(known.empty() ? "" : ", ") + c.name;
  }
  throw InputError("case " + name + ": one of " + known);
}

}  // namespace scree::bench
