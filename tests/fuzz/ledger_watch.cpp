#include "tests/fuzz/ledger_watch.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {

namespace {

// Bounds on energies are shares of the energy scale; bounds on momenta are shares of what the bodies carry.
constexpr double explained = 1e-9;
constexpr double energy_gain = 1e-9;
constexpr double loss_rounding = 1e-12;      // in one step
constexpr double momentum_rounding = 1e-12;  // in one step
// This bound is a share of the impulses of a step. Bodies that wedge one another in a turning drum press ever
// harder (seed 275: by 1e6 N s for weights of 5 N), and the impulses on the two bodies of a pair differ by
// the rounding of that.
constexpr double impulse_rounding = 1e-16;
constexpr double angular_rounding = 1e-10;  // in the whole run
// Bounds on the energy that position correction may add in a run by lifting bodies, where nothing overlapped
// at the start: bodies turn and roll into others within a substep. The smaller one of two bounds holds: a
// constant one, and one of second order in the substep, given for 1/60 s. Measured over 1,000 scenes: 0.020
// and 0.19.
constexpr double correction_gain = 0.025;
constexpr double correction_gain_60 = 0.25;
// Bounds on overlaps, as shares of the smaller body's size, besides the overlap that turning and rolling
// allow. The larger one of two bounds holds: a constant one, and one of second order in the substep, given
// for 1/60 s (measured: 0.021 at 1/240 s; at 1/60 s 0.072 as nvcc builds it and 0.11 with sanitizers). If an
// overlap at the start is larger than the whole body, the way out is not the way in, and the overlap may grow
// at first, by the factor `overlap_growth` (measured: 1.61).
constexpr double overlap = 0.025;
constexpr double overlap_60 = 0.15;
constexpr double overlap_growth = 1.7;

class Watch {
 public:
  Watch(const Scene& scene, const RandomScene& origin)
      : scene_(scene), origin_(origin), simulation_(scene, {SpaceChoice::host, 1}) {
    before_ = first_ = simulation_.observe();
    simulation_.snapshot(state_);
    start_ = state_;
    first_overlap_ = first_.penetration.relative_max;
  }

  Breaches run() {
    while (!simulation_.finished()) {
      const double momentum_before = carried_momentum();
      try {
        simulation_.step();
      } catch (const RunError&) {
        hold("runs", 1, 0);
        return breaches_;
      }
      now_ = simulation_.observe();
      simulation_.snapshot(state_);
      check_energy();
      check_momentum(std::max(momentum_before, carried_momentum()));
      check_bodies();
      check_overlaps();
      before_ = now_;
    }
    return breaches_;
  }

 private:
  /// Notes a breach of the law if the value exceeds the bound. A value that is not a number is a breach, too.
  void hold(const char* law, double value, double bound) {
    if (value <= bound) return;
    const auto [place, is_first] = breaches_.try_emplace(law);
    Breach& breach = place->second;
    if (is_first) breach = {simulation_.steps(), simulation_.steps(), value, bound};
    if (value > breach.worst) {
      breach.worst = value;
      breach.worst_step = simulation_.steps();
    }
  }

  void check_energy() {
    const double scale = now_.energy_scale;
    if (scale == 0) return;
    hold("unexplained energy", now_.unexplained, explained);
    // Friction or restitution alone may add energy where the Delassus matrix couples them, and friction may
    // return the energy that gravity's kick takes in the step in which the kick reverses a slip; their sum
    // dissipates energy.
    hold("gain in impulses, of one step",
         (before_.ledger.friction + before_.ledger.restitution - now_.ledger.friction -
          now_.ledger.restitution) /
             scale,
         loss_rounding);
    const double lifted = std::max(-now_.ledger.correction, 0.0);  // correction has its own bound below
    hold("energy beyond the start's and what was done",
         (now_.total() - first_.total() - now_.ledger.work - lifted) / scale, energy_gain);
    if (!origin_.overlaps)
      hold("gain by correction", -now_.ledger.correction / scale,
           std::min(correction_gain, correction_gain_60 * second_order()));
    hold("drift of free rotation", std::abs(now_.ledger.integration) / scale, energy_gain);
  }

  double second_order() const {
    const double h = 60 * scene_.time.step / *scene_.time.substeps;
    return h * h;
  }

  double carried_momentum() const {
    double sum = 0;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.mobility[k] != Mobility::free) continue;
      sum += state_.bodies.velocity[k].norm() / state_.bodies.inverse_mass[k];
    }
    return sum;
  }

  /// Checks that the momentum that free bodies gain is what gravity and the bodies that are not free gave.
  void check_momentum(double carried) {
    const double dt = now_.time - before_.time;
    Vec3 expected = before_.momentum;
    double given = carried;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.mobility[k] == Mobility::free) {
        const Vec3 kick = dt / state_.bodies.inverse_mass[k] * scene_.gravity;
        expected += kick;
        given += kick.norm();
      } else {
        const Vec3 impulse = dt * simulation_.body(static_cast<std::int32_t>(k)).force;
        expected -= impulse;
        given += impulse.norm();
      }
    }
    double pressed = 0;
    for (const ContactForce& contact : simulation_.contact_forces()) pressed += dt * contact.force.norm();
    hold("momentum, of one step", (now_.momentum - expected).norm(),
         momentum_rounding * given + impulse_rounding * pressed);
    if (!origin_.closed) return;
    const Vec3 change = now_.angular_momentum - first_.angular_momentum - now_.ledger.angular_correction;
    // Angular momentum is taken about the origin. The bodies stay within some metres of it, or fly apart and
    // then carry more.
    hold("angular momentum", change.norm(),
         angular_rounding * (largest_distance() * given + spin_momentum()));
  }

  double largest_distance() const {
    double distance = 0;
    for (const Vec3& x : state_.bodies.position) distance = std::max(distance, x.norm());
    return distance;
  }

  double spin_momentum() const {
    double sum = 0;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.mobility[k] != Mobility::free) continue;
      sum += state_.bodies.spin[k].norm() / state_.bodies.inverse_inertia[k].minCoeff();
    }
    return sum;
  }

  void check_bodies() {
    hold("bodies lost", static_cast<double>(std::abs(now_.bodies - first_.bodies)), 0);
    double fastest = 0;  // largest kinetic energy of one body's translation (J)
    const double there = energy_there();
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      const bool finite = state_.bodies.position[k].allFinite() && state_.bodies.velocity[k].allFinite() &&
                          state_.bodies.spin[k].allFinite() &&
                          state_.bodies.orientation[k].coeffs().allFinite();
      hold("finite", finite ? 0 : 1, 0);
      if (state_.bodies.mobility[k] != Mobility::free) continue;
      fastest =
          std::max(fastest, 0.5 * state_.bodies.velocity[k].squaredNorm() / state_.bodies.inverse_mass[k]);
    }
    hold("energy of one body", fastest, 1.001 * there + 1e-12);
  }

  /// Returns the kinetic energy that the bodies can have (J): what they began with, and what gravity, driven
  /// bodies and position correction have given since.
  double energy_there() const {
    double fallen = 0;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.mobility[k] != Mobility::free) continue;
      const double fall = (state_.bodies.position[k] - start_.bodies.position[k]).dot(scene_.gravity);
      fallen += fall / state_.bodies.inverse_mass[k];
    }
    return first_.kinetic() + fallen + std::max(now_.ledger.work, 0.0) + std::abs(now_.ledger.correction);
  }

  /// Checks the overlaps. Contacts are found at one instant of a substep, and do not include how boxes turn
  /// and balls roll over one another within it: a turn by an angle a lets surfaces come closer by a^2 / 2 of
  /// their arm. Apart from that, overlaps only become smaller.
  void check_overlaps() {
    double turn = 0;
    double roll = 0;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.shape[k] == Shape::box) turn = std::max(turn, state_.bodies.spin[k].norm());
      if (state_.bodies.shape[k] == Shape::sphere)
        roll = std::max(roll, state_.bodies.velocity[k].norm() / state_.bodies.size[k].x());
    }
    const double h = scene_.time.step / *scene_.time.substeps;
    hold("overlap", now_.penetration.relative_max,
         std::max(first_overlap_ * (first_overlap_ > 1 ? overlap_growth : 1.0),
                  std::max(overlap, overlap_60 * second_order()) +
                      0.5 * h * h * (turn * turn * largest_ratio() + roll * roll)));
  }

  /// Returns the largest ratio of the sizes of two free bodies, because overlaps are relative to the smaller
  /// one.
  double largest_ratio() const {
    double smallest = HUGE_VAL;
    double largest = 0;
    for (std::size_t k = 0; k < state_.bodies.position.size(); ++k) {
      if (state_.bodies.mobility[k] != Mobility::free) continue;
      smallest = std::min(smallest, smallest_size(state_.bodies.shape[k], state_.bodies.size[k]));
      largest = std::max(largest, bounding_radius(state_.bodies.shape[k], state_.bodies.size[k]));
    }
    return largest / smallest;
  }

  const Scene& scene_;
  RandomScene origin_;
  Simulation simulation_;
  Observation first_, before_, now_;
  Snapshot start_, state_;
  double first_overlap_ = 0;
  Breaches breaches_;
};

}  // namespace

Breaches watch(const Scene& scene, const RandomScene& origin) { return Watch(scene, origin).run(); }

}  // namespace scree
