// The JSON library, which is included only here, and values as JSON; private to this folder.
#pragma once

#include "sim/record/checks.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace scree {

using Json = nlohmann::ordered_json;  ///< keeps keys in the order in which they are written

/// Returns an object with the keys check, measured, expected, tolerance, half_width, margin, error, verdict,
/// problem. NaN becomes null.
Json json_of(const CheckResult& result);
CheckResult check_result_from(const Json& json);

/// Returns the content of the manifest of a run. Throws InputError if there is no such file, Json::exception
/// if it is not JSON.
Json parsed_manifest(const std::filesystem::path& file);
/// Returns the complaint about a file that is not the manifest of a run.
std::string not_a_manifest(const std::filesystem::path& file);

}  // namespace scree
