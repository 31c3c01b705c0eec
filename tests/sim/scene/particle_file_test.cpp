// Tests of XYZ files and LAMMPS dumps as sources of bodies, as the programs that make them write them. The
// files that `scree export` writes are read back in tests/sim/record/exports_test.cpp.
#include "core/error.hpp"
#include "sim/scene/scene.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scree {
namespace {

using namespace std::string_literals;

class ParticleFileTest : public testing::Test {
 protected:
  Scene scene_with(const std::string& text, const std::string& more = "") {
    write_text(folder_ / "bed", text);
    return parse_scene(
        "format: 1\nname: a\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {density: 2500}}\nbodies:\n"
        "  - {file: bed, material: glass" +
            more + "}\n",
        folder_ / "scene.yaml");
  }
  std::string message_of(const std::string& text, const std::string& more = "") {
    try {
      scene_with(text, more);
    } catch (const InputError& error) {
      const std::string what = error.what(), start = (folder_ / "").string();
      return what.starts_with(start) ? what.substr(start.size()) : what;
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

const std::string plain_xyz = "2\na comment\nAr 1 2 3\nKr 4 5 6.5\n";
const std::string balls = ", sphere: {radius: 0.25}";

TEST_F(ParticleFileTest, PlainXyzHasPlaces) {
  for (const std::string& text :
       {plain_xyz, plain_xyz + "\n\n", "  2  \r\n\r\nAr 1 2 3\r\nKr\t4  5 6.5\r\n"s}) {
    const Scene scene = scene_with(text, balls);
    ASSERT_EQ(scene.bodies.count(), 2);
    EXPECT_EQ(scene.bodies.position[1], Vec3(4, 5, 6.5));
    EXPECT_EQ(scene.bodies.size[1], Vec3(0.25, 0, 0));
    EXPECT_EQ(scene.notes.size(), 1u) << "of the elements";
  }
  EXPECT_EQ(message_of(plain_xyz),
            "bed:2:1: shape: the column is missing; say what the bodies are beside `file`, as in `sphere: "
            "{radius: 0.1}`");
}

TEST_F(ParticleFileTest, ExtendedXyzNamesItsColumns) {
  const std::string head =
      "1\nLattice=\"1 0 0 0 1 0 0 0 1\" "
      "Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:orientation:R:4:id:I:1 "
      "Time=3\n";
  const Scene scene = scene_with(head + "Si 1 2 3 4 5 6 0.5 0 0 2 0 77\n");
  EXPECT_EQ(scene.bodies.shape[0], Shape::sphere);
  EXPECT_EQ(scene.bodies.size[0], Vec3(0.5, 0, 0));
  EXPECT_EQ(scene.bodies.position[0], Vec3(1, 2, 3));
  EXPECT_EQ(scene.bodies.velocity[0], Vec3(4, 5, 6));
  EXPECT_EQ(scene.bodies.orientation[0].coeffs(), Quat(0, 0, 0, 1).coeffs()) << "x, y, z, w";
  EXPECT_EQ(scene_with("1\nproperties=pos:R:3:diameter:R:1:mass:R:1\n0 0 0 0.5 3\n").bodies.size[0].x(),
            0.25);
}

std::string frames(int count) {
  std::string text;
  for (int f = 0; f < count; ++f)
    text += "1\nProperties=\"pos:R:3:radius:R:1\"\n" + std::to_string(f) + " 0 0 1\n";
  return text;
}

TEST_F(ParticleFileTest, TheLastFrameOrTheOneThatTheSceneNames) {
  EXPECT_EQ(scene_with(frames(3)).bodies.position[0].x(), 2);
  for (int f = 0; f < 3; ++f)
    EXPECT_EQ(scene_with(frames(3), ", frame: " + std::to_string(f)).bodies.position[0].x(), f);
  EXPECT_EQ(message_of(frames(3), ", frame: 3"), "bed:1:1: there is no frame 3: the file has 3, from 0 on");
}

const std::string dump_head =
    "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 10\n-5 5\n0 1e1\n";

TEST_F(ParticleFileTest, ADumpNamesItsColumns) {
  const Scene scene = scene_with(dump_head +
                                 "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz diameter mass\n"
                                 "1 1 1 2 3 4 5 6 7 8 9 0.5 3\n2 1 4 5 6 0 0 0 0 0 0 1 2\n");
  EXPECT_EQ(scene.bodies.size[0], Vec3(0.25, 0, 0));
  EXPECT_EQ(scene.bodies.position[0], Vec3(1, 2, 3));
  EXPECT_EQ(scene.bodies.velocity[0], Vec3(4, 5, 6));
  EXPECT_EQ(scene.bodies.spin[0], Vec3(7, 8, 9));
  EXPECT_NEAR(1 / scene.bodies.inverse_mass[0], 3, 1e-15);
  EXPECT_EQ(
      scene_with(dump_head + "ITEM: ATOMS id xu yu zu radius\n1 1 2 3 1\n2 4 5 6 1\n").bodies.position[1],
      Vec3(4, 5, 6));
}

TEST_F(ParticleFileTest, ADumpOfTheStyleAtomHasSharesOfTheCell) {
  const Scene scene =
      scene_with(dump_head + "ITEM: ATOMS id type xs ys zs\n1 1 0 0 0\n2 1 0.5 0.25 1\n", balls);
  EXPECT_EQ(scene.bodies.position[0], Vec3(0, -5, 0));
  EXPECT_EQ(scene.bodies.position[1], Vec3(5, -2.5, 10));
  const std::string oblique =
      "ITEM: TIMESTEP\n1\nITEM: UNITS\nlj\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 "
      "0\n0 1 0\n0 1 "
      "0.5\nITEM: ATOMS id ";
  EXPECT_EQ(message_of(oblique + "xs ys zs\n1 0 0 0\n", balls),
            "bed:11:16: xs: shares of an oblique cell are not read; dump x y z, or xu yu zu");
  const Scene units = scene_with(oblique + "x y z\n1 0.5 0 0\n", balls);
  EXPECT_EQ(units.bodies.position[0].x(), 0.5);
  EXPECT_NE(units.notes[1].find("says that its units are lj; its numbers are taken as SI"),
            std::string::npos);
}

TEST_F(ParticleFileTest, FaultsAreToldAtTheirPlace) {
  const std::pair<std::string, const char*> faults[] = {
      {"3\n", "bed:1:1: the file ends after 0 of 3 particles"},
      {"3\na\nAr 0 0 0\nAr 1 1 1\n", "bed:4:1: the file ends after 2 of 3 particles"},
      {"1\na\nAr 0 0 0\nmore\n", "bed:4:1: must be the number of particles, a whole number"},
      {"-1\n", "bed:1:1: must be the number of particles, a whole number"},
      {"99999999999999999999\na\n", "bed:1:1: must be the number of particles, a whole number"},
      {"0\na\n", "bed:2:1: there are no bodies"},
      {"1\na\nAr 0 0\n", "bed:3:1: has 3 words; there are 4 columns"},
      {"1\na\nAr 0 0 zero\n", "bed:3:8: z: must be a number (m), not zero"},
      {"2\na\nAr 0 0 0 1\nAr 0 0 0\n", "bed:4:1: has 4 words; there are 5 columns"},
      {"1\nProperties=pos:R\n0\n", "bed:2:12: Properties must be name:type:count, again and again"},
      {"1\nProperties=pos:R:x\n0\n", "bed:2:12: Properties must be name:type:count, again and again"},
      {"1\nProperties=pos:R:9999999\n0\n", "bed:2:12: Properties must be name:type:count, again and again"},
      {"1\nProperties=pos:R:2\n0 0\n", "bed:2:1: x: the column is missing; x, y and z are needed"},
      {"1\nProperties=pos:R:3:pos:R:3\n0 0 0 0 0 0\n", "bed:2:12: x: the column is there twice"},
      {"ITEM: TIMESTEP\n1\n", "bed:2:1: the file ends within a frame"},
      {"ITEM: TIMESTEP\n1\nITEM: ATOMS x y z\n", "bed:3:1: ITEM: NUMBER OF ATOMS must come before the atoms"},
      {"ITEM: TIME\n1\n", "bed:1:1: must be ITEM: TIMESTEP"},
      {"ITEM: TIMESTEP\n1\nITEM: ENTRIES\n", "bed:3:1: is no item of a dump that scree knows"},
      {"ITEM: TIMESTEP\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0\n", "bed:5:1: must be the bounds of the box"},
      {dump_head + "ITEM: ATOMS\n1\n2\n", "bed:9:1: x: the column is missing"},
      {dump_head + "ITEM: ATOMS x y\n1 2\n2 2\n", "bed:9:1: z: the column is missing"},
      {dump_head + "ITEM: ATOMS x y z shapex\n1 2 3 4\n1 2 3 4\n",
       "bed:9:19: shapex: ellipsoids are not modelled"},
      {dump_head + "ITEM: ATOMS x y z\n1 2 3\n", "bed:10:1: the file ends after 1 of 2 particles"},
  };
  for (const auto& [text, expected] : faults) {
    const std::string message = message_of(text, balls);
    EXPECT_TRUE(message.starts_with(expected)) << expected << "\n" << message;
  }
  EXPECT_TRUE(message_of(plain_xyz, balls + ", frame: -1").find("must be a whole number >= 0") !=
              std::string::npos);
}

}  // namespace
}  // namespace scree
