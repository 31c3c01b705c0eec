// Contacts beside a trajectory: what is written is read again, by scree and by HDF5, which knows nothing of
// it.
#include "sim/record/contact_writer.hpp"

#include "core/error.hpp"
#include "sim/record/exports.hpp"
#include "tests/sim/record/hdf5_dataset.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scree {
namespace {

namespace fs = std::filesystem;
using Opening = AtomicFile::Opening;

constexpr int frames = 5;

/// A floor of two kinds, and balls.
Scene balls(int count) {
  Scene scene;
  scene.record.trajectory = {.in_double = true, .contacts = true};
  for (int k = 0; k < count; ++k) {
    scene.bodies.position.emplace_back(k, 0.5 * k, 1);
    scene.bodies.shape.push_back(k == 0 ? Shape::plane : k == 1 ? Shape::box : Shape::sphere);
    scene.bodies.mobility.push_back(k < 2 ? Mobility::fixed : Mobility::free);
  }
  return scene;
}

/// Other contacts in each frame, in some none.
std::vector<ContactForce> contacts_of(int frame, int bodies) {
  std::vector<ContactForce> contacts;
  for (int k = 0; frame % 2 == 1 && k + frame < bodies; ++k)
    contacts.push_back({k, k + frame, Vec3(0.1 * k, frame, -1.0 / (k + 1)), Vec3(k, 0.25, 0.125 * frame)});
  return contacts;
}

Snapshot shot(const Scene& scene, int f) { return {0.1 * f, 10 * f, scene.bodies}; }

fs::path write(const Scene& scene, const TemporaryFolder& folder) {
  fs::path file = folder / contacts_name;
  ContactWriter writer(scene, file, Opening::anew, 1);
  const auto bodies = static_cast<int>(scene.bodies.position.size());
  for (int f = 0; f < frames; ++f) writer.append(shot(scene, f), contacts_of(f, bodies));
  writer.finish();
  writer.drop();
  return file;
}

TEST(Contacts, AreReadAgainAsTheyWere) {
  const TemporaryFolder folder;
  const Scene scene = balls(40);
  TrajectoryReader reader(write(scene, folder));
  ASSERT_EQ(reader.index().frames().size(), frames);
  for (int f = 0; f < frames; ++f) {
    const std::vector<ContactForce> expected = contacts_of(f, 40);
    const std::vector<ContactForce> found = contact_forces(reader, static_cast<std::size_t>(f), 40);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].i, expected[k].i);
      EXPECT_EQ(found[k].j, expected[k].j);
      EXPECT_EQ(found[k].force, expected[k].force);
      EXPECT_EQ(found[k].point, expected[k].point);
    }
  }
  EXPECT_THROW(contact_forces(reader, 1, 20), InputError) << "of a scene with fewer bodies";
}

TEST(Contacts, EndAtCentresButForWhatDoesNotMove) {
  const Scene scene = balls(3);
  const Vec3 point(7, 8, 9);
  EXPECT_EQ(contact_end(scene.bodies, 0, point), point);
  EXPECT_EQ(contact_end(scene.bodies, 1, point), point);
  EXPECT_EQ(contact_end(scene.bodies, 2, point), scene.bodies.position[2]);
}

/// As the description of the format says that a step is read (VTK File Formats, "VTKHDF", temporal data).
TEST(Contacts, AreLinesForHDF5) {
  constexpr hsize_t line_kind = 1, kinds = 4;
  const TemporaryFolder folder;
  const Scene scene = balls(40);
  const fs::path file = write(scene, folder);
  for (hsize_t f = 0; f < frames; ++f) {
    const auto number = [&](const std::string& name, hsize_t row) {
      return static_cast<hsize_t>(dataset(file, "/VTKHDF/" + name, row, 1)[0]);
    };
    const std::vector<ContactForce> expected = contacts_of(static_cast<int>(f), 40);
    const hsize_t part = number("Steps/PartOffsets", f);
    const hsize_t lines = number("Lines/NumberOfCells", part);
    ASSERT_EQ(lines, expected.size());
    ASSERT_EQ(number("NumberOfPoints", part), 2 * lines);
    ASSERT_EQ(number("Lines/NumberOfConnectivityIds", part), 2 * lines);
    EXPECT_EQ(number("Vertices/NumberOfCells", part), 0);
    if (lines == 0) continue;
    const auto offset_of = [&](const char* name) {
      return static_cast<hsize_t>(dataset(file, std::string("/VTKHDF/Steps/") + name, f, 1)[line_kind]);
    };
    ASSERT_EQ(dataset(file, "/VTKHDF/Steps/CellOffsets", f, 1).size(), kinds);
    const std::vector<double> ends =
        dataset(file, "/VTKHDF/Lines/Offsets", offset_of("CellOffsets") + part, lines + 1);
    const std::vector<double> ids =
        dataset(file, "/VTKHDF/Lines/Connectivity", offset_of("ConnectivityIdOffsets"), 2 * lines);
    const hsize_t first = number("Steps/PointDataOffsets/force", f);
    const std::vector<double> force = dataset(file, "/VTKHDF/PointData/force", first, 2 * lines);
    for (hsize_t k = 0; k < lines; ++k) {
      EXPECT_EQ(ends[k + 1], static_cast<double>(2 * k + 2));
      EXPECT_EQ(ids[2 * k], static_cast<double>(2 * k));
      EXPECT_EQ(ids[2 * k + 1], static_cast<double>(2 * k + 1));
      EXPECT_EQ(force[6 * k + 4], expected[k].force.y());
      EXPECT_EQ(force[6 * k + 1], -expected[k].force.y()) << "the first feels the opposite";
    }
  }
}

TEST(Contacts, AreExported) {
  const TemporaryFolder folder;
  TrajectoryReader reader(write(balls(3), folder));
  const auto tables = export_contacts(reader, ExportFormat::csv, folder.path());
  ASSERT_TRUE(tables);
  EXPECT_EQ(text_of(*tables / "00001.csv"),
            "position_x,position_y,position_z,force_x,force_y,force_z,point_x,point_y,point_z,id,other\n"
            "0,0.25,0.125,-0,-1,1,0,0.25,0.125,0,1\n"
            "0,0.25,0.125,0,1,-1,0,0.25,0.125,1,0\n"
            "1,0.25,0.125,-0.1,-1,0.5,1,0.25,0.125,1,2\n"
            "2,1,1,0.1,1,-0.5,1,0.25,0.125,2,1\n");
  const auto collection = export_contacts(reader, ExportFormat::vtp, folder.path());
  ASSERT_TRUE(collection);
  EXPECT_NE(text_of(*collection).find("file=\"contacts/00001.vtp\""), std::string::npos);
  EXPECT_NE(text_of(folder / "contacts/00001.vtp").find("NumberOfVerts=\"0\" NumberOfLines=\"2\""),
            std::string::npos);
  EXPECT_FALSE(export_contacts(reader, ExportFormat::xyz, folder.path()));
}

}  // namespace
}  // namespace scree
