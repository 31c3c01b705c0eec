#include "sim/bodies/emission.hpp"

#include "sim/scene/scatter.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace scree {

namespace {

constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

/// Number of tries for a body at each step. They are fewer than the default of scatter(), since a body that
/// has found no place is tried again at the next step.
constexpr int tries_at_each_step = 200;

/// Appends row `from_row` of another table.
void append(const BodyTable& from, std::size_t from_row, BodyTable& to) {
  for_each_field([from_row](const char*, auto& list, const auto& rows) { list.push_back(rows[from_row]); },
                 to, from);
}

}  // namespace

Emission::Emission(const Emitter& emitter, const TimeGrid& grid)
    : emitter_(emitter),
      due_(grid, 1 / emitter.rate, emitter.start),
      first_step_(static_cast<std::size_t>(emitter.bodies.count), never),
      place_(static_cast<std::size_t>(emitter.bodies.count), Vec3::Zero()) {}

bool Emission::holds(std::int32_t body, std::int64_t step) const {
  return first_step_[index_of(body)] <= step;
}

BodyTable Emission::emit(std::int64_t step, const Scene& scene, const BodiesNear& near) {
  const std::int64_t requested = std::min<std::int64_t>(requested_ + due_.due(step), emitter_.bodies.count);
  for (; requested_ < requested; ++requested_)
    waiting_.push_back(emitter_.bodies.first + static_cast<std::int32_t>(requested_));
  BodyTable come;
  if (waiting_.empty()) return come;

  double reach = 0;
  for (const std::int32_t id : waiting_) {
    const auto k = static_cast<std::size_t>(id);
    reach = std::max(reach, bounding_radius(scene.bodies.shape[k], scene.bodies.size[k]));
  }
  BodyTable table = near(emitter_.from.array() - reach, emitter_.to.array() + reach);
  std::vector<std::int32_t> obstacles(static_cast<std::size_t>(table.count()));
  std::iota(obstacles.begin(), obstacles.end(), 0);
  std::vector<std::int32_t> those(waiting_.size());
  std::iota(those.begin(), those.end(), static_cast<std::int32_t>(table.count()));
  for (const std::int32_t id : waiting_) append(scene.bodies, static_cast<std::size_t>(id), table);

  const std::int64_t fitted = scatter(table, those,
                                      {.from = emitter_.from,
                                       .to = emitter_.to,
                                       .seed = scene.seed,
                                       .period = scene.bodies.period,
                                       .round = static_cast<std::uint64_t>(step) + 1,
                                       .tries = tries_at_each_step},
                                      obstacles);
  waiting_.clear();
  for (std::size_t k = 0; k < those.size(); ++k) {
    const auto row = static_cast<std::size_t>(those[k]);
    const auto number = static_cast<std::int32_t>(table.id[row]);
    if (static_cast<std::int64_t>(k) >= fitted) {
      waiting_.push_back(number);
      continue;
    }
    append(table, row, come);
    first_step_[index_of(number)] = step;
    place_[index_of(number)] = table.position[row];
  }
  return come;
}

void Emission::archive(Archive& archive) {
  archive.part("due", due_);
  archive("requested", requested_);
  archive("waiting", waiting_);
  archive("first_step", first_step_);
  archive("place", place_);
  const auto count = static_cast<std::size_t>(emitter_.bodies.count);
  archive.expect(requested_ >= 0 && requested_ <= emitter_.bodies.count, "requested");
  archive.expect(first_step_.size() == count, "first_step");
  archive.expect(place_.size() == count, "place");
  archive.expect(std::ranges::all_of(waiting_,
                                     [&](std::int32_t id) {
                                       return id >= emitter_.bodies.first &&
                                              id < emitter_.bodies.first +
                                                       static_cast<std::int32_t>(requested_);
                                     }),
                 "waiting");
}

}  // namespace scree
