// Materials by their names, and the contact laws of their pairs.
#pragma once

#include "sim/scene/keys.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace scree {

class MaterialNames {
 public:
  /// The entries must outlive this object.
  explicit MaterialNames(const std::vector<MaterialEntry>& materials);

  std::optional<std::int32_t> find(std::string_view name) const;
  /// Returns the index of the material with this name, or, if the text is a number, with this index from 0.
  std::optional<std::int32_t> find_or_at(std::string_view name_or_place) const;
  /// Returns the index of the material with this name. Throws InputError at `where`, the value that names the
  /// material, if there is none.
  std::int32_t require(const std::string& name, const Node& where, const Reader& reader) const;
  /// Returns a message such as "there is no material glas (did you mean glass?)".
  std::string unknown(std::string_view name) const;

 private:
  const std::vector<MaterialEntry>& materials_;
  std::unordered_map<std::string_view, std::int32_t> index_;
};

/// Returns the contact laws of all pairs, in the order of Scene::laws: geometric means, except for the pairs
/// listed. Writes the values that a listed pair leaves out into its entry.
std::vector<ContactLaw> contact_laws(const std::vector<MaterialEntry>& materials, const MaterialNames& names,
                                     std::vector<ContactEntry>& listed, Reader& reader);

}  // namespace scree
