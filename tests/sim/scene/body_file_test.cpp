// Tests of body files: the meaning of each column, and every way in which a file can be wrong.
#include "sim/scene/body_file.hpp"

#include "core/error.hpp"
#include "sim/scene/scene.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <ctime>

namespace scree {
namespace {

class BodyFileTest : public testing::Test {
 protected:
  Scene scene_with(const std::string& csv, const std::string& more = "material: glass") {
    write_text(folder_ / "bed.csv", csv);
    return parse_scene(
        "format: 1\nname: a\ntime: {end: 1, step: 0.1}\n"
        "materials: {glass: {density: 2500}, steel: {density: 8000}}\nbodies:\n"
        "  - {sphere: {radius: 1}, at: [9, 9, 9], material: steel}\n  - {file: bed.csv, " +
            more + "}\n",
        folder_ / "scene.yaml");
  }

  /// Returns the message of the error in the file, without the path of the folder.
  std::string message_of(const std::string& csv, const std::string& more = "material: glass") {
    try {
      scene_with(csv, more);
    } catch (const InputError& error) {
      const std::string text = error.what();
      const std::string start = (folder_ / "").string();
      return text.rfind(start, 0) == 0 ? text.substr(start.size()) : text;
    }
    return "no error";
  }

  TemporaryFolder folder_;
};

TEST_F(BodyFileTest, EachColumnIsRead) {
  const Scene scene = scene_with(
      "z,y,x,shape,radius,size_x,size_y,size_z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,mass,material\n"
      "3,2,1,sphere,0.5,,,,,,,,4,5,6,7,8,9,,glass\n"
      " 30 , 20,10\t,box,,1,2,3,0,0,0,-2,,,,,,,12,steel\n",
      "name: b");
  const BodyTable& bodies = scene.bodies;
  ASSERT_EQ(bodies.count(), 3);
  EXPECT_EQ(scene.body_names.at("b[1]"), 2);
  EXPECT_EQ(bodies.id[2], BodyNumber{2});
  EXPECT_EQ(bodies.shape[1], Shape::sphere);
  EXPECT_EQ(bodies.size[1].x(), 0.5);
  EXPECT_EQ(bodies.position[1], Vec3(1, 2, 3));
  EXPECT_EQ(bodies.velocity[1], Vec3(4, 5, 6));
  EXPECT_EQ(bodies.spin[1], Vec3(7, 8, 9));
  EXPECT_EQ(bodies.orientation[1].coeffs(), Quat::Identity().coeffs());
  EXPECT_EQ(bodies.shape[2], Shape::box);
  EXPECT_EQ(bodies.size[2], Vec3(0.5, 1, 1.5));
  EXPECT_EQ(bodies.position[2], Vec3(10, 20, 30));
  EXPECT_EQ(bodies.orientation[2].coeffs(), Quat(0, 0, 0, -1).coeffs());
  EXPECT_EQ(bodies.velocity[2], Vec3(0, 0, 0));
  EXPECT_EQ(bodies.material[2], 1);
  EXPECT_NEAR(1 / bodies.inverse_mass[2], 12, 1e-14);
}

TEST_F(BodyFileTest, EveryBodyNeedsAMaterialOfTheScene) {
  EXPECT_EQ(message_of("shape,radius,x,y,z,material\nsphere,1,0,0,0,\n", "name: b"),
            "bed.csv:2:16: material: the body needs one: fill the column, or give `material` beside `file` "
            "in the scene");
  EXPECT_EQ(message_of("shape,radius,x,y,z,material\nsphere,1,0,0,0,gloss\n", "name: b"),
            "bed.csv:2:16: material: there is no material gloss (did you mean glass?)");
}

TEST_F(BodyFileTest, FormsOfTextThatPeopleHave) {
  EXPECT_EQ(scene_with("\xEF\xBB\xBFshape,radius,x,y,z\r\nsphere,1,0,0,0\r\n").bodies.count(), 2);
  EXPECT_EQ(scene_with("shape,radius,x,y,z\nsphere,1,0,0,+.5").bodies.position[1].z(), 0.5);
  EXPECT_EQ(scene_with("\nshape,radius,x,y,z\n\n  \nsphere,1,0,0,1e-3\n\n").bodies.position[1].z(), 1e-3);
}

/// A table of three balls, as rows of cells.
using Table = std::vector<std::vector<std::string>>;
const Table three_balls = {{"shape", "radius", "x", "y", "z"},
                           {"sphere", "0.1", "0", "0", "0.5"},
                           {"sphere", "0.2", "1", "0", "0.5"},
                           {"sphere", "0.15", "0", "1", "0.75"}};

std::string joined(const Table& table, const std::string& between, const std::string& end,
                   const std::string& quote = "", const std::string& tail = "") {
  std::string text;
  for (const auto& row : table) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? between : "") + quote + row[k] + quote;
    text += tail + end;
  }
  return text;
}

TEST_F(BodyFileTest, ATableIsTheSameHoweverItIsWritten) {
  const Scene plain = scene_with(joined(three_balls, ",", "\n"));
  ASSERT_EQ(plain.bodies.count(), 4);
  EXPECT_TRUE(plain.notes.empty());
  const auto expect_same = [&](const std::string& csv) {
    const Scene scene = scene_with(csv);
    EXPECT_EQ(hash_of(scene.bodies), hash_of(plain.bodies)) << csv;
    EXPECT_TRUE(scene.notes.empty()) << csv;
  };
  for (const char* between : {",", ";", "\t", "|", ", ", " ; ", " "})
    for (const char* end : {"\n", "\r\n", "\r", "\n\n", "\n# a comment, with commas; and more\n", "\n  #\n"})
      for (const char* quote : {"", "\""}) {
        if (between == std::string(" ") && *quote != '\0') continue;
        expect_same(joined(three_balls, between, end, quote));
        expect_same("\xEF\xBB\xBF" + joined(three_balls, between, end, quote));
        expect_same("# from my generator" + std::string(end) + joined(three_balls, between, end, quote));
        if (between == std::string(" ")) continue;
        expect_same(joined(three_balls, between, end, quote, between));
        expect_same(joined(three_balls, between, end, quote, between + std::string(between)));
        expect_same("sep=" + std::string(1, between[0] == ' ' ? between[1] : between[0]) + end +
                    joined(three_balls, between, end, quote));
        expect_same(joined(three_balls, between, end, quote) + between + end);
      }
  Table titled = three_balls;
  titled[0] = {"Shape", "RADIUS", "X", "Y", "Z"};
  expect_same(joined(titled, ",", "\n"));
  expect_same("shape,radius,x,y,z\nsphere,0.1,0,0,0.5,\nsphere,0.2,1,0,0.5,,,\nsphere,0.15,0,1,0.75\n");
  expect_same("shape,radius,x,y,z,\nsphere,0.1,0,0,0.5\nsphere,0.2,1,0,0.5,\nsphere,0.15,0,1,0.75,,\n");
}

TEST_F(BodyFileTest, ColumnsThatSayNothingOfABodyAreIgnoredAndSaid) {
  const std::string bed = (folder_ / "bed.csv").string();
  const auto notes_of = [&](const std::string& csv) { return scene_with(csv).notes; };
  using Notes = std::vector<std::string>;
  const std::string ignored = bed + " has columns that say nothing of a body and are ignored: ";
  EXPECT_EQ(notes_of("id,shape,radius,x,y,z\n0,sphere,1,0,0,0\n1,sphere,1,3,0,0\n"), Notes{ignored + "id"});
  EXPECT_EQ(notes_of("shape,radius,x,y,z,id,fx,Colour\nsphere,1,0,0,0,7,1,red\n"),
            Notes{ignored + "id, fx, Colour"});
  EXPECT_EQ(notes_of(",shape,radius,x,y,z\n0,sphere,1,0,0,0\n"), Notes{ignored + "one without a name"});
  EXPECT_EQ(notes_of("shape,radius,x,y,z,id\nsphere,1,0,0,0,\n"), Notes{}) << "nothing is lost";
  EXPECT_EQ(
      notes_of("shape,radius,x,y,z,i0,i1,i2,i3,i4,i5,i6,i7,i8,i9\nsphere,1,0,0,0,1,1,1,1,1,1,1,1,1,1\n"),
      Notes{ignored + "i0, i1, i2, i3, i4, i5, i6, i7 and 2 more"});
  for (const char* slip :
       {"raduis", "radus", "radiuss", "rafius", "Sahpe", "shap", "mas", "masss", "materiel"})
    EXPECT_NE(
        message_of("shape,radius,x,y,z," + std::string(slip) + "\nsphere,1,0,0,0,1\n").find("did you mean"),
        std::string::npos)
        << slip;
}

TEST_F(BodyFileTest, WithoutAColumnOfShapesTheSizesOrTheSceneSayIt) {
  const std::string bed = (folder_ / "bed.csv").string();
  const Scene balls = scene_with("x,y,z,radius\n0,0,0.5,0.1\n1,0,0.5,0.2\n0,1,0.75,0.15\n");
  EXPECT_EQ(hash_of(balls.bodies), hash_of(scene_with(joined(three_balls, ",", "\n")).bodies));
  EXPECT_EQ(scene_with("x,y,z,radius\n0,0,0,1\n").notes,
            (std::vector<std::string>{bed + " does not name the shape; by its sizes each body is a sphere"}));
  EXPECT_EQ(scene_with("x,y,z,size_x,size_y,size_z\n0,0,0,1,2,3\n").bodies.size[1], Vec3(0.5, 1, 1.5));
  const std::string round = "x,y,z,radius,size_z\n0,0,0,1,4\n";
  const auto shape_beside = [&](const char* more) {
    return scene_with(round, std::string("material: glass, ") + more);
  };
  EXPECT_EQ(shape_beside("shape: capsule").bodies.shape[1], Shape::capsule);
  EXPECT_EQ(shape_beside("shape: \"cylinder\"").bodies.size[1], Vec3(1, 1, 2));
  EXPECT_TRUE(shape_beside("shape: cylinder").notes.empty());
}

TEST_F(BodyFileTest, AShapeBesideAFileIsThatOfAllItsBodies) {
  const std::string places = "x,y,z,vx\n0,0,0,1\n5,0,0,2\n10,0,0,3\n";
  const auto scene = [&](const std::string& shape) {
    return scene_with(places, "material: glass, " + shape);
  };
  const Scene balls = scene("sphere: {radius: 0.1}");
  EXPECT_EQ(balls.bodies.size[3], Vec3(0.1, 0, 0));
  EXPECT_EQ(balls.bodies.velocity[3], Vec3(3, 0, 0));
  EXPECT_NEAR(1 / balls.bodies.inverse_mass[3], 2500 * 4 * pi / 3 * 1e-3, 1e-12);
  const Scene mixed = scene("sphere: {radius: {uniform: [0.1, 0.2]}}");
  EXPECT_NE(mixed.bodies.size[2], mixed.bodies.size[3]) << "each is drawn by itself";
  EXPECT_GT(mixed.bodies.size[2].x(), 0.1);
  EXPECT_EQ(scene("box: {size: [1, 2, 3]}").bodies.size[2], Vec3(0.5, 1, 1.5));
  EXPECT_EQ(scene("capsule: {radius: 1, length: 2}").bodies.size[2], Vec3(1, 1, 2));
  EXPECT_EQ(scene("cylinder: {radius: 1, length: 2}").bodies.size[2], Vec3(1, 1, 1));
  const Scene gems = scene("polyhedron: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}");
  EXPECT_LT((gems.bodies.position[2] - Vec3(5.25, 0.25, 0.25)).norm(), 1e-15) << "its centre of mass";
  EXPECT_EQ(gems.geometry->of_body[3].hull, &gems.geometry->hulls[0]);
  for (const Scene* again : {&mixed, &gems}) {
    const Scene resolved = parse_scene(again->resolved, "elsewhere.yaml");
    EXPECT_EQ(hash_of(resolved.bodies), hash_of(again->bodies));
    EXPECT_EQ(resolved.resolved, again->resolved);
  }
  EXPECT_EQ(message_of("shape,radius,x,y,z\nsphere,1,0,0,0\n", "material: glass, shape: sphere"),
            "bed.csv:1:1: shape: the scene says the shape beside `file` already; leave out one of the two");
  EXPECT_EQ(
      message_of("x,y,z,radius\n0,0,0,1\n", "material: glass, sphere: {radius: 1}"),
      "bed.csv:1:7: radius: the scene says the size beside `file` already; write `shape: sphere` there");
  EXPECT_EQ(message_of(places, "material: glass, frame: 0"),
            "bed.csv:1:1: a table has no frames; leave `frame` out in the scene");
}

TEST_F(BodyFileTest, AMaterialMayBeItsPlaceAmongThem) {
  EXPECT_EQ(scene_with("shape,radius,x,y,z,material\nsphere,1,0,0,0,1\n", "name: b").bodies.material[1], 1);
  EXPECT_EQ(message_of("shape,radius,x,y,z,material\nsphere,1,0,0,0,2\n", "name: b"),
            "bed.csv:2:16: material: there is no material 2");
}

TEST_F(BodyFileTest, AFixedFileStandsStill) {
  const Scene scene = scene_with("shape,radius,x,y,z,vx\nsphere,1,0,0,0,5\n", "material: glass, fixed: true");
  EXPECT_EQ(scene.bodies.mobility[1], Mobility::fixed);
  EXPECT_EQ(scene.bodies.velocity[1], Vec3(0, 0, 0));
  EXPECT_EQ(scene.bodies.inverse_mass[1], 0);
}

TEST_F(BodyFileTest, EveryFaultIsToldAtItsPlace) {
  const std::string head = "shape,radius,size_x,size_y,size_z,x,y,z,qw,qx,qy,qz,mass\n";
  const std::pair<std::string, const char*> faults[] = {
      {"", "bed.csv:1:1: the file is empty; its first line names the columns, of shape,radius,"},
      {"\n\n", "bed.csv:1:1: the file is empty"},
      {head, "bed.csv:1:1: there are no bodies, only the names of the columns"},
      {"shape,raduis,x,y,z\n", "bed.csv:1:7: unknown column raduis (did you mean radius?)"},
      {"shape;x;y;z\n", "bed.csv:1:1: there are no bodies, only the names of the columns"},
      {"shape,diameter,x,y,z\n", "bed.csv:1:7: unknown column diameter; write a column `radius`, half of it"},
      {"shape,x,y,z,Density\n", "bed.csv:1:13: unknown column Density; write `mass`, or give"},
      {"1,2,3\n4,5,6\n", "bed.csv:1:1: the first line must name the columns, of shape,radius,"},
      {"\"1\";\"2\"\n", "bed.csv:1:1: the first line must name the columns, of shape,radius,"},
      {"shape,x,y,z,x\n", "bed.csv:1:13: x: the column is there twice"},
      {"shape,x,z\n", "bed.csv:1:1: y: the column is missing; x, y and z are needed"},
      {"x,y,z\n1,2,3\n",
       "bed.csv:1:1: shape: the column is missing; say what the bodies are beside `file`, as in `sphere: "
       "{radius: "
       "0.1}`"},
      {"x,y,z,radius,size_z\n1,2,3,1,4\n",
       "bed.csv:1:1: shape: the column is missing; write `shape: capsule` or `shape: cylinder` beside "
       "`file`"},
      {"shape,x,y,z\nsphere,1,2\n", "bed.csv:2:1: has 3 cells; the header names 4 columns"},
      {"shape,x,y,z\nsphere,1,2,3,4\n", "bed.csv:2:1: has 5 cells; the header names 4 columns"},
      {head + "shpere,1,,,,0,0,0,,,,,\n",
       "bed.csv:2:1: shape: must be one of sphere, box, capsule, cylinder, polyhedron, not shpere (did you "
       "mean "
       "sphere?)"},
      {head + ",1,,,,0,0,0,,,,,\n",
       "bed.csv:2:1: shape: must be one of sphere, box, capsule, cylinder, polyhedron, not nothing"},
      {head + "sphere,-1,,,,0,0,0,,,,,\n", "bed.csv:2:8: radius: must be a number > 0 (m), not -1"},
      {head + "sphere,0,,,,0,0,0,,,,,\n", "bed.csv:2:8: radius: must be a number > 0 (m), not 0"},
      {head + "sphere,,,,,0,0,0,,,,,\n", "bed.csv:2:8: radius: a sphere needs it, a number > 0 (m)"},
      {head + "sphere,1,2,,,0,0,0,,,,,\n", "bed.csv:2:10: size_x: does not go with a sphere; leave it empty"},
      {head + "box,,1,1,,0,0,0,,,,,\n", "bed.csv:2:10: size_z: a box needs it"},
      {head + "box,1,1,1,1,0,0,0,,,,,\n", "bed.csv:2:5: radius: does not go with a box"},
      {head + "box,,1,-1,1,0,0,0,,,,,\n", "bed.csv:2:8: size_y: must be a number > 0 (m), not -1"},
      {head + "sphere,1,,,,nan,0,0,,,,,\n", "bed.csv:2:13: x: must be a number (m), not nan"},
      {head + "sphere,1,,,,0,inf,0,,,,,\n", "bed.csv:2:15: y: must be a number (m), not inf"},
      {head + "sphere,1,,,,0,0,1e999,,,,,\n", "bed.csv:2:17: z: 1e999 is out of range"},
      {head + "sphere,1,,,,0,,0,,,,,\n", "bed.csv:2:15: y: must be a number (m), not nothing"},
      {head + "sphere,1,,,,0,0,zero,,,,,\n", "bed.csv:2:17: z: must be a number (m), not zero"},
      {head + "sphere,1,,,,0,0,1 2,,,,,\n", "bed.csv:2:17: z: must be a number (m), not 1 2"},
      {head + "sphere,1,,,,0,0,0,0,0,0,0,\n", "bed.csv:2:19: qw: the quaternion must not be zero"},
      {head + "sphere,1,,,,0,0,0,1,0,,0,\n",
       "bed.csv:2:23: qy: must be a number, as the others of qw, qx, qy, qz"},
      {head + "sphere,1,,,,0,0,0,,,,,0\n", "bed.csv:2:23: mass: must be a number > 0 (kg), not 0"},
      {head + "sphere,1e-200,,,,0,0,0,,,,,\n",
       "bed.csv:2:1: mass: its mass and inertia are beyond what numbers can hold"},
      {head + "sphere,1,,,,0,0,0,,,,,\n\nsphere,1,,,,0,x,0,,,,,\n",
       "bed.csv:4:15: y: must be a number (m), not x"},
      {std::string("shape\0", 6), "bed.csv:1:6: byte 0x00 is no text of a body file"},
      {"shape,x,y,z\n\"sphere,1,2,3\n", "bed.csv:2:1: the quotes are not closed on their line"},
      {"shape,x,y,z\n\"sphere\"s,1,2,3\n", "bed.csv:2:9: there is text behind the quotes that close a cell"},
      {"shape;radius;x;y;z\nsphere;0,1;0;0;0\n",
       "bed.csv:2:8: radius: must be a number with a decimal point, not 0,1"},
      {std::string("\xFF\xFEs\0", 4),
       "bed.csv:1:1: is UTF-16 text; save it as UTF-8 (in a spreadsheet: CSV UTF-8)"},
      {std::string("\xFE\xFF\0s", 4), "bed.csv:1:1: is UTF-16 text"},
      {std::string("s\0h\0", 4), "bed.csv:1:1: is UTF-16 text"},
      {std::string("\0s\0h", 4), "bed.csv:1:1: is UTF-16 text"},
      {"# x,y,z,radius\n1,2,3,4\n",
       "bed.csv:2:1: the first line must name the columns, of "
       "shape,radius,size_x,size_y,size_z,x,y,z,qw,qx,qy,qz,"
       "vx,vy,vz,wx,wy,wz,mass,material,hull,servo_x,servo_y,servo_z,servo_force; this one has no names (if "
       "line 1 "
       "has them, take its # away)"},
      {std::string(5000, 'x'), "bed.csv:1:1: is longer than 4095 bytes"},
      {std::string(5000, ' '), "bed.csv:1:1: is longer than 4095 bytes"},
  };
  for (const auto& [csv, expected] : faults) {
    const std::string message = message_of(csv);
    EXPECT_EQ(message.rfind(expected, 0), 0u) << expected << "\n" << message;
  }
}

TEST_F(BodyFileTest, APolyhedronIsTheHullOfAFile) {
  // The hull is the tetrahedron from the origin to the three unit points.
  write_text(folder_ / "gem.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.2 0.2 0.2\n");
  const std::string rows =
      "shape,radius,x,y,z,qw,qx,qy,qz,hull\npolyhedron,,1,2,3,1,0,0,0,gem.obj\nsphere,1,9,0,0,,,,,\n"
      "polyhedron,,5,0,0,0,0,0,1," +
      (folder_ / "gem.obj").string() + "\n";
  const Scene scene = scene_with(rows);
  ASSERT_EQ(scene.bodies.count(), 4);
  EXPECT_EQ(scene.bodies.shape[1], Shape::polyhedron);
  EXPECT_LT((scene.bodies.position[1] - Vec3(1.25, 2.25, 3.25)).norm(), 1e-15) << "its centre of mass";
  EXPECT_LT((scene.bodies.position[3] - Vec3(4.75, -0.25, 0.25)).norm(), 1e-15)
      << "turned about z by half a turn";
  EXPECT_NEAR(1 / scene.bodies.inverse_mass[1], 2500.0 / 6, 1e-10);
  ASSERT_TRUE(scene.geometry);
  EXPECT_EQ(scene.geometry->hulls.size(), 1u) << "one for both";
  EXPECT_EQ(scene.geometry->of_body[1].hull, &scene.geometry->hulls[0]);
  EXPECT_EQ(scene.geometry->of_body[2].hull, nullptr);
  EXPECT_EQ(scene.geometry->of_body[3].hull, &scene.geometry->hulls[0]);
  EXPECT_EQ(scene.geometry->hulls[0].vertices.size(), 4u);
  // A scene that describes the polyhedron itself makes the same body.
  const Scene other = parse_scene(
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {density: 2500}}\nbodies:\n  - {polyhedron: "
      "{file: gem.obj}, at: [1, 2, 3], material: glass}\n",
      folder_ / "other.yaml");
  EXPECT_EQ(scene.bodies.position[1], other.bodies.position[0]);
  EXPECT_EQ(scene.bodies.orientation[1].coeffs(), other.bodies.orientation[0].coeffs());
  EXPECT_EQ(scene.bodies.size[1], other.bodies.size[0]);
  EXPECT_EQ(scene.bodies.inverse_inertia[1], other.bodies.inverse_inertia[0]);
}

TEST_F(BodyFileTest, AServoIsABoxWithAnAxisAndAForce) {
  const std::string rows =
      "shape,size_x,size_y,size_z,x,y,z,vx,vz,servo_x,servo_y,servo_z,servo_force\nbox,1,1,1,0,0,0,3,,2,0,0,-"
      "7\n"
      "box,1,1,1,3,0,0,1,1,,,,\n";
  const Scene scene = scene_with(rows);
  ASSERT_EQ(scene.servos.size(), 1u);
  EXPECT_EQ(scene.servos[0].body, 1);
  EXPECT_EQ(scene.servos[0].axis, Vec3(1, 0, 0));
  EXPECT_EQ(scene.servos[0].force, -7);
  EXPECT_EQ(scene.bodies.inverse_inertia[1], Vec3(0, 0, 0)) << "it does not turn";
  EXPECT_NE(scene.bodies.inverse_inertia[2], Vec3(0, 0, 0));
  EXPECT_TRUE(scene_with(rows, "material: glass, fixed: true").servos.empty());
}

TEST_F(BodyFileTest, FaultsOfPolyhedraAndServosAreToldAtTheirPlace) {
  write_text(folder_ / "flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n");
  const std::string hulls = "shape,radius,x,y,z,hull\n";
  const std::string servos =
      "shape,radius,size_x,size_y,size_z,x,y,z,vx,wx,servo_x,servo_y,servo_z,servo_force\n";
  const std::pair<std::string, std::string> faults[] = {
      {hulls + "polyhedron,,0,0,0,\n",
       "bed.csv:2:19: hull: a polyhedron needs it, an OBJ, STL or PLY file whose vertices' hull it is"},
      {"shape,x,y,z\npolyhedron,0,0,0\n", "bed.csv:2:1: hull: a polyhedron needs it"},
      {hulls + "polyhedron,1,0,0,0,a.obj\n", "bed.csv:2:12: radius: does not go with a polyhedron"},
      {hulls + "sphere,1,0,0,0,a.obj\n", "bed.csv:2:16: hull: does not go with a sphere; leave it empty"},
      {hulls + "polyhedron,,0,0,0,a.obj\n",
       "bed.csv:2:19: hull: " + (folder_ / "a.obj").string() + ": cannot be read: No such file"},
      {hulls + "polyhedron,,0,0,0,flat.obj\n", "bed.csv:2:19: hull: the points lie in a plane"},
      {hulls + "polyhedron,,0,0,0,/dev/zero\n", "bed.csv:2:19: hull: /dev/zero: is no regular file"},
      {servos + "sphere,1,,,,0,0,0,,,1,0,0,5\n", "bed.csv:2:21: servo_x: goes with a box alone"},
      {servos + "box,,1,1,1,0,0,0,,,1,0,,5\n",
       "bed.csv:2:24: servo_z: must be a number, as the others of servo_x, servo_y, servo_z, servo_force"},
      {servos + "box,,1,1,1,0,0,0,,,0,0,0,5\n", "bed.csv:2:20: servo_x: the axis must not be zero"},
      {servos + "box,,1,1,1,0,0,0,2,,0,0,1,5\n", "bed.csv:2:18: vx: must be along the axis of the servo"},
      {servos + "box,,1,1,1,0,0,0,,2,0,0,1,5\n", "bed.csv:2:19: wx: must be zero: a servo does not turn"},
  };
  for (const auto& [csv, expected] : faults) {
    const std::string message = message_of(csv);
    EXPECT_EQ(message.rfind(expected, 0), 0u) << expected << "\n" << message;
  }
  write_text(folder_ / "bed.csv", servos + "box,,1,1,1,0,0,0,,,0,0,1,5\n");
  try {
    parse_scene(
        "format: 1\ntime: {end: 1, step: 0.1}\nprecision: mixed\nmaterials: {glass: {density: "
        "2500}}\nbodies: "
        "[{file: bed.csv, material: glass}]\n",
        folder_ / "scene.yaml");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bed.csv:2:20: servo_x: the scene's precision cannot be mixed"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(BodyFileTest, ARunsFolderStandsForItsFinalState) {
  std::filesystem::create_directory(folder_ / "run");
  write_text(folder_ / "run/final.csv", "shape,radius,x,y,z\nsphere,1,0,0,0\n");
  EXPECT_EQ(find_body_file(folder_ / "run"), folder_ / "run/final.csv");
  EXPECT_EQ(find_body_file(folder_ / "run/final.csv"), folder_ / "run/final.csv");
  EXPECT_THROW(find_body_file(folder_ / "walk"), InputError);
  EXPECT_THROW(find_body_file("/dev/zero"), InputError);
}

TEST_F(BodyFileTest, TheResolvedSceneRunsFromAnywhere) {
  const Scene scene = scene_with("shape,radius,x,y,z\nsphere,1,0,0,7\n");
  const Scene again = parse_scene(scene.resolved, "elsewhere.yaml");
  EXPECT_EQ(again.bodies.position, scene.bodies.position);
  EXPECT_EQ(again.resolved, scene.resolved);
}

// They take a quarter of a second. The limit holds with sanitizers on a slow machine too.
TEST_F(BodyFileTest, AHundredThousandRowsLoadInTenSeconds) {
  std::string csv = "shape,radius,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";
  for (int k = 0; k < 100000; ++k)
    csv +=
        "sphere,0.05," + std::to_string(k) + ".123456789012345,0.1,0.2,0.5,0.5,0.5,0.5,1,2,3,0.1,0.2,0.3\n";
  const std::clock_t start = std::clock();
  EXPECT_EQ(scene_with(csv).bodies.count(), 100001);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10);
}

}  // namespace
}  // namespace scree
