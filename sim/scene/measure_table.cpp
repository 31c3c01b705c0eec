// The table of measures: what can be measured, in which unit, and how its value is computed.
#include "sim/scene/measure.hpp"

#include <cmath>

namespace scree {
namespace {

using S = MeasureSubject;
using M = const Measured&;

template <class Count>
double number(Count count) {
  return static_cast<double>(count);
}

/// Returns the angle between the body's z axis now and at the start. It is exact near 0 and pi, where acos is
/// not.
double tilt_of(const BodyState& body) {
  const Vec3 now = body.orientation * Vec3::UnitZ();
  const Vec3 start = body.start_orientation * Vec3::UnitZ();
  return std::atan2(now.cross(start).norm(), now.dot(start));
}

constexpr MeasureInfo measures[] = {
    {"position", S::body, "m", "of the centre", nullptr, [](M s) -> Vec3 { return s.body->position; }},
    {"velocity", S::body, "m/s", "of the centre", nullptr, [](M s) -> Vec3 { return s.body->velocity; }},
    {"spin", S::body, "rad/s", "angular velocity", nullptr, [](M s) -> Vec3 { return s.body->spin; }},
    {"acceleration", S::body, "m/s^2", "change of velocity over the last step / step", nullptr,
     [](M s) -> Vec3 { return s.body->acceleration; }},
    {"force", S::body, "N", "contact impulse on the body over the last step / step", nullptr,
     [](M s) -> Vec3 { return s.body->force; }},
    {"tilt", S::body, "rad", "angle of the body's z axis from its start",
     [](M s) -> double { return tilt_of(*s.body); }, nullptr},
    {"force", S::mesh, "N", "contact impulse on all of it over the last step / step", nullptr,
     [](M s) -> Vec3 { return s.mesh->force; }},
    {"torque", S::mesh, "N m", "of these impulses about its place, which is its `at`", nullptr,
     [](M s) -> Vec3 { return s.mesh->torque; }},
    {"energy.total", S::run, "J", "kinetic + potential, of the free bodies",
     [](M s) -> double { return s.run.total(); }, nullptr},
    {"energy.kinetic", S::run, "J", "linear + angular", [](M s) -> double { return s.run.kinetic(); },
     nullptr},
    {"energy.linear", S::run, "J", "of the motion of the centres",
     [](M s) -> double { return s.run.kinetic_linear; }, nullptr},
    {"energy.angular", S::run, "J", "of the spins", [](M s) -> double { return s.run.kinetic_angular; },
     nullptr},
    {"energy.potential", S::run, "J", "-sum of m g . x", [](M s) -> double { return s.run.potential; },
     nullptr},
    {"energy.unexplained", S::run, "",
     "change of energy that the ledger does not explain, over the energy scale",
     [](M s) -> double { return s.run.unexplained; }, nullptr},
    {"energy.work", S::run, "J", "done by prescribed bodies and applied forces since the start",
     [](M s) -> double { return s.run.ledger.work; }, nullptr},
    {"energy.integration", S::run, "J", "drift of the free rotation since the start",
     [](M s) -> double { return s.run.ledger.integration; }, nullptr},
    {"energy.exchange", S::run, "J",
     "that came with bodies which appeared, less what went with bodies, since the start",
     [](M s) -> double { return s.run.exchange.energy; }, nullptr},
    {"energy.dissipated.restitution", S::run, "J", "lost in normal impulses since the start",
     [](M s) -> double { return s.run.ledger.restitution; }, nullptr},
    {"energy.dissipated.friction", S::run, "J", "lost in tangential impulses since the start",
     [](M s) -> double { return s.run.ledger.friction; }, nullptr},
    {"energy.dissipated.correction", S::run, "J", "lost by position correction since the start",
     [](M s) -> double { return s.run.ledger.correction; }, nullptr},
    {"momentum", S::run, "kg m/s", "of the free bodies", nullptr, [](M s) -> Vec3 { return s.run.momentum; }},
    {"angular_momentum", S::run, "kg m^2/s", "of the free bodies, about the origin", nullptr,
     [](M s) -> Vec3 { return s.run.angular_momentum; }},
    {"centre", S::run, "m", "of mass, of the free bodies", nullptr, [](M s) -> Vec3 { return s.run.centre; }},
    {"penetration.max", S::run, "m", "deepest overlap of all pairs",
     [](M s) -> double { return s.run.penetration.max; }, nullptr},
    {"penetration.mean", S::run, "m", "mean over overlapping pairs",
     [](M s) -> double { return s.run.penetration.mean; }, nullptr},
    {"penetration.p99", S::run, "m", "99th percentile over overlapping pairs",
     [](M s) -> double { return s.run.penetration.p99; }, nullptr},
    {"penetration.relative_max", S::run, "",
     "deepest overlap, by the smaller body's radius or smallest half edge",
     [](M s) -> double { return s.run.penetration.relative_max; }, nullptr},
    {"penetration.relative_mean", S::run, "", "mean of the same",
     [](M s) -> double { return s.run.penetration.relative_mean; }, nullptr},
    {"gap.mean", S::run, "m", "mean |gap| of loaded contact points",
     [](M s) -> double { return s.run.gap_mean; }, nullptr},
    {"contacts.count", S::run, "", "contact points that carried an impulse in the last step",
     [](M s) -> double { return s.run.contacts < 0 ? NAN : number(s.run.contacts); }, nullptr},
    {"pairs.count", S::run, "", "potentially colliding pairs",
     [](M s) -> double { return number(s.run.pairs); }, nullptr},
    {"bodies.count", S::run, "", "bodies that are there", [](M s) -> double { return number(s.run.bodies); },
     nullptr},
    {"speed.max", S::run, "m/s", "of the free bodies", [](M s) -> double { return s.run.speed_max; },
     nullptr},
    {"speed.rms", S::run, "m/s", "of the free bodies", [](M s) -> double { return s.run.speed_rms; },
     nullptr},
    {"speed.kurtosis", S::run, "",
     "mean v^4 / (mean v^2)^2 of the free bodies: 1 if all are equally fast, 5/3 in a gas at equilibrium",
     [](M s) -> double { return s.run.speed_kurtosis; }, nullptr},
    {"impacts.count", S::run, "", "impacts that bounced, or met inside a step, since the start",
     [](M s) -> double { return number(s.run.counters.impacts); }, nullptr},
    {"coordination.mean", S::run, "", "loaded contacts per free body, counted for each of its two",
     [](M s) -> double { return s.run.coordination_mean; }, nullptr},
    {"guards.redone", S::run, "",
     "steps that failed and were taken again in smaller substeps, since the start",
     [](M s) -> double { return number(s.run.counters.redone); }, nullptr},
    {"guards.left", S::run, "", "bodies that left the world and were taken out, since the start",
     [](M s) -> double { return number(s.run.left); }, nullptr},
    {"guards.sweeps", S::run, "", "substeps that used all their sweeps over the contacts, since the start",
     [](M s) -> double { return number(s.run.counters.unconverged); }, nullptr},
    {"guards.impacts", S::run, "", "substeps whose chains of impacts reached the limit, since the start",
     [](M s) -> double { return number(s.run.counters.unfinished_impacts); }, nullptr},
    {"guards.newton", S::run, "",
     "groups of contacts that neither all sweeps nor a second, longer direct solution has solved, since the "
     "start",
     [](M s) -> double { return number(s.run.counters.long_direct_failed); }, nullptr},
    {"guards.gjk", S::run, "",
     "calls of libccd that reached their limit, and were answered in another way, since the start",
     [](M s) -> double { return number(s.run.counters.narrowphase.ccd_stopped); }, nullptr},
    {"emission.requested", S::run, "", "bodies that emitters were to send since the start",
     [](M s) -> double { return number(s.run.requested); }, nullptr},
    {"emission.emitted", S::run, "", "and those of them that found room",
     [](M s) -> double { return number(s.run.emitted); }, nullptr},
    {"count", S::region, "", "free bodies whose centre lies in the closed box",
     [](M s) -> double { return number(s.region->count); }, nullptr},
    {"fraction", S::region, "", "volume of these bodies / volume of the box",
     [](M s) -> double { return s.region->fraction; }, nullptr},
    {"flux", S::region, "kg/s",
     "mass of these bodies less that one step before / step: negative while the region empties. Its mean "
     "over steps a to b is the mass gained since the step before a / the time since then",
     [](M s) -> double { return s.region->flux; }, nullptr},
    {"removed", S::region, "", "bodies that the region has taken out since the start",
     [](M s) -> double { return number(s.region->removed.count); }, nullptr},
    {"removed_mass", S::region, "kg", "their mass", [](M s) -> double { return s.region->removed.mass; },
     nullptr},
};

}  // namespace

std::span<const MeasureInfo> measure_table() { return measures; }

}  // namespace scree
