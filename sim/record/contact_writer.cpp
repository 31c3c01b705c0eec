#include "sim/record/contact_writer.hpp"

#include "core/error.hpp"
#include "sim/record/trajectory_columns.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <span>
#include <utility>

namespace scree {

namespace {

/// One row: a contact as it acts on one of its bodies.
struct ContactEnd {
  Vec3 position, force, point;
  std::int32_t id, other;
};

struct ContactColumnSource {
  TrajectoryColumn column;
  ColumnNumbers (*numbers)(const ContactEnd& end);
};

ColumnNumbers numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

std::vector<ContactColumnSource> contact_columns(bool in_double) {
  const int real = in_double ? sizeof(double) : sizeof(float);
  const FieldType vector{FieldType::Kind::real, real, 3};
  const FieldType number{FieldType::Kind::integer, sizeof(std::int32_t), 1};
  return {{{"position", vector}, [](const ContactEnd& end) { return numbers_of(end.position); }},
          {{"force", vector}, [](const ContactEnd& end) { return numbers_of(end.force); }},
          {{"point", vector}, [](const ContactEnd& end) { return numbers_of(end.point); }},
          {{"id", number}, [](const ContactEnd& end) { return ColumnNumbers{double(end.id)}; }},
          {{"other", number}, [](const ContactEnd& end) { return ColumnNumbers{double(end.other)}; }}};
}

std::vector<TrajectoryColumn> columns_of(const std::vector<ContactColumnSource>& sources) {
  std::vector<TrajectoryColumn> columns;
  for (const ContactColumnSource& source : sources) columns.push_back(source.column);
  return columns;
}

ContactEnd end_of(const BodyTable& bodies, const ContactForce& contact, bool second) {
  const std::int32_t body = second ? contact.j : contact.i;
  return {.position = contact_end(bodies, body, contact.point),
          .force = second ? contact.force : Vec3(-contact.force),
          .point = contact.point,
          .id = body,
          .other = second ? contact.i : contact.j};
}

/// Expected number of rows for each body, from a few contacts. The unused rest of a chunk is zeros, which
/// take hardly any space.
constexpr std::int64_t expected_ends = 8;

}  // namespace

Vec3 contact_end(const BodyTable& bodies, std::int32_t body, const Vec3& point) {
  const auto k = static_cast<std::size_t>(body);
  const bool stays = bodies.mobility[k] == Mobility::fixed || is_boundary(bodies.shape[k]);
  if (stays) return point;
  Vec3 centre = bodies.position[k];
  bodies.period.bring_near(point, centre);
  return centre;
}

double contact_bytes(const Scene& scene) {
  double row = 0;
  for (const ContactColumnSource& source : contact_columns(scene.record.trajectory->in_double))
    row += static_cast<double>(source.column.type.row());
  return 2 * row;
}

ContactWriter::ContactWriter(const Scene& scene, std::filesystem::path file, AtomicFile::Opening opening,
                             int threads)
    : in_double_(scene.record.trajectory->in_double),
      journal_(columns_of(contact_columns(in_double_)), expected_ends * scene.bodies.count(), Cells::lines,
               std::move(file), opening, threads) {}

void ContactWriter::append(const Snapshot& snapshot, const std::vector<ContactForce>& contacts) {
  const std::vector<ContactColumnSource> columns = contact_columns(in_double_);
  journal_.append(
      {.frame = {snapshot.step, snapshot.time, 2 * std::ssize(contacts)},
       .write =
           [&](std::size_t column, std::int64_t first, std::int64_t count, std::span<std::byte> out) {
             std::byte* to = out.data();
             for (std::int64_t row = first; row < first + count; ++row) {
               const ContactForce& contact = contacts[static_cast<std::size_t>(row / 2)];
               const ContactEnd end = end_of(snapshot.bodies, contact, row % 2 == 1);
               append_numbers(columns[column].numbers(end), columns[column].column.type, to);
             }
           },
       .is_kept = [](std::size_t) { return false; }});
}

std::vector<ContactForce> contact_forces(TrajectoryReader& contacts, std::size_t frame, std::int64_t bodies) {
  const auto numbers = [&](const char* name) {
    const int column = contacts.column(name);
    if (column < 0) throw InputError(fmt::format("{}: no contacts: it has no {}", contacts_name, name));
    return contacts.numbers(frame, static_cast<std::size_t>(column));
  };
  const std::vector<double> force = numbers("force"), point = numbers("point");
  const std::vector<double> id = numbers("id"), other = numbers("other");
  const auto body = [bodies](double number) {
    if (!(number >= 0 && number < static_cast<double>(bodies)))
      throw InputError(fmt::format("{}: contacts of other bodies than scene.yaml's", contacts_name));
    return static_cast<std::int32_t>(number);
  };
  std::vector<ContactForce> found;
  // The second row of each contact has the force on its second body.
  for (std::size_t row = 1; row < id.size(); row += 2)
    found.push_back({body(other[row]), body(id[row]), Eigen::Map<const Vec3>(&force[3 * row]),
                     Eigen::Map<const Vec3>(&point[3 * row])});
  return found;
}

}  // namespace scree
