// The one place that includes the JSON library; private to this folder.
#pragma once

#include "sim/record/checks.hpp"

#include <nlohmann/json.hpp>

namespace scree {

using Json = nlohmann::ordered_json;  ///< keeps keys in the order in which they are written

/// Keys check, measured, expected, tolerance, margin, error, verdict, problem. NaN is written as null.
Json json_of(const CheckResult& result);
CheckResult check_result_from(const Json& json);

}  // namespace scree
