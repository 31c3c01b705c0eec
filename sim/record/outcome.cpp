#include "sim/record/outcome.hpp"

#include "core/error.hpp"
#include "sim/record/json.hpp"

#include <algorithm>

namespace scree {

namespace {

Json json_of(const SceneOutcome& outcome) {
  Json json = {{"scene", outcome.scene}, {"status", outcome.status}, {"wall_s", outcome.wall}};
  if (!outcome.settings.empty()) json["settings"] = outcome.settings;
  if (!outcome.message.empty()) json["message"] = outcome.message;
  if (!outcome.left_out.empty()) json["left_out"] = outcome.left_out;
  if (!outcome.notes.empty()) json["notes"] = outcome.notes;
  json["checks"] = Json::array();
  for (const CheckResult& check : outcome.checks) json["checks"].push_back(json_of(check));
  return json;
}

}  // namespace

int status_of(const std::vector<CheckResult>& checks) {
  const bool passed = std::ranges::none_of(checks, is_failure, &CheckResult::verdict);
  return passed ? status_done : status_check_failed;
}

std::string to_json(const SceneOutcome& outcome) { return json_of(outcome).dump(); }

SceneOutcome outcome_from_json(const std::string& text) try {
  const Json json = Json::parse(text);
  SceneOutcome outcome{.scene = json.at("scene"),
                       .settings = json.value("settings", ""),
                       .status = json.at("status"),
                       .message = json.value("message", ""),
                       .left_out = json.value("left_out", ""),
                       .notes = json.value("notes", std::vector<std::string>()),
                       .wall = json.at("wall_s"),
                       .checks = {}};
  for (const Json& check : json.at("checks")) outcome.checks.push_back(check_result_from(check));
  return outcome;
} catch (const Json::exception& error) {
  throw RunError(std::string("a scene's process did not report: ") + error.what());
}

Tally tally_of(const std::vector<SceneOutcome>& outcomes) {
  Tally tally;
  for (const SceneOutcome& outcome : outcomes) {
    for (const CheckResult& check : outcome.checks) {
      tally.passed += check.verdict == Verdict::passed;
      tally.failed += is_failure(check.verdict);
    }
    if (!outcome.message.empty()) ++tally.failed;
    if (!outcome.left_out.empty()) ++tally.left_out;
  }
  return tally;
}

std::vector<std::vector<SceneOutcome>> by_settings(const std::vector<SceneOutcome>& outcomes) {
  std::vector<std::vector<SceneOutcome>> groups;
  for (const SceneOutcome& outcome : outcomes) {
    const auto same = [&](const auto& group) { return group.front().settings == outcome.settings; };
    const auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) {
      groups.push_back({outcome});
    } else {
      group->push_back(outcome);
    }
  }
  return groups;
}

std::string to_json(const std::vector<SceneOutcome>& outcomes) {
  const Tally tally = tally_of(outcomes);
  Json json = {{"passed", tally.passed}, {"failed", tally.failed}, {"left_out", tally.left_out}};
  json["scenes"] = Json::array();
  for (const SceneOutcome& outcome : outcomes) json["scenes"].push_back(json_of(outcome));
  return json.dump(2) + '\n';
}

}  // namespace scree
