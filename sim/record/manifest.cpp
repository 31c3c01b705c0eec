#include "sim/record/manifest.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/timing.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/json.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <exception>
#include <fstream>
#include <stdexcept>

namespace scree {

namespace {

Json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const Observation& o) {
  return {{"time", o.time},
          {"step", o.step},
          {"energy",
           {{"total", o.total()},
            {"linear", o.kinetic_linear},
            {"angular", o.kinetic_angular},
            {"potential", o.potential},
            {"unexplained", o.unexplained},
            {"scale", o.energy_scale},
            {"dissipated",
             {{"restitution", o.ledger.restitution},
              {"friction", o.ledger.friction},
              {"correction", o.ledger.correction}}},
            {"work", o.ledger.work},
            {"integration", o.ledger.integration},
            {"exchange", o.exchange.energy}}},
          {"momentum", json_of(o.momentum)},
          {"angular_momentum", json_of(o.angular_momentum)},
          {"centre", json_of(o.centre)},
          {"penetration",
           {{"max", o.penetration.max},
            {"mean", o.penetration.mean},
            {"p99", o.penetration.p99},
            {"relative_max", o.penetration.relative_max},
            {"relative_mean", o.penetration.relative_mean}}},
          {"gap_mean", o.gap_mean},
          {"contacts", o.contacts < 0 ? Json(nullptr) : Json(o.contacts)},
          {"pairs", o.pairs},
          {"bodies", o.bodies},
          {"speed", {{"max", o.speed_max}, {"rms", o.speed_rms}, {"kurtosis", o.speed_kurtosis}}},
          {"coordination_mean", o.coordination_mean}};
}

/// Returns the counts by decade, each named by its lower end; decades without a count are left out.
Json json_of(const Disagreements& d) {
  Json json = Json::object();
  double from = Disagreements::least;
  for (const std::int64_t count : d.count) {
    if (count > 0) json[fmt::format("{:.0e}", from)] = count;
    from *= 10;
  }
  return json;
}

Json json_of(const CrosscheckStats& c) {
  return {{"asked", c.asked},
          {"touching", json_of(c.touching)},
          {"ccd_deeper", json_of(c.ccd_deeper)},
          {"ccd_shallower", json_of(c.ccd_shallower)}};
}

Json json_of(const Counters& c) {
  return {{"substeps", c.substeps},
          {"redone", c.redone},
          {"cuts", c.cuts},
          {"sweeps", c.sweeps},
          {"direct", c.direct},
          {"direct_failed", c.direct_failed},
          {"long_direct", c.long_direct},
          {"long_direct_failed", c.long_direct_failed},
          {"residual", c.residual},
          {"scaled", c.scaled},
          {"impacts", c.impacts},
          {"unconverged", c.unconverged},
          {"unfinished_impacts", c.unfinished_impacts},
          {"pcs_made", c.pcs_made},
          {"pairs_tested", c.narrowphase.tested},
          {"ccd_calls", c.narrowphase.ccd_calls},
          {"ccd_rejected", c.narrowphase.ccd_rejected},
          {"ccd_stopped", c.narrowphase.ccd_stopped},
          {"crosscheck", json_of(c.narrowphase.crosscheck)}};
}

Json json_of(const std::vector<GuardCount>& guards) {
  Json json = Json::object();
  for (const GuardCount& guard : guards)
    json[std::string(guard.name)] = {{"count", guard.count},
                                     {"what", guard.what},
                                     {"setting", guard.setting},
                                     {"effect", guard.effect},
                                     {"matters", guard.matters}};
  return json;
}

Json json_of(const FailedBody& body) {
  return {{"name", body.name},
          {"position", json_of(body.position)},
          {"velocity", json_of(body.velocity)},
          {"spin", json_of(body.spin)}};
}

Json machine() {
  const MachineInfo info = machine_info();
  Json json = {{"cpu", info.cpu}, {"cores", info.cores}};
  const DeviceInfo gpu = device_info();
  if (gpu.built) json["gpu"] = (gpu.available ? "" : "none: ") + gpu.name;
  return json;
}

Json json_of(const std::vector<Feature>& model) {
  Json json = Json::object();
  for (const Feature& feature : model) json[feature.name] = {{"on", feature.on}, {"reason", feature.reason}};
  return json;
}

Json times(const std::vector<timing::Entry>& entries) {
  Json json = Json::object();
  for (const timing::Entry& entry : entries) {
    json[entry.label] = {{"seconds", entry.seconds}, {"calls", entry.calls}};
  }
  return json;
}

/// Returns a number of a step. Throws an exception if the value is not one.
std::int64_t step_in(const Json& json) {
  const std::int64_t step = json.is_number_integer() ? json.get<std::int64_t>() : -1;
  if (step < 0) throw std::range_error("the number of a step is none");
  return step;
}

/// Returns a hash that hex() has written. Throws an exception if the value is not one.
std::uint64_t hash_in(const Json& json) {
  const auto& text = json.get_ref<const std::string&>();
  std::uint64_t hash = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error != std::errc() || hex(hash) != text) throw std::range_error("a hash is no 16 digits");
  return hash;
}

}  // namespace

RecordedRun read_manifest(const std::filesystem::path& file) try {
  const Json json = parsed_manifest(file);
  RecordedRun run{.scene_hash = json.at("scene").at("hash"),
                  .commit = json.at("program").at("commit"),
                  .space = json.at("space"),
                  .states = {}};
  const auto add = [&run](const Json& step, const Json& hash) {
    run.states.push_back({step_in(step), hash_in(hash)});
  };
  for (const Json& state : json.at("states")) add(state.at("step"), state.at("hash"));
  add(json.at("steps"), json.at("state_hash"));
  // The state of the end is usually one of `states`, too.
  const std::size_t n = run.states.size();
  if (n > 1 && run.states[n - 2] == run.states[n - 1]) run.states.pop_back();
  return run;
} catch (const InputError&) {
  throw;
} catch (const std::exception&) {
  throw InputError(not_a_manifest(file));
}

std::string scene_hash_of(const Scene& scene) {
  return hex(hash_of(scene.resolved.data(), scene.resolved.size()));
}

std::optional<std::int64_t> steps_done(const std::filesystem::path& manifest) try {
  const Json json = Json::parse(std::ifstream(manifest));
  return json.at("status") == "done" ? std::optional(step_in(json.at("steps"))) : std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string manifest_of(const Scene& scene, const RunSummary& run) {
  const BuildInfo build = build_info();
  Json json = {{"status", run.status}};
  if (!run.error.empty()) json["error"] = run.error;
  for (const FailedBody& body : run.failed) json["failed_bodies"].push_back(json_of(body));
  json["scene"] = {{"name", scene.name},
                   {"source", scene.source.string()},
                   {"hash", scene_hash_of(scene)},
                   {"seed", scene.seed}};
  json["program"] = {{"version", build.version},
                     {"commit", build.commit},
                     {"build", build.build_type},
                     {"compiler", build.compiler}};
  json["machine"] = machine();
  json["space"] = run.space;
  json["precision"] = scene.precision == Precision::mixed ? "mixed" : "double";
  json["model"] = json_of(run.model);
  json["steps"] = run.steps;
  json["steps_total"] = run.steps_total;
  json["time"] = run.time;
  json["state_hash"] = hex(run.state_hash);
  json["states"] = Json::array();
  for (const StateMark& state : run.states)
    json["states"].push_back({{"step", state.step}, {"hash", hex(state.hash)}});
  json["checks"] = Json::array();
  for (const CheckResult& check : run.checks) json["checks"].push_back(scree::json_of(check));
  json["observation"] = json_of(run.last);
  json["frames"] = run.frames;
  if (!run.movie.empty()) json["movie"] = run.movie;
  if (!run.renderer.empty()) json["renderer"] = run.renderer;
  if (run.trajectory_frames > 0) json["trajectory_frames"] = run.trajectory_frames;
  json["warnings"] = run.warnings;
  json["wall_s"] = run.wall;
  if (!run.resumed_at.empty()) json["resumed_at"] = run.resumed_at;
  json["guards"] = json_of(run.guards);
  json["counters"] = json_of(run.last.counters);
  json["stages"] = times(timing::entries());
  if (!timing::calls().empty()) json["calls"] = times(timing::calls());
  return json.dump(2) + '\n';
}

}  // namespace scree
