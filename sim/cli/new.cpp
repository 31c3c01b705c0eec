// scree new: writes a commented scene to start from.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/templates.hpp"
#include "sim/record/files.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

/// Returns the text of the first line, which is a comment.
std::string_view summary(const Template& scene) { return scene.text.substr(2, scene.text.find('\n') - 2); }

int list_templates() {
  fmt::print("Usage: scree new NAME [--from TEMPLATE]; without --from, NAME is that of a template\n\n");
  for (const Template& scene : templates()) fmt::print("  {:<12} {}\n", scene.name, summary(scene));
  return status_done;
}

const Template& template_named(const std::string& name) {
  const auto found = std::ranges::find(templates(), std::string_view(name), &Template::name);
  if (found != templates().end()) return *found;
  std::vector<std::string_view> names;
  for (const Template& scene : templates()) names.push_back(scene.name);
  throw InputError(fmt::format("there is no template {}{}; --from takes one of {}", printable(name),
                               suggestion(name, names), fmt::join(names, ", ")));
}

/// Returns the text as one word of a shell, in quotes if it needs them.
std::string in_shell(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+=,:@%";
  if (text.find_first_not_of(plain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

/// Returns the file of the scene; NAME and NAME.yaml mean the same file. Throws InputError if it cannot be
/// written.
fs::path scene_file(fs::path name) {
  if (name.extension() != ".yaml") name += ".yaml";
  if (name.stem().string().starts_with('.') || name.filename() == ".yaml")
    throw InputError(fmt::format("{}: no name for a scene", printable(name.string())));
  if (fs::exists(fs::symlink_status(name)))
    throw InputError(fmt::format("{}: is there already; nothing was written", printable(name.string())));
  const fs::path folder = name.parent_path();
  if (!folder.empty() && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: there is no such folder", printable(folder.string())));
  return name;
}

}  // namespace

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const Template& scene : templates()) names.emplace_back(scene.name);
  return names;
}

int write_new_scene(const NewArguments& arguments) {
  if (arguments.name.empty()) return list_templates();
  const fs::path file = scene_file(arguments.name);
  const Template& scene = template_named(arguments.from.empty() ? file.stem().string() : arguments.from);
  write_file(file, scene.text);
  const std::string word = in_shell(file.string());
  fmt::print("{}: {}\nNext: scree plan {}, scree run {}\n", file.string(), summary(scene), word, word);
  return status_done;
}

}  // namespace scree::cli
