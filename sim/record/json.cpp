#include "sim/record/json.hpp"

#include "core/error.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <limits>

namespace scree {

namespace {

/// The words in the order of Verdict.
constexpr std::array<const char*, 5> verdict_words = {"passed", "failed", "not evaluated", "not reached",
                                                      "of seeds"};

double number_or_nan(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

}  // namespace

Json json_of(const CheckResult& result) {
  Json json = {{"check", result.check}, {"measured", result.measured}, {"expected", result.expected}};
  if (result.tolerance) json["tolerance"] = *result.tolerance;
  if (result.half_width) json["half_width"] = *result.half_width;
  json["margin"] = result.margin;
  json["error"] = result.error;
  json["verdict"] = verdict_words[static_cast<std::size_t>(result.verdict)];
  if (!result.problem.empty()) json["problem"] = result.problem;
  return json;
}

CheckResult check_result_from(const Json& json) {
  CheckResult result;
  result.check = json.at("check");
  result.expected = json.at("expected");
  if (json.contains("tolerance")) result.tolerance = number_or_nan(json["tolerance"]);
  result.measured = number_or_nan(json.at("measured"));
  if (json.contains("half_width")) result.half_width = number_or_nan(json["half_width"]);
  result.margin = number_or_nan(json.at("margin"));
  result.error = number_or_nan(json.at("error"));
  for (std::size_t k = 0; k < verdict_words.size(); ++k) {
    if (json.at("verdict") == verdict_words[k]) result.verdict = static_cast<Verdict>(k);
  }
  result.problem = json.value("problem", "");
  return result;
}

Json parsed_manifest(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    throw InputError(printable(
        fmt::format("{}: there is no such file; is {} a run folder?", file.string(), folder.string())));
  }
  return Json::parse(std::ifstream(file));
}

std::string not_a_manifest(const std::filesystem::path& file) {
  return printable(fmt::format("{}: is not the manifest of a run", file.string()));
}

}  // namespace scree
