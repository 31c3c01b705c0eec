// The writer of the table of keys as a JSON Schema. The schema holds what editors can check; rules that
// involve several keys are checked by the reader.
#include "sim/scene/keys.hpp"

#include <nlohmann/json.hpp>

#include <limits>

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a word as JSON; the words true and false become booleans.
Json word_json(const std::string& word) {
  if (word == "true" || word == "false") return word == "true";
  return word;
}

/// Returns a limit as JSON; whole numbers become integers, so that 1 does not become 1.0.
Json number_json(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  return static_cast<double>(whole) == x ? Json(whole) : Json(x);
}

void put_range(Json& schema, const Range& range) {
  if (std::isfinite(range.low)) schema[range.above ? "exclusiveMinimum" : "minimum"] = number_json(range.low);
  if (std::isfinite(range.high))
    schema[range.below ? "exclusiveMaximum" : "maximum"] = number_json(range.high);
}

/// Returns a default as JSON. A default is YAML of numbers, lists and plain words, and so is JSON except for
/// words, which become strings.
Json default_json(const std::string& fallback) {
  const Json parsed = Json::parse(fallback, nullptr, false);
  return parsed.is_discarded() ? Json(fallback) : parsed;
}

Json schema_of(const Type& type);

Json properties_of(const SectionType& section) {
  Json schema{{"type", "object"}, {"description", section.help}, {"additionalProperties", false}};
  Json required = Json::array();
  Json properties = Json::object();
  for (const KeyType& key : section.keys) {
    if (key.presence == Presence::future) continue;
    Json property = schema_of(key.type);
    std::string unit = key.type.unit;
    if (key.type.kind == Type::Kind::list) unit = key.type.parts[0].unit;
    property["description"] = unit.empty() ? key.help : key.help + " (" + unit + ")";
    if (!key.fallback.empty()) property["default"] = default_json(key.fallback);
    properties[key.name] = std::move(property);
    if (key.presence == Presence::required) required.push_back(key.name);
  }
  schema["properties"] = std::move(properties);
  if (!required.empty()) schema["required"] = std::move(required);
  return schema;
}

Json schema_of(const Type& type) {
  Json schema = Json::object();
  switch (type.kind) {
    case Type::Kind::integer:
    case Type::Kind::number:
      schema["type"] = type.kind == Type::Kind::integer ? "integer" : "number";
      put_range(schema, type.range);
      break;
    case Type::Kind::text:
      schema["type"] = "string";
      if (!type.pattern.empty()) schema["pattern"] = type.pattern;
      break;
    case Type::Kind::word:
      schema["enum"] = Json::array();
      for (const std::string& word : type.words) schema["enum"].push_back(word_json(word));
      break;
    case Type::Kind::list:
      schema["type"] = "array";
      schema["items"] = schema_of(type.parts[0]);
      if (type.least > 0) schema["minItems"] = type.least;
      if (type.most < std::numeric_limits<std::int64_t>::max()) schema["maxItems"] = type.most;
      break;
    case Type::Kind::named:
      schema["type"] = "object";
      schema["additionalProperties"] = schema_of(type.parts[0]);
      schema["maxProperties"] = type.most;
      break;
    case Type::Kind::section:
      return properties_of(*type.section);
    case Type::Kind::any_of:
      schema["anyOf"] = Json::array();
      for (const Type& part : type.parts) schema["anyOf"].push_back(schema_of(part));
      break;
  }
  return schema;
}

}  // namespace

std::string scene_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "scree scene"}};
  schema.update(schema_of(scene_codec().type));
  return schema.dump(2) + "\n";
}

}  // namespace scree
