// The table of measures, their parser and their values.
#include "sim/scene/measure.hpp"

#include "core/error.hpp"
#include "sim/scene/codec.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {

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

std::string_view first_word(std::string_view name) { return name.substr(0, name.find('.')); }

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw InputError(fmt::format("{} is no measure: {}", text, what));
}

const MeasureInfo* find_measure(std::string_view name, bool of_body) {
  const auto& table = measure_table();
  const auto found = std::find_if(table.begin(), table.end(), [&](const MeasureInfo& info) {
    return info.of_body == of_body && info.name == name;
  });
  return found == table.end() ? nullptr : &*found;
}

/// `rest` is the measure's name, with its component if it is a vector.
Measure parse_name(std::string_view text, std::string_view rest, bool of_body) {
  if (const MeasureInfo* whole = find_measure(rest, of_body); whole && !whole->is_vector)
    return {whole->kind, -1, Component::norm};
  const std::size_t dot = rest.rfind('.');
  const MeasureInfo* info = find_measure(rest.substr(0, dot), of_body);
  if (info && info->is_vector) {
    const std::string_view last = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    const auto found = std::find(std::begin(components), std::end(components), last);
    if (found == std::end(components)) fail(text, fmt::format("{} needs .x, .y, .z or .norm", info->name));
    return {info->kind, -1, static_cast<Component>(found - std::begin(components))};
  }
  std::vector<std::string_view> known;
  for (const MeasureInfo& m : measure_table())
    if (m.of_body == of_body) known.push_back(m.name);
  std::string hint = suggestion(rest, known);
  if (hint.empty() && info == nullptr) hint = suggestion(rest.substr(0, dot), known);
  fail(text, fmt::format("{} is unknown{}", rest, hint));
}

}  // namespace

const std::vector<MeasureInfo>& measure_table() {
  using K = MeasureKind;
  static const std::vector<MeasureInfo> table{
      {K::position, "position", true, true, "m", "of the centre"},
      {K::velocity, "velocity", true, true, "m/s", "of the centre"},
      {K::spin, "spin", true, true, "rad/s", "angular velocity"},
      {K::acceleration, "acceleration", true, true, "m/s^2", "change of velocity over the last step / step"},
      {K::force, "force", true, true, "N", "contact impulse on the body over the last step / step"},
      {K::tilt, "tilt", true, false, "rad", "angle of the body's z axis from its start"},
      {K::energy_total, "energy.total", false, false, "J", "kinetic + potential, of the free bodies"},
      {K::energy_kinetic, "energy.kinetic", false, false, "J", "linear + angular"},
      {K::energy_linear, "energy.linear", false, false, "J", "of the motion of the centres"},
      {K::energy_angular, "energy.angular", false, false, "J", "of the spins"},
      {K::energy_potential, "energy.potential", false, false, "J", "-sum of m g . x"},
      {K::energy_unexplained, "energy.unexplained", false, false, "",
       "change of energy that the ledger does not explain, over the energy scale"},
      {K::energy_work, "energy.work", false, false, "J", "done by prescribed bodies since the start"},
      {K::energy_integration, "energy.integration", false, false, "J",
       "drift of the free rotation since the start"},
      {K::dissipated_restitution, "energy.dissipated.restitution", false, false, "J",
       "lost in normal impulses since the start"},
      {K::dissipated_friction, "energy.dissipated.friction", false, false, "J",
       "lost in tangential impulses since the start"},
      {K::dissipated_correction, "energy.dissipated.correction", false, false, "J",
       "lost by position correction since the start"},
      {K::momentum, "momentum", false, true, "kg m/s", "of the free bodies"},
      {K::angular_momentum, "angular_momentum", false, true, "kg m^2/s",
       "of the free bodies, about the origin"},
      {K::penetration_max, "penetration.max", false, false, "m", "deepest overlap of all pairs"},
      {K::penetration_mean, "penetration.mean", false, false, "m", "mean over overlapping pairs"},
      {K::penetration_p99, "penetration.p99", false, false, "m", "99th percentile over overlapping pairs"},
      {K::penetration_relative_max, "penetration.relative_max", false, false, "",
       "deepest overlap, by the smaller body's radius or smallest half edge"},
      {K::penetration_relative_mean, "penetration.relative_mean", false, false, "", "mean of the same"},
      {K::gap_mean, "gap.mean", false, false, "m", "mean |gap| of loaded contact points"},
      {K::contacts_count, "contacts.count", false, false, "",
       "contact points that carried an impulse in the last step"},
      {K::pairs_count, "pairs.count", false, false, "", "potentially colliding pairs"},
      {K::bodies_count, "bodies.count", false, false, "", "bodies in the scene"},
      {K::speed_max, "speed.max", false, false, "m/s", "of the free bodies"},
      {K::speed_rms, "speed.rms", false, false, "m/s", "of the free bodies"},
      {K::coordination_mean, "coordination.mean", false, false, "",
       "loaded contacts per free body, counted for each of its two"},
  };
  return table;
}

bool is_measure_word(std::string_view name) {
  if (name == "region") return true;  // a later part of the language
  return std::any_of(measure_table().begin(), measure_table().end(),
                     [&](const MeasureInfo& info) { return !info.of_body && first_word(info.name) == name; });
}

Measure parse_measure(std::string_view text, const std::map<std::string, std::int32_t>& bodies) {
  const std::string_view first = first_word(text);
  if (first == "region") throw InputError(fmt::format("{} {}", text, future_text));
  if (is_measure_word(first)) return parse_name(text, text, false);
  const auto body = bodies.find(std::string(first));
  if (body == bodies.end()) {
    std::vector<std::string_view> known;
    for (const auto& [name, id] : bodies) known.push_back(name);
    for (const MeasureInfo& info : measure_table())
      if (!info.of_body) known.push_back(first_word(info.name));
    fail(text, fmt::format("there is no body called {}{}", first, suggestion(first, known)));
  }
  if (first.size() == text.size()) fail(text, "it says nothing about the body, such as .position.z");
  Measure measure = parse_name(text, text.substr(first.size() + 1), true);
  measure.body = body->second;
  return measure;
}

double evaluate(const Measure& measure, const Observation& observation,
                const std::function<BodyState(std::int32_t)>& body) {
  const Observation& o = observation;
  switch (measure.kind) {
    case MeasureKind::position:
    case MeasureKind::velocity:
    case MeasureKind::spin:
    case MeasureKind::acceleration:
    case MeasureKind::force:
    case MeasureKind::tilt:
      return value_of_body(measure, body(measure.body));
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
    case MeasureKind::coordination_mean:
      return o.coordination_mean;
  }
  return 0;
}

}  // namespace scree
