#include "sim/scene/completion.hpp"

#include "sim/scene/keys.hpp"
#include "sim/scene/type.hpp"

#include <algorithm>

namespace scree {

namespace {

using Types = std::vector<const Type*>;

/// Appends a type to the forms; in place of a type any_of, appends its alternatives.
void add_forms(const Type& type, Types& forms) {
  if (type.kind != Type::Kind::any_of) return forms.push_back(&type);
  for (const Type& part : type.parts) add_forms(part, forms);
}

Types items_of(const Types& forms) {
  Types items;
  for (const Type* form : forms)
    if (form->kind == Type::Kind::list) add_forms(form->parts[0], items);
  return items;
}

Types members_of(const Types& forms, std::string_view name) {
  Types members;
  for (const Type* form : forms) {
    if (form->kind == Type::Kind::named) add_forms(form->parts[0], members);
    if (form->kind != Type::Kind::section) continue;
    for (const KeyType& key : form->section->keys)
      if (key.name == name && key.presence != Presence::future) add_forms(key.type, members);
  }
  return members;
}

/// Returns the types to which a path such as bodies[2].velocity leads; none if it leads nowhere.
Types forms_at(std::string_view path) {
  Types forms;
  add_forms(scene_codec().type, forms);
  while (!path.empty()) {
    if (path.front() == '[') {
      forms = items_of(forms);
      path.remove_prefix(std::min(path.find(']'), path.size() - 1) + 1);
    } else {
      forms = members_of(forms, path.substr(0, path.find_first_of(".[")));
      path.remove_prefix(std::min(path.find_first_of(".["), path.size()));
    }
    if (path.starts_with('.')) path.remove_prefix(1);
  }
  return forms;
}

/// Returns the characters that may follow a key, by the forms that its value may have: `.`, `[` or `=`.
std::string signs_after(const Type& type) {
  Types forms;
  add_forms(type, forms);
  std::string signs;
  for (const Type* form : forms) {
    const bool holds_keys = form->kind == Type::Kind::section || form->kind == Type::Kind::named;
    for (const char sign : std::string(holds_keys ? "." : form->kind == Type::Kind::list ? "[=" : "="))
      if (signs.find(sign) == std::string::npos) signs += sign;
  }
  return signs;
}

std::vector<Continuation> words_at(std::string_view path, std::string_view typed) {
  std::vector<Continuation> words;
  for (const Type* form : forms_at(path))
    for (const std::string& word : form->words)
      if (word.starts_with(typed)) words.push_back({std::string(path) + "=" + word, ""});
  return words;
}

}  // namespace

std::vector<Continuation> continuations_of(std::string_view typed) {
  if (const std::size_t equals = typed.find('='); equals != typed.npos)
    return words_at(typed.substr(0, equals), typed.substr(equals + 1));
  const std::size_t last = typed.rfind('.') + 1;  // npos + 1 is 0
  std::vector<Continuation> found;
  for (const Type* form : forms_at(typed.substr(0, last))) {
    if (form->kind != Type::Kind::section) continue;
    for (const KeyType& key : form->section->keys)
      if (key.name.starts_with(typed.substr(last)) && key.presence != Presence::future)
        for (const char sign : signs_after(key.type))
          found.push_back({std::string(typed.substr(0, last)) + key.name + sign, key.help});
  }
  return found;
}

}  // namespace scree
