// The table of measures, their parser and their values.
#include "sim/scene/measure.hpp"

#include "core/error.hpp"
#include "sim/scene/codec.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {

constexpr std::string_view region_word = "region";
constexpr std::string_view components[] = {"x", "y", "z", "norm"};

double part_of(const Vec3& v, Component component) {
  return component == Component::norm ? v.norm() : v[static_cast<int>(component)];
}

/// Angle between the body's z axis now and at the start; exact near 0 and pi, where acos is not.
double tilt_of(const BodyState& body) {
  const Vec3 now = body.orientation * Vec3::UnitZ();
  const Vec3 start = body.start_orientation * Vec3::UnitZ();
  return std::atan2(now.cross(start).norm(), now.dot(start));
}

double value_of_body(const Measure& measure, const BodyState& body) {
  switch (measure.kind) {
    case MeasureKind::position:
      return part_of(body.position, measure.component);
    case MeasureKind::velocity:
      return part_of(body.velocity, measure.component);
    case MeasureKind::spin:
      return part_of(body.spin, measure.component);
    case MeasureKind::acceleration:
      return part_of(body.acceleration, measure.component);
    case MeasureKind::force:
      return part_of(body.force, measure.component);
    default:
      return tilt_of(body);
  }
}

/// Of the mesh that the measure is of, about its place for the torque.
double value_of_mesh(const Measure& measure, const std::function<BodyState(std::int32_t)>& body) {
  const BodyState first = body(measure.body);
  const Quat turned = first.orientation * first.start_orientation.conjugate();
  const Vec3 place = first.position + turned * measure.to_place;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (std::int32_t k = 0; k < measure.triangles; ++k) {
    const BodyState triangle = k == 0 ? first : body(measure.body + k);
    force += triangle.force;
    torque += triangle.torque + (triangle.position - place).cross(triangle.force);
  }
  return part_of(measure.kind == MeasureKind::mesh_force ? force : torque, measure.component);
}

std::string_view first_word(std::string_view name) { return name.substr(0, name.find('.')); }

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw InputError(fmt::format("{} is no measure: {}", text, what));
}

const MeasureInfo* find_measure(std::string_view name, MeasureSubject of) {
  const auto& table = measure_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const MeasureInfo& info) {
    return info.of == of && info.name == name;
  });
  return found == table.end() ? nullptr : &*found;
}

/// `rest` is the measure's name, with its component if it is a vector.
Measure parse_name(std::string_view text, std::string_view rest, MeasureSubject of) {
  if (const MeasureInfo* whole = find_measure(rest, of); whole && !whole->is_vector)
    return {.kind = whole->kind};
  const std::size_t dot = rest.rfind('.');
  const MeasureInfo* info = find_measure(rest.substr(0, dot), of);
  if (info && info->is_vector) {
    const std::string_view last = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    const auto found = std::find(std::begin(components), std::end(components), last);
    if (found == std::end(components)) fail(text, fmt::format("{} needs .x, .y, .z or .norm", info->name));
    return {.kind = info->kind, .component = static_cast<Component>(found - std::begin(components))};
  }
  std::vector<std::string_view> known;
  for (const MeasureInfo& m : measure_table())
    if (m.of == of) known.push_back(m.name);
  std::string hint = suggestion(rest, known);
  if (hint.empty() && info == nullptr) hint = suggestion(rest.substr(0, dot), known);
  fail(text, fmt::format("{} is unknown{}", rest, hint));
}

/// What follows the name of the body or region.
std::string_view after_name(std::string_view text, std::string_view name, const char* example) {
  const auto end = static_cast<std::size_t>(name.data() - text.data()) + name.size();
  if (end >= text.size()) fail(text, fmt::format("it says nothing about {}, such as {}", name, example));
  return text.substr(end + 1);
}

Measure parse_of_body(std::string_view text, const Scene& scene) {
  const std::string_view name = first_word(text);
  const auto body = scene.body_names.find(std::string(name));
  const auto mesh = std::ranges::find(scene.meshes, name, &MeshBodies::name);
  if (mesh != scene.meshes.end()) {
    Measure measure = parse_name(text, after_name(text, name, ".force.z"), MeasureSubject::mesh);
    measure.body = mesh->bodies.first;
    measure.triangles = mesh->bodies.count;
    measure.to_place = mesh->place - scene.bodies.position[static_cast<std::size_t>(measure.body)];
    return measure;
  }
  if (body == scene.body_names.end()) {
    std::vector<std::string_view> known;
    for (const auto& [other, id] : scene.body_names) known.push_back(other);
    for (const MeshBodies& other : scene.meshes) known.push_back(other.name);
    for (const MeasureInfo& info : measure_table())
      if (info.of == MeasureSubject::run) known.push_back(first_word(info.name));
    fail(text, fmt::format("there is no body called {}{}", name, suggestion(name, known)));
  }
  Measure measure = parse_name(text, after_name(text, name, ".position.z"), MeasureSubject::body);
  measure.body = body->second;
  return measure;
}

Measure parse_of_region(std::string_view text, const Scene& scene) {
  const std::string_view rest = after_name(text, first_word(text), ".exit.flux");
  const std::string_view name = first_word(rest);
  const auto region = std::find_if(scene.regions.begin(), scene.regions.end(),
                                   [&](const Region& candidate) { return candidate.name == name; });
  if (region == scene.regions.end()) {
    std::vector<std::string_view> known;
    for (const Region& other : scene.regions) known.push_back(other.name);
    fail(text, fmt::format("there is no region called {}{}", name, suggestion(name, known)));
  }
  Measure measure = parse_name(text, after_name(text, name, ".count"), MeasureSubject::region);
  measure.region = static_cast<std::int32_t>(region - scene.regions.begin());
  return measure;
}

}  // namespace

const std::vector<MeasureInfo>& measure_table() {
  using K = MeasureKind;
  using S = MeasureSubject;
  static const std::vector<MeasureInfo> table{
      {K::position, "position", S::body, true, "m", "of the centre"},
      {K::velocity, "velocity", S::body, true, "m/s", "of the centre"},
      {K::spin, "spin", S::body, true, "rad/s", "angular velocity"},
      {K::acceleration, "acceleration", S::body, true, "m/s^2",
       "change of velocity over the last step / step"},
      {K::force, "force", S::body, true, "N", "contact impulse on the body over the last step / step"},
      {K::tilt, "tilt", S::body, false, "rad", "angle of the body's z axis from its start"},
      {K::mesh_force, "force", S::mesh, true, "N", "contact impulse on all of it over the last step / step"},
      {K::mesh_torque, "torque", S::mesh, true, "N m",
       "of these impulses about its place, which is its `at`"},
      {K::energy_total, "energy.total", S::run, false, "J", "kinetic + potential, of the free bodies"},
      {K::energy_kinetic, "energy.kinetic", S::run, false, "J", "linear + angular"},
      {K::energy_linear, "energy.linear", S::run, false, "J", "of the motion of the centres"},
      {K::energy_angular, "energy.angular", S::run, false, "J", "of the spins"},
      {K::energy_potential, "energy.potential", S::run, false, "J", "-sum of m g . x"},
      {K::energy_unexplained, "energy.unexplained", S::run, false, "",
       "change of energy that the ledger does not explain, over the energy scale"},
      {K::energy_work, "energy.work", S::run, false, "J",
       "done by prescribed bodies and applied forces since the start"},
      {K::energy_integration, "energy.integration", S::run, false, "J",
       "drift of the free rotation since the start"},
      {K::energy_exchange, "energy.exchange", S::run, false, "J",
       "that came with bodies which appeared, less what went with bodies, since the start"},
      {K::dissipated_restitution, "energy.dissipated.restitution", S::run, false, "J",
       "lost in normal impulses since the start"},
      {K::dissipated_friction, "energy.dissipated.friction", S::run, false, "J",
       "lost in tangential impulses since the start"},
      {K::dissipated_correction, "energy.dissipated.correction", S::run, false, "J",
       "lost by position correction since the start"},
      {K::momentum, "momentum", S::run, true, "kg m/s", "of the free bodies"},
      {K::angular_momentum, "angular_momentum", S::run, true, "kg m^2/s",
       "of the free bodies, about the origin"},
      {K::centre, "centre", S::run, true, "m", "of mass, of the free bodies"},
      {K::penetration_max, "penetration.max", S::run, false, "m", "deepest overlap of all pairs"},
      {K::penetration_mean, "penetration.mean", S::run, false, "m", "mean over overlapping pairs"},
      {K::penetration_p99, "penetration.p99", S::run, false, "m", "99th percentile over overlapping pairs"},
      {K::penetration_relative_max, "penetration.relative_max", S::run, false, "",
       "deepest overlap, by the smaller body's radius or smallest half edge"},
      {K::penetration_relative_mean, "penetration.relative_mean", S::run, false, "", "mean of the same"},
      {K::gap_mean, "gap.mean", S::run, false, "m", "mean |gap| of loaded contact points"},
      {K::contacts_count, "contacts.count", S::run, false, "",
       "contact points that carried an impulse in the last step"},
      {K::pairs_count, "pairs.count", S::run, false, "", "potentially colliding pairs"},
      {K::bodies_count, "bodies.count", S::run, false, "", "bodies that are there"},
      {K::speed_max, "speed.max", S::run, false, "m/s", "of the free bodies"},
      {K::speed_rms, "speed.rms", S::run, false, "m/s", "of the free bodies"},
      {K::speed_kurtosis, "speed.kurtosis", S::run, false, "",
       "mean v^4 / (mean v^2)^2 of the free bodies: 1 if all are equally fast, 5/3 in a gas at equilibrium"},
      {K::impacts_count, "impacts.count", S::run, false, "",
       "impacts that bounced, or met inside a step, since the start"},
      {K::coordination_mean, "coordination.mean", S::run, false, "",
       "loaded contacts per free body, counted for each of its two"},
      {K::guards_redone, "guards.redone", S::run, false, "",
       "steps that failed and were taken again in smaller substeps, since the start"},
      {K::guards_left, "guards.left", S::run, false, "",
       "bodies that left the world and were taken out, since the start"},
      {K::guards_sweeps, "guards.sweeps", S::run, false, "",
       "substeps that used all their sweeps over the contacts, since the start"},
      {K::guards_impacts, "guards.impacts", S::run, false, "",
       "substeps whose chains of impacts hit their bound, since the start"},
      {K::guards_newton, "guards.newton", S::run, false, "",
       "groups of contacts that neither Newton's method nor all sweeps have solved, since the start"},
      {K::guards_gjk, "guards.gjk", S::run, false, "",
       "calls of libccd that hit their bound, and were answered in another way, since the start"},
      {K::emission_requested, "emission.requested", S::run, false, "",
       "bodies that emitters were to send since the start"},
      {K::emission_emitted, "emission.emitted", S::run, false, "", "and those of them that found room"},
      {K::region_count, "count", S::region, false, "", "free bodies whose centre lies in the closed box"},
      {K::region_fraction, "fraction", S::region, false, "", "volume of these bodies / volume of the box"},
      {K::region_flux, "flux", S::region, false, "kg/s",
       "mass of these bodies less that one step before / step: negative while the region empties. Its mean "
       "over steps a to b is the mass gained since the step before a / the time since then"},
      {K::region_removed, "removed", S::region, false, "",
       "bodies that the region has taken out since the start"},
      {K::region_removed_mass, "removed_mass", S::region, false, "kg", "their mass"},
  };
  return table;
}

bool is_of_overlaps(const Measure& measure) {
  const MeasureKind kind = measure.kind;
  const bool penetration =
      kind >= MeasureKind::penetration_max && kind <= MeasureKind::penetration_relative_mean;
  return penetration || kind == MeasureKind::pairs_count;
}

bool is_measure_word(std::string_view name) {
  return name == region_word ||
         std::any_of(measure_table().begin(), measure_table().end(), [&](const MeasureInfo& info) {
           return info.of == MeasureSubject::run && first_word(info.name) == name;
         });
}

Measure parse_measure(std::string_view text, const Scene& scene) {
  const std::string_view first = first_word(text);
  if (first == region_word) return parse_of_region(text, scene);
  return is_measure_word(first) ? parse_name(text, text, MeasureSubject::run) : parse_of_body(text, scene);
}

double evaluate(const Measure& measure, const Observation& observation,
                const std::function<BodyState(std::int32_t)>& body) {
  const Observation& o = observation;
  const auto region = [&]() -> const RegionState& {
    return o.regions.at(static_cast<std::size_t>(measure.region));
  };
  switch (measure.kind) {
    case MeasureKind::position:
    case MeasureKind::velocity:
    case MeasureKind::spin:
    case MeasureKind::acceleration:
    case MeasureKind::force:
    case MeasureKind::tilt:
      return value_of_body(measure, body(measure.body));
    case MeasureKind::mesh_force:
    case MeasureKind::mesh_torque:
      return value_of_mesh(measure, body);
    case MeasureKind::energy_total:
      return o.total();
    case MeasureKind::energy_kinetic:
      return o.kinetic();
    case MeasureKind::energy_linear:
      return o.kinetic_linear;
    case MeasureKind::energy_angular:
      return o.kinetic_angular;
    case MeasureKind::energy_potential:
      return o.potential;
    case MeasureKind::energy_unexplained:
      return o.unexplained;
    case MeasureKind::energy_work:
      return o.ledger.work;
    case MeasureKind::energy_integration:
      return o.ledger.integration;
    case MeasureKind::energy_exchange:
      return o.exchange.energy;
    case MeasureKind::dissipated_restitution:
      return o.ledger.restitution;
    case MeasureKind::dissipated_friction:
      return o.ledger.friction;
    case MeasureKind::dissipated_correction:
      return o.ledger.correction;
    case MeasureKind::momentum:
      return part_of(o.momentum, measure.component);
    case MeasureKind::angular_momentum:
      return part_of(o.angular_momentum, measure.component);
    case MeasureKind::centre:
      return part_of(o.centre, measure.component);
    case MeasureKind::penetration_max:
      return o.penetration.max;
    case MeasureKind::penetration_mean:
      return o.penetration.mean;
    case MeasureKind::penetration_p99:
      return o.penetration.p99;
    case MeasureKind::penetration_relative_max:
      return o.penetration.relative_max;
    case MeasureKind::penetration_relative_mean:
      return o.penetration.relative_mean;
    case MeasureKind::gap_mean:
      return o.gap_mean;
    case MeasureKind::contacts_count:
      return static_cast<double>(o.contacts);
    case MeasureKind::pairs_count:
      return static_cast<double>(o.pairs);
    case MeasureKind::bodies_count:
      return static_cast<double>(o.bodies);
    case MeasureKind::speed_max:
      return o.speed_max;
    case MeasureKind::speed_rms:
      return o.speed_rms;
    case MeasureKind::speed_kurtosis:
      return o.speed_kurtosis;
    case MeasureKind::impacts_count:
      return static_cast<double>(o.counters.impacts);
    case MeasureKind::coordination_mean:
      return o.coordination_mean;
    case MeasureKind::guards_redone:
      return static_cast<double>(o.counters.redone);
    case MeasureKind::guards_left:
      return static_cast<double>(o.left);
    case MeasureKind::guards_sweeps:
      return static_cast<double>(o.counters.unconverged);
    case MeasureKind::guards_impacts:
      return static_cast<double>(o.counters.unfinished_impacts);
    case MeasureKind::guards_newton:
      return static_cast<double>(o.counters.patient_failed);
    case MeasureKind::guards_gjk:
      return static_cast<double>(o.counters.narrowphase.ccd_stopped);
    case MeasureKind::emission_requested:
      return static_cast<double>(o.requested);
    case MeasureKind::emission_emitted:
      return static_cast<double>(o.emitted);
    case MeasureKind::region_count:
      return static_cast<double>(region().count);
    case MeasureKind::region_fraction:
      return region().fraction;
    case MeasureKind::region_flux:
      return region().flux;
    case MeasureKind::region_removed:
      return static_cast<double>(region().removed.count);
    case MeasureKind::region_removed_mass:
      return region().removed.mass;
  }
  return 0;
}

}  // namespace scree
