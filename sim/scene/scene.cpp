// Reads a scene: text -> tree -> overrides -> entry (by the table of keys) -> bodies.
#include "sim/scene/scene.hpp"

#include "core/error.hpp"
#include "sim/scene/build.hpp"
#include "sim/scene/memory.hpp"
#include "sim/scene/override.hpp"
#include "sim/scene/read_period.hpp"
#include "sim/scene/rules.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace scree {
namespace {

std::string read_text(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(fmt::format("{}: is a directory, not a scene file", file.string()));
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad())
    throw InputError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  return text;
}

/// Reads the text of a scene into an entry. `root` becomes the tree to which the entry refers.
SceneEntry read_entry(const std::string& text, const std::vector<Override>& overrides, Reader& reader,
                      Node& root) {
  try {
    root = parse_document(text);
  } catch (const SyntaxError& error) {
    reader.fail(error.mark, error.what);
  }
  if (root.kind == Node::Kind::null)
    reader.fail({1, 1}, "the file is empty; a scene begins with `format: 1`");
  const Codec<SceneEntry>& codec = scene_codec();
  SceneEntry entry;
  if (root.kind == Node::Kind::map) apply_overrides(root, codec.type, overrides);
  try {
    codec.read(entry, root, reader);
  } catch (const InputError& error) {
    reader.note(error);
  }
  reader.finish();
  return entry;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::filesystem::path& name,
                  const std::vector<Override>& overrides, std::optional<double> memory) {
  Reader reader(name.string(), overrides);
  Node root;
  SceneEntry entry = read_entry(text, overrides, reader, root);
  return build_scene(std::move(entry), name, memory.value_or(machine_memory()), reader);
}

Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  return parse_scene(read_text(file), file, overrides);
}

Period read_period(const std::filesystem::path& scene) {
  Reader reader(scene.string(), {});
  Node root;
  const SceneEntry entry = read_entry(read_text(scene), {}, reader, root);
  return entry.periodic ? period_of(*entry.periodic) : Period{};
}

}  // namespace scree
