#include "sim/scene/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

namespace scree {

MaterialNames::MaterialNames(const std::vector<MaterialEntry>& materials) : materials_(materials) {
  for (std::size_t i = 0; i < materials.size(); ++i)
    index_.emplace(materials[i].name, static_cast<std::int32_t>(i));
}

std::optional<std::int32_t> MaterialNames::find(std::string_view name) const {
  const auto found = index_.find(name);
  return found == index_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::int32_t> MaterialNames::find_or_at(std::string_view name_or_place) const {
  std::size_t place = 0;
  const char* const end = name_or_place.data() + name_or_place.size();
  const auto [stop, error] = std::from_chars(name_or_place.data(), end, place);
  if (error != std::errc{} || stop != end) return find(name_or_place);
  return place < materials_.size() ? std::optional(static_cast<std::int32_t>(place)) : std::nullopt;
}

std::int32_t MaterialNames::require(const std::string& name, const Node& where, const Reader& reader) const {
  const std::optional<std::int32_t> index = find(name);
  if (!index) reader.fail(where.mark, unknown(name));
  return *index;
}

std::string MaterialNames::unknown(std::string_view name) const {
  std::vector<std::string_view> known;
  for (const MaterialEntry& material : materials_) known.push_back(material.name);
  return fmt::format("there is no material {}{}", name, suggestion(name, known));
}

std::vector<ContactLaw> contact_laws(const std::vector<MaterialEntry>& materials, const MaterialNames& names,
                                     std::vector<ContactEntry>& listed, Reader& reader) {
  const std::size_t n = materials.size();
  std::vector<ContactLaw> laws(n * n);
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      laws[a * n + b] = {std::sqrt(materials[a].restitution) * std::sqrt(materials[b].restitution),
                         std::sqrt(materials[a].friction) * std::sqrt(materials[b].friction),
                         std::sqrt(materials[a].rolling_friction.value_or(0)) *
                             std::sqrt(materials[b].rolling_friction.value_or(0))};
  const Reader::Step step(reader, "contacts");
  std::map<std::array<std::size_t, 2>, SourceMark> seen;
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const Reader::Step item(reader, i);
    ContactEntry& contact = listed[i];
    const Node& between = *contact.node->find("between");
    const Reader::Step key(reader, "between");
    const auto a = static_cast<std::size_t>(names.require(contact.between[0], between.items[0], reader));
    const auto b = static_cast<std::size_t>(names.require(contact.between[1], between.items[1], reader));
    const auto [first, fresh] = seen.emplace(std::array{std::min(a, b), std::max(a, b)}, between.mark);
    if (!fresh) reader.fail(between.mark, "the pair is listed already, at " + reader.place(first->second));
    ContactLaw& law = laws[a * n + b];
    if (!contact.restitution) contact.restitution = law.restitution;
    if (!contact.friction) contact.friction = law.friction;
    if (!contact.rolling_friction && law.rolling_friction > 0)
      contact.rolling_friction = law.rolling_friction;
    law = {*contact.restitution, *contact.friction, contact.rolling_friction.value_or(0)};
    laws[b * n + a] = law;
  }
  return laws;
}

}  // namespace scree
