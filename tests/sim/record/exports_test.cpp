// Shapes in the formats of other programs: beside the scene's own words, from which nothing here was made.
#include "sim/record/exports.hpp"

#include "core/error.hpp"
#include "sim/record/trajectory_writer.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace scree {
namespace {

namespace fs = std::filesystem;

const std::array<Vec3, 4> corners = {Vec3(0.3, 0, 0), Vec3(0, 0.5, 0), Vec3(0, 0, 0.4),
                                     Vec3(-0.1, -0.2, -0.3)};

/// One of each shape but a tube, which no scene has beside the others; a mesh that stands and one that moves.
constexpr const char* zoo = R"(format: 1
time: {end: 1, step: 0.1}
materials: {stone: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {mesh: {file: two.obj}, at: [0, 0, 3], fixed: true, material: stone}
  - {sphere: {radius: 0.5}, at: [1, 0, 0], material: stone}
  - {box: {size: [0.5, 1, 1.5]}, at: [2, 0, 0], material: stone}
  - {capsule: {radius: 0.25, length: 1.5}, at: [3, 0, 0], rotate: {axis: [1, 0, 0], degrees: 90}, material: stone}
  - {cylinder: {radius: 0.25, length: 1.5}, at: [4, 0, 0], rotate: {axis: [0, 1, 0], degrees: 90}, material: stone}
  - {polyhedron: {points: [[0.3, 0, 0], [0, 0.5, 0], [0, 0, 0.4], [-0.1, -0.2, -0.3]]}, at: [5, 1, 2], rotate: {axis: [0, 0, 1], degrees: 90}, material: stone}
  - {mesh: {file: two.obj}, at: [0, 0, -3], motion: {velocity: [0, 0, -1]}, material: stone}
)";
constexpr const char* two_triangles = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 1\nf 1 2 3\nf 1 3 4\n";

class Exports : public testing::Test {
 protected:
  Exports() {
    write_text(folder_ / "two.obj", two_triangles);
    write_text(folder_ / "zoo.yaml", zoo);
    scene_ = read_scene(folder_ / "zoo.yaml");
  }

  /// Three frames: what is not fixed goes 1 m up from one to the next; in the last one the capsule is gone.
  TrajectoryReader trajectory(TrajectorySettings settings = {.in_double = true}) {
    scene_.record.trajectory = settings;
    TrajectoryWriter writer(scene_, folder_ / "trajectory.vtkhdf", AtomicFile::Opening::anew, 1);
    Snapshot shot{0, 0, scene_.bodies};
    for (int f = 0; f < 3; ++f, shot.time += 0.5, ++shot.step) {
      if (f == 2) std::ranges::replace(shot.bodies.mobility, Mobility::free, Mobility::absent);
      writer.append(shot);
      for (std::size_t k = 0; k < shot.bodies.shape.size(); ++k)
        if (shot.bodies.mobility[k] != Mobility::fixed) shot.bodies.position[k].z() += 1;
    }
    writer.finish();
    writer.drop();
    return TrajectoryReader(folder_ / "trajectory.vtkhdf");
  }
  HullOf hulls() const {
    return [this](std::int32_t body) -> const Hull& {
      return *scene_.geometry->of_body[static_cast<std::size_t>(body)].hull;
    };
  }

  TemporaryFolder folder_;
  Scene scene_;
};

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

std::vector<double> numbers_of(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<double>(stream), {}};
}

void expect_numbers(const std::string& line, const std::vector<double>& expected) {
  const std::vector<double> found = numbers_of(line);
  ASSERT_EQ(found.size(), expected.size()) << line;
  for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-15) << line;
}

const double half_turn = std::sqrt(0.5);

// Aspherical shapes as OVITO 3.17 draws them: of (sphero)cylinders radius and length, of boxes half extents.
TEST_F(Exports, XyzHasEachShapeAsOvitoTakesIt) {
  TrajectoryReader reader = trajectory({.velocity = false, .in_double = true});
  const auto [file, left_out] = export_trajectory(reader, ExportFormat::xyz, {}, folder_.path());
  const std::vector<std::string> lines = lines_of(file);
  ASSERT_EQ(lines.size(), 2 * (2 + 5) + 2);
  EXPECT_NE(lines[1].find("types=\"1 sphere, 2 box, 3 capsule, 4 cylinder, 5 polyhedron"), std::string::npos);
  EXPECT_NE(lines[1].find("left_out=\"1 plane, 4 triangles\""), std::string::npos) << lines[1];
  EXPECT_EQ(left_out.words(), "1 plane, 4 triangles");
  expect_numbers(lines[2], {1, 1, 0, 0, 3, 0, 0.5, 0, 0, 0, 0, 0, 0, 1, 0});
  expect_numbers(lines[3], {2, 2, 0, 0, 4, 0, 0, 0.25, 0.5, 0.75, 0, 0, 0, 1, 0});
  expect_numbers(lines[4], {3, 3, 0, 0, 5, 0, 0.25, 0.25, 0.25, 1.5, half_turn, 0, 0, half_turn, 0});
  expect_numbers(lines[5], {4, 4, 0, 0, 6, 0, 0.25, 0.25, 0.25, 1.5, 0, half_turn, 0, half_turn, 0});
  EXPECT_EQ(numbers_of(lines[6]).front(), 5);
}

TEST_F(Exports, LammpsHasTwiceTheShapesOfXyz) {
  TrajectoryReader reader = trajectory({.velocity = false, .in_double = true});
  const auto [file, left_out] = export_trajectory(reader, ExportFormat::lammps, {}, folder_.path());
  const std::vector<std::string> lines = lines_of(file);
  ASSERT_EQ(lines.size(), 3 * 11 + 2 * 5);
  EXPECT_EQ(left_out.words(), "1 plane, 4 triangles");
  expect_numbers(lines[11], {4, 1, 1, 0, 0, 0.5, 1, 1, 1, 1, 0, 0, 0, 0});
  expect_numbers(lines[12], {5, 2, 2, 0, 0, 0, 0.5, 1, 1.5, 1, 0, 0, 0, 0});
  expect_numbers(lines[13], {6, 3, 3, 0, 0, 0.25, 0.5, 0.5, 3, half_turn, half_turn, 0, 0, 0});
  expect_numbers(lines[14], {7, 4, 4, 0, 0, 0.25, 0.5, 0.5, 3, half_turn, 0, half_turn, 0, 0});
}

TEST_F(Exports, ParticlesHaveTheirPeriod) {
  TrajectoryReader reader = trajectory();
  const Period period = period_of(Vec3(0.5, 0, -1), Vec3(8, 0, 0.25));
  const fs::path xyz = export_trajectory(reader, ExportFormat::xyz, period, folder_.path()).file;
  // Along y there is no period: the cell ends at the centres.
  const std::string words = "Lattice=\"8 0 0 0 1.";
  EXPECT_NE(lines_of(xyz)[1].find(words), std::string::npos) << lines_of(xyz)[1];
  EXPECT_NE(lines_of(xyz)[1].find(" 0 0 0 0.25\" Origin=\"0.5 0 -1\" pbc=\"T F T\""), std::string::npos);
  const fs::path lammps = export_trajectory(reader, ExportFormat::lammps, period, folder_.path()).file;
  EXPECT_EQ(lines_of(lammps)[6], "ITEM: BOX BOUNDS pp ff pp");
  expect_numbers(lines_of(lammps)[7], {0.5, 8.5});
  expect_numbers(lines_of(lammps)[9], {-1, -0.75});
}

/// Bodies of every kind but polyhedra, of two materials, one of them fixed and one moving as prescribed.
constexpr const char* menagerie = R"(format: 1
time: {end: 1, step: 0.5}
materials: {stone: {density: 1000}, wood: {density: 600}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.1}, at: [1, 0, 1], velocity: [0.1, 0.2, 0.3], spin: [1, 2, 3], material: wood}
  - {box: {size: [0.5, 1, 1.5]}, at: [2, 0, 1], rotate: {axis: [1, 2, 3], degrees: 40}, material: stone}
  - {capsule: {radius: 0.2, length: 1.5}, at: [3, 0, 1], rotate: {axis: [1, 0, 0], degrees: 90}, material: wood}
  - {cylinder: {radius: 0.2, length: 1.5}, at: [4, 0, 1], rotate: {axis: [0, 1, 0], degrees: 60}, material: stone}
  - {box: {size: 1}, at: [9, 0, 1], fixed: true, material: stone}
  - {sphere: {radius: 1}, at: [12, 0, 1], motion: {velocity: [0, 0, 1]}, material: stone}
)";

TEST_F(Exports, ParticlesComeBackAsBodies) {
  write_text(folder_ / "zoo.yaml", menagerie);
  scene_ = read_scene(folder_ / "zoo.yaml");
  TrajectoryReader reader = trajectory({.spin = true, .in_double = true});
  for (const ExportFormat format : {ExportFormat::xyz, ExportFormat::lammps}) {
    const fs::path file = export_trajectory(reader, format, {}, folder_.path()).file;
    // A dump has no materials.
    const std::string material = format == ExportFormat::lammps ? ", material: stone" : "";
    const Scene again = parse_scene(
        "format: 1\ntime: {end: 1, step: 0.5}\nmaterials: {stone: {density: 1000}, wood: "
        "{density: 600}}\nbodies: [{file: " +
            file.string() + ", frame: 0" + material + "}]\n",
        folder_ / "again.yaml");
    ASSERT_EQ(again.bodies.count(), 4) << file;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(again.bodies.shape[k], scene_.bodies.shape[k + 1]);
      EXPECT_EQ(again.bodies.position[k], scene_.bodies.position[k + 1]);
      EXPECT_EQ(again.bodies.velocity[k], scene_.bodies.velocity[k + 1]);
      EXPECT_EQ(again.bodies.spin[k], scene_.bodies.spin[k + 1]);
      EXPECT_LT((again.bodies.size[k] - scene_.bodies.size[k + 1]).norm(), 1e-15);
      EXPECT_LT((again.bodies.orientation[k].coeffs() - scene_.bodies.orientation[k + 1].coeffs()).norm(),
                1e-15);
      EXPECT_EQ(again.bodies.mobility[k], Mobility::free);
      if (format == ExportFormat::xyz) {
        EXPECT_EQ(again.bodies.material[k], scene_.bodies.material[k + 1]);
      }
    }
    ASSERT_EQ(again.notes.size(), 2u);
    EXPECT_TRUE(again.notes[0].ends_with("are ignored: id")) << again.notes[0];
    EXPECT_NE(again.notes[1].find("has 2 bodies that are not free, which are left out"), std::string::npos)
        << again.notes[1];
  }
}

TEST_F(Exports, APolyhedronDoesNotComeBackWithoutItsCorners) {
  TrajectoryReader reader = trajectory({.in_double = true});
  for (const ExportFormat format : {ExportFormat::xyz, ExportFormat::lammps}) {
    const fs::path file = export_trajectory(reader, format, {}, folder_.path()).file;
    try {
      parse_scene("format: 1\ntime: {end: 1, step: 0.5}\nmaterials: {stone: {}}\nbodies: [{file: " +
                      file.string() + ", frame: 0, material: stone}]\n",
                  folder_ / "again.yaml");
      FAIL();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what())
                    .find("a polyhedron's corners are not in this file; final.csv of the run has them"),
                std::string::npos)
          << error.what();
    }
  }
}

/// A file of VTK's XML, by what it says of itself.
struct VtpFile {
  explicit VtpFile(const fs::path& file) : text(text_of(file)) {}

  std::int64_t count(const std::string& what) const {
    return std::stol(text.substr(text.find(what + "=\"") + what.size() + 2));
  }
  template <class T>
  std::vector<T> array(const std::string& name) const {
    const std::size_t at =
        text.find("<AppendedData encoding=\"raw\">\n_") + 31 +
        std::stoul(text.substr(text.find("offset=\"", text.find("Name=\"" + name + "\"")) + 8));
    std::uint64_t length = 0;
    std::memcpy(&length, text.data() + at, sizeof(length));
    std::vector<T> numbers(length / sizeof(T));
    std::memcpy(numbers.data(), text.data() + at + sizeof(length), length);
    return numbers;
  }
  Vec3 point(std::int64_t k) const {
    const std::vector<double> x = array<double>("position");
    const auto first = static_cast<std::size_t>(3 * k);
    return {x[first], x[first + 1], x[first + 2]};
  }
  /// Of cell `k`.
  std::vector<Vec3> corners(std::size_t k) const {
    const auto ends = array<std::int64_t>("offsets"), points = array<std::int64_t>("connectivity");
    std::vector<Vec3> found;
    for (auto c = static_cast<std::size_t>(k == 0 ? 0 : ends[k - 1]); c < static_cast<std::size_t>(ends[k]);
         ++c)
      found.push_back(point(points[c]));
    return found;
  }

  std::string text;
};

/// Whether two loops of places are the same, from wherever they start, in the same turn.
bool is_same_loop(std::vector<Vec3> found, const std::vector<Vec3>& expected) {
  for (std::size_t k = 0; k < found.size(); ++k) {
    std::rotate(found.begin(), found.begin() + 1, found.end());
    double worst = found.size() == expected.size() ? 0 : HUGE_VAL;
    for (std::size_t n = 0; n < found.size(); ++n) worst = std::max(worst, (found[n] - expected[n]).norm());
    if (worst < 1e-14) return true;
  }
  return false;
}

TEST_F(Exports, SurfacesAreTheMeshesAndPolyhedraInPlace) {
  TrajectoryReader reader = trajectory();
  const auto exported = export_shapes(reader, hulls(), folder_.path());
  ASSERT_EQ(exported.size(), 2u);
  EXPECT_EQ(*exported[0].file, folder_ / "surfaces.pvd");
  const VtpFile fixed(folder_ / "surfaces/fixed00000.vtp");
  ASSERT_EQ(fixed.count("NumberOfPolys"), 2);
  const Vec3 up(0, 0, 3);
  EXPECT_TRUE(is_same_loop(fixed.corners(0), {up, up + Vec3(2, 0, 0), up + Vec3(2, 1, 0)}));
  EXPECT_TRUE(is_same_loop(fixed.corners(1), {up, up + Vec3(2, 1, 0), up + Vec3(0, 1, 1)}));
  EXPECT_EQ(fixed.array<std::int32_t>("id"), (std::vector<std::int32_t>{1, 2}));

  const VtpFile moving(folder_ / "surfaces/moving00001.vtp");
  ASSERT_EQ(moving.count("NumberOfPolys"), 4 + 2);
  EXPECT_EQ(moving.array<std::int32_t>("id"), (std::vector<std::int32_t>{7, 7, 7, 7, 8, 9}));
  const Vec3 down(0, 0, -2);
  EXPECT_TRUE(is_same_loop(moving.corners(4), {down, down + Vec3(2, 0, 0), down + Vec3(2, 1, 0)}));
  // A quarter of a turn about z takes (x, y) to (-y, x). Each corner is in three of the four faces, which
  // look outward.
  std::array<int, 4> uses{};
  const Vec3 middle = Vec3(5, 1, 3) + Vec3(-0.075, 0.05, 0.025);
  for (std::size_t face = 0; face < 4; ++face) {
    const std::vector<Vec3> found = moving.corners(face);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_GT((found[1] - found[0]).cross(found[2] - found[0]).dot(found[0] - middle), 0);
    for (const Vec3& corner : found)
      for (std::size_t k = 0; k < 4; ++k)
        uses[k] +=
            (Vec3(5, 1, 3) + Vec3(-corners[k].y(), corners[k].x(), corners[k].z()) - corner).norm() < 1e-14;
  }
  EXPECT_EQ(uses, (std::array<int, 4>{3, 3, 3, 3}));
}

TEST_F(Exports, AxesAreBetweenTheEndsOfCylinders) {
  TrajectoryReader reader = trajectory();
  export_shapes(reader, hulls(), folder_.path());
  const VtpFile axes(folder_ / "axes/moving00001.vtp");
  ASSERT_EQ(axes.count("NumberOfLines"), 2);
  // +z turned about x by 90 degrees is -y; about y it is +x.
  const std::vector<Vec3> expected = {{3, 0.75, 1}, {3, -0.75, 1}, {3.25, 0, 1}, {4.75, 0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 end = axes.corners(k / 2)[k % 2];
    EXPECT_LT((end - expected[k]).norm(), 1e-14) << k;
  }
  EXPECT_EQ(axes.array<double>("radius"), (std::vector<double>{0.25, 0.25, 0.25, 0.25}));
  EXPECT_EQ(axes.array<std::uint8_t>("shape"), (std::vector<std::uint8_t>{5, 5, 6, 6}));
  EXPECT_FALSE(fs::exists(folder_ / "axes/fixed00000.vtp")) << "there are none";
}

TEST_F(Exports, WhatDoesNotMoveIsWrittenOnceAndWhoIsGoneIsNotShown) {
  TrajectoryReader reader = trajectory();
  export_shapes(reader, hulls(), folder_.path());
  EXPECT_FALSE(fs::exists(folder_ / "surfaces/fixed00001.vtp"));
  const std::string collection = text_of(folder_ / "surfaces.pvd");
  EXPECT_NE(collection.find("timestep=\"1\" part=\"0\" file=\"surfaces/fixed00000.vtp\""), std::string::npos);
  EXPECT_NE(collection.find("timestep=\"1\" part=\"1\" file=\"surfaces/moving00002.vtp\""),
            std::string::npos);
  EXPECT_EQ(VtpFile(folder_ / "surfaces/moving00002.vtp").count("NumberOfPolys"), 2) << "the mesh alone";
  EXPECT_EQ(VtpFile(folder_ / "axes/moving00002.vtp").count("NumberOfLines"), 0);
}

TEST_F(Exports, WithoutOrientationsThereAreNoShapes) {
  TrajectoryReader reader = trajectory({.orientation = false});
  const auto exported = export_shapes(reader, hulls(), folder_.path());
  ASSERT_EQ(exported.size(), 2u);
  for (const ExportedShapes& shapes : exported) EXPECT_FALSE(shapes.file) << shapes.name;
  EXPECT_FALSE(fs::exists(folder_ / "surfaces.pvd"));
}

TEST(ExportsOfBalls, HaveNoFilesOfShapes) {
  const TemporaryFolder folder;
  Scene scene = parse_scene(
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {stone: {density: 1000}}\nbodies:\n"
      "  - {sphere: {radius: 1}, material: stone}\n  - {box: {size: 1}, at: [3, 0, 0], material: stone}\n",
      folder / "balls.yaml");
  scene.record.trajectory = TrajectorySettings{};
  TrajectoryWriter writer(scene, folder / "trajectory.vtkhdf", AtomicFile::Opening::anew, 1);
  writer.append({0, 0, scene.bodies});
  writer.finish();
  TrajectoryReader reader(folder / "trajectory.vtkhdf");
  EXPECT_TRUE(export_shapes(reader, {}, folder.path()).empty());
}

}  // namespace
}  // namespace scree
