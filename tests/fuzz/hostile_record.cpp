// Readers of hostile input for files that a run leaves: checkpoints, trajectories, tables and manifests.
#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "core/error.hpp"
#include "core/hash.hpp"
#include "sim/record/checkpoint.hpp"
#include "sim/record/comparison.hpp"
#include "sim/record/manifest.hpp"
#include "sim/record/trajectory_reader.hpp"
#include "tests/fuzz/breach.hpp"
#include "tests/fuzz/hostile_input.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace scree {
namespace {

void require_same(const SavedState& a, const SavedState& b) {
  const bool same = std::ranges::equal(a.fields, b.fields, [](const SavedField& x, const SavedField& y) {
    return x.name == y.name && x.type == y.type && std::ranges::equal(x.bytes.view(), y.bytes.view());
  });
  if (!same) breach("the state is another when it is written and read again");
}

/// The line that separates the two parts of an input.
constexpr std::string_view between = "====\n";

/// A part of the state with every kind of field.
struct Part {
  struct Record {
    std::int32_t number;
    float numbers[3];
  };
  BodyTable bodies;
  std::int64_t step = 0;
  std::vector<Record> entries;
  Array<float, Host> nothing;
  std::string scene;
  bool flag = false;

  Part() {
    for_each_field([](const char*, auto& field) { field.resize(1); }, bodies);
  }
  void archive(Archive& archive) {
    archive("step", step);
    archive("memory/entries", entries);
    archive("nothing", nothing);
    archive("run/scene", scene);
    archive("flag", flag);
    archive.part("bodies", bodies);
  }
};

void load(const SavedState& state) {
  Part part;
  try {
    Archive::loading(state).part("part", part);
  } catch (const InputError&) {
    return;
  }
  SavedState saved;
  Archive::saving(saved).part("part", part);
  for (const SavedField& field : saved.fields) {
    const SavedField* from = state.find(field.name);
    if (!std::ranges::equal(field.bytes.view(), from->bytes.view())) breach("loaded otherwise than saved");
  }
}

/// Writes the state to a file and reads it again. Returns nothing if it cannot be written, because HDF5
/// refuses some names of objects: for example those with nothing between two slashes.
std::optional<SavedState> read_again(const SavedState& state) {
  static const TemporaryFolder folder;
  try {
    write_checkpoint(folder / "again.h5", state);
  } catch (const RunError&) {
    return std::nullopt;
  }
  return read_checkpoint(folder / "again.h5");
}

std::optional<Comparison> compare(std::string_view a, std::string_view b) {
  static const TemporaryFolder folder;
  static const bool made =
      std::filesystem::create_directories(folder / "a") && std::filesystem::create_directories(folder / "b");
  if (!made) throw std::runtime_error("no room for the tables");
  write_text(folder / "a/metrics.csv", std::string(a));
  write_text(folder / "b/metrics.csv", std::string(b));
  try {
    return compare_runs(folder / "a", folder / "b");
  } catch (const InputError& error) {
    require_message(error.what());
    return std::nullopt;
  }
}

void require_nothing(const std::optional<Comparison>& itself) {
  if (itself && !itself->is_within(0)) breach("a table differs from itself");
}

double largest(const Comparison& comparison) {
  double most = 0;
  for (const ColumnDifference& difference : comparison.differences) {
    if (!(difference.largest > 0) || !(difference.relative > 0)) breach("a difference of nothing");
    most = std::max(most, difference.largest);
  }
  return most;
}

}  // namespace

void read_hostile_checkpoint(std::string_view bytes) {
  const std::string file =
      fmt::format("{}{:016x}\n{}", checkpoint_head, hash_of(bytes.data(), bytes.size()), bytes);
  try {
    const SavedState state = read_checkpoint(file_of(file));
    if (state.bytes() > file.size()) breach("a state of more bytes than its file");
    load(state);
    if (const std::optional<SavedState> again = read_again(state)) require_same(state, *again);
  } catch (const RunError& error) {
    require_message(error.what());
    if (std::string_view(error.what()).find(" is damaged: ") != std::string_view::npos) breach(error.what());
  }
}

void read_hostile_trajectory(std::string_view bytes) {
  constexpr std::size_t most_frames = 8;  // more are not read, because many frames may share the same chunks
  const std::size_t end = std::min(bytes.find(between), bytes.size());
  const std::string_view numbers = bytes.substr(0, end);
  const std::string_view lines = bytes.substr(std::min(end + between.size(), bytes.size()));
  const std::string file =
      fmt::format("{}{}scree trajectory 1, xxh3 and length of the lines before: {:016x} {:015}\n", numbers,
                  lines, hash_of(lines.data(), lines.size()), lines.size());
  try {
    TrajectoryReader trajectory(file_of(file));
    const std::size_t frames = std::min(trajectory.index().frames().size(), most_frames);
    for (std::size_t f = 0; f < frames; ++f) {
      for (std::size_t c = 0; c < trajectory.index().columns().size(); ++c) {
        const std::size_t found = trajectory.numbers(f, c).size();
        const auto asked = trajectory.index().frames()[f].rows * trajectory.index().columns()[c].type.columns;
        if (static_cast<std::int64_t>(found) != asked) breach("a frame of other rows than its own");
        if (found > 1100 * (numbers.size() + 1)) breach("more numbers than bytes can hold");
      }
    }
  } catch (const InputError& error) {
    require_message(error.what());
    if (std::string_view(error.what()).find("its index is another") != std::string_view::npos)
      breach(error.what());
  }
}

void read_hostile_tables(std::string_view bytes) {
  const std::size_t end = bytes.find(between);
  const std::string_view a = bytes.substr(0, end);
  const std::string_view b = end == std::string_view::npos ? a : bytes.substr(end + between.size());
  require_nothing(compare(a, a));
  require_nothing(compare(b, b));
  const std::optional<Comparison> one = compare(a, b), other = compare(b, a);
  if (one.has_value() != other.has_value()) breach("compared from one side alone");
  if (!one) return;
  if (one->rows != other->rows || one->columns != other->columns ||
      one->unlike.size() != other->unlike.size() || one->differences.size() != other->differences.size() ||
      largest(*one) != largest(*other))
    breach("from the other side they differ otherwise");
}

void read_hostile_manifest(std::string_view bytes) {
  const std::string& file = file_of(bytes);
  std::optional<std::int64_t> repeated;
  try {
    const RecordedRun run = read_manifest(file);
    for (const StateMark& state : run.states)
      if (state.step < 0) breach("a step before the first");
    repeated = run.states.back().step;
  } catch (const InputError& error) {
    require_message(error.what());
  }
  const std::optional<std::int64_t> done = steps_done(file);
  if (done && (*done < 0 || *done != repeated.value_or(*done))) breach("other steps are done");
}

}  // namespace scree
