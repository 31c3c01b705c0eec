// Tests of meshes from files: the same mesh in each format, and what is left out.
#include "sim/scene/mesh_file.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace scree {
namespace {

namespace fs = std::filesystem;

class MeshFiles : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  MeshFile read(const char* name, const std::string& text, const Vec3& scale = Vec3::Ones()) const {
    return read_mesh_file(write(name, text), scale);
  }
  SceneMesh read_scene(const char* name, const std::string& text) const {
    return scene_mesh(read(name, text), name, {});
  }
  /// Returns what the message says is wrong with the file.
  std::string told(const char* name, const std::string& text) const {
    try {
      read_scene(name, text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  /// Returns the warning about what is skipped in the file; there must not be more than one.
  std::string warned(const char* name, const std::string& text) const {
    const SceneMesh mesh = read_scene(name, text);
    EXPECT_LE(mesh.warnings.size(), 1u);
    return mesh.warnings.empty() ? "" : mesh.warnings.front();
  }

  fs::path folder_ = fs::temp_directory_path() / ("scree_mesh_file_test_" + std::to_string(::getpid()));
};

constexpr std::array<std::array<std::array<float, 3>, 3>, 2> facets = {
    {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}}}, {{{0, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}}}}};

std::string binary_stl() {
  std::string text(80, 's');  // the beginning of no text file
  const std::uint32_t count = facets.size();
  text.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& facet : facets) {
    text.append(12, '\0');
    for (const auto& corner : facet) text.append(reinterpret_cast<const char*>(corner.data()), sizeof corner);
    text.append(2, '\0');
  }
  return text;
}

std::string text_stl() {
  std::string text = "solid two\n";
  for (const auto& facet : facets) {
    text += "facet normal 0 0 1\n outer loop\n";
    for (const auto& c : facet)
      text +=
          "  vertex " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + "\n";
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid two\n";
}

template <class T>
void put(std::string& bytes, T value, bool big) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  if (big) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

/// Returns a PLY file with numbers of several types, a face of four corners, and a property and an element
/// that are not needed.
std::string binary_ply(bool big, const std::string& end = "\n") {
  std::string text;
  for (const char* line :
       {"ply", big ? "format binary_big_endian 1.0" : "format binary_little_endian 1.0", "comment x",
        "element vertex 4", "property uchar red", "property double x", "property float y", "property float z",
        "element face 1", "property list uchar int vertex_indices", "property short flag", "element edge 1",
        "property int a", "end_header"})
    text += line + end;
  for (const std::array<double, 3>& v :
       {std::array{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.5}, {0.0, 1.0, 0.0}}) {
    put<std::uint8_t>(text, '\n', big);  // this byte ends no line
    put<double>(text, v[0], big);
    put<float>(text, static_cast<float>(v[1]), big);
    put<float>(text, static_cast<float>(v[2]), big);
  }
  put<std::uint8_t>(text, 4, big);
  for (const std::int32_t k : {0, 1, 2, 3}) put(text, k, big);
  put<std::int16_t>(text, -1, big);
  put<std::int32_t>(text, 7, big);
  return text;
}

const std::string text_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_index\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n3 0 1 2\n3 0 2 3\n";

const std::string bent = "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n";

std::string with_ends(std::string text, const std::string& end) {
  std::string changed;
  for (const char c : text) changed += c == '\n' ? end : std::string(1, c);
  return changed;
}

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

TEST_F(MeshFiles, AllFormatsGiveTheSameMesh) {
  const std::string obj =
      "# a square, bent\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3 -1\n";
  const std::string bom = "\xEF\xBB\xBF",
                    cut = "v 0 \\\n 0 0\nv 1 0 0\nv 1 1 0.5 # there\nv 0 1 0\nf 1 2 \\ \n3 \\\n4";
  const MeshFile first = read("a.obj", obj, Vec3::Constant(2));
  EXPECT_EQ(first.vertices[2], Vec3(2, 2, 1));
  const std::pair<const char*, std::string> same[] = {
      {"a.stl", binary_stl()},
      {"a.stl", bom + binary_stl()},
      {"b.STL", text_stl()},
      {"c.stl", upper(text_stl())},
      {"d.stl", bom + text_stl()},
      {"e.stl", with_ends(text_stl(), "\r\n")},
      {"f.stl", with_ends(text_stl(), "\r")},
      {"g.stl", text_stl() + "\x1a\n"},
      {"h.stl", binary_stl() + "more"},
      {"a.obj", bom + obj},
      {"b.obj", with_ends(obj, "\r\n")},
      {"c.obj", with_ends(obj, "\r")},
      {"d.obj", cut},
      {"e.obj", with_ends(cut, "\r\n")},
      {"f.obj", with_ends(cut, "\r")},
      {"a.ply", text_ply},
      {"b.ply", bom + text_ply},
      {"c.ply", with_ends(text_ply, "\r\n")},
      {"d.ply", with_ends(text_ply, "\r")},
      {"e.ply", binary_ply(false)},
      {"f.ply", binary_ply(true)},
      {"g.ply", binary_ply(true, "\r\n")},
      {"h.ply", binary_ply(false, "\r")},
  };
  for (const auto& [name, text] : same) {
    const MeshFile mesh = read(name, text, Vec3::Constant(2));
    ASSERT_EQ(mesh.vertices.size(), 4u) << name;
    ASSERT_EQ(mesh.triangles, first.triangles) << name;
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(mesh.vertices[k], first.vertices[k]) << name;
  }
}

TEST_F(MeshFiles, WhatIsSkippedIsSaid) {
  EXPECT_EQ(warned("a.obj", "vt 1 1\no x\ns 1\nusemtl y\n" + bent), "");
  EXPECT_EQ(warned("b.obj", bent + "l 1 2\nl 2 3\ncurv 0 1 1 2\n"),
            "3 lines are skipped, which are neither vertices nor faces: 1 of `curv`, 2 of `l`");
  EXPECT_EQ(warned("c.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3 4\n"),
            "1 of its polygons cross themselves, and are taken as fans of triangles");
  EXPECT_EQ(warned("a.stl", text_stl()), "");
  EXPECT_EQ(warned("b.stl", text_stl() + "\n\x1a xyz"),
            "5 bytes after its last facet, from line 18 on, are skipped");
  EXPECT_EQ(warned("c.stl", binary_stl() + std::string(7, '\0')),
            "7 bytes after the last of its 2 facets are skipped");
  EXPECT_EQ(warned("a.ply", text_ply), "");
  EXPECT_EQ(warned("b.ply", binary_ply(false)),
            "its 1 elements `edge` are skipped, which are neither vertices nor faces");
}

TEST_F(MeshFiles, APolygonThatIsNotConvexKeepsItsForm) {
  // The polygon is an arrow's head, which starts at each of its corners in turn.
  constexpr double expected = 0.5;
  const std::array<const char*, 4> corners = {"v 0 0 0\n", "v 1 0.5 0\n", "v 0 1 0\n", "v 0.5 0.5 0\n"};
  for (std::size_t first = 0; first < 4; ++first) {
    std::string obj;
    for (std::size_t k = 0; k < 4; ++k) obj += corners[(first + k) % 4];
    const SceneMesh mesh = read_scene("a.obj", obj + "f 1 2 3 4\n");
    double area = 0;
    for (const PlacedTriangle& t : mesh.triangles) {
      EXPECT_GT((t.orientation * Vec3::UnitZ()).z(), 0.999);
      area += 2 * t.size.x() * t.size.z();
    }
    EXPECT_NEAR(area, 0.5 * expected, 1e-14) << first;
  }
}

TEST_F(MeshFiles, AMirroredScaleTurnsTrianglesRound) {
  const std::string flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const Vec3& scale :
       {Vec3(1, 1, 1), Vec3(-2, 1, 1), Vec3(1, -1, 3), Vec3(-1, -1, 1), Vec3(-1, -2, -3), Vec3(1, 1, -1)}) {
    const SceneMesh mesh = scene_mesh(read("a.obj", flat, scale), "a.obj", {});
    ASSERT_EQ(mesh.triangles.size(), 1u);
    // The front of a triangle in the plane z = 0 is mirrored with the z axis.
    const double front = (mesh.triangles[0].orientation * Vec3::UnitZ()).z();
    EXPECT_NEAR(front, scale.z() > 0 ? 1 : -1, 1e-12) << scale.transpose();
  }
}

TEST_F(MeshFiles, EqualPlacesAreOneVertexAndTrianglesWithoutAreaAreLeftOut) {
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 2 0 0\nf 1 2 3\nf 2 3 4\nf 1 2 5\nf 1 1 2\n";
  const SceneMesh scene = read_scene("a.obj", obj);
  EXPECT_EQ(scene.mesh.vertices.size(), 4u);
  EXPECT_EQ(scene.triangles.size(), 1u);
  EXPECT_EQ(scene.report.left_out, 3);
}

TEST_F(MeshFiles, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_NE(told("a.obj", "v 0 0 0\nv 1 nan 0\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nv 1 0\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nf 1 2 3\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nf 1 1\n").find("three vertices"), std::string::npos);
  EXPECT_NE(told("a.obj", "").find("no triangle"), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nv 1 0 0 \\\nx\nf 1 2 9\n").find("a.obj:4: "), std::string::npos);
  EXPECT_NE(told("a.obj", std::string("\xFF\xFEv\0 \0", 6)).find("UTF-16"), std::string::npos);
  EXPECT_NE(told("a.off", "").find("none of .obj, .stl and .ply"), std::string::npos);
  EXPECT_NE(told("a.stl", "").find("empty"), std::string::npos);
  EXPECT_NE(told("a.stl", "solid\nfacet normal 0 0 1\n").find("within a facet"), std::string::npos);
  EXPECT_NE(told("a.stl", text_stl() + "x\nfacet normal 0 0 1\n").find("a.stl:17: `x`"), std::string::npos);
  EXPECT_NE(told("a.stl", binary_stl().substr(0, 150)).find("should have 2 facets, and has 1"),
            std::string::npos);
  std::string broken = binary_stl();
  const float nan = NAN;
  std::memcpy(broken.data() + 84 + 12, &nan, sizeof nan);
  EXPECT_NE(told("a.stl", broken).find("triangle 1 "), std::string::npos);
  const std::string ply = "ply\nformat ascii 1.0\n";
  EXPECT_NE(told("a.ply", "").find("does not begin with `ply`"), std::string::npos);
  EXPECT_NE(told("a.ply", "ply\nend_header\n").find("a.ply:2: the header has no `format`"),
            std::string::npos);
  EXPECT_NE(told("a.ply", "ply\nformat text 1.0\n").find("a.ply:2: the format must be"), std::string::npos);
  EXPECT_NE(told("a.ply", ply).find("ends within its header"), std::string::npos);
  EXPECT_NE(told("a.ply", ply + "property float x\n").find("a.ply:3: "), std::string::npos);
  EXPECT_NE(told("a.ply", ply + "element vertex -1\n").find("not `-1`"), std::string::npos);
  EXPECT_NE(told("a.ply", ply + "element vertex 1\nproperty real x\n").find("`real` is no type"),
            std::string::npos);
  EXPECT_NE(
      told("a.ply", ply + "element vertex 1\nproperty float x\nend_header\n0\n").find("no property `y`"),
      std::string::npos);
  EXPECT_NE(told("a.ply", text_ply.substr(0, text_ply.size() - 3)).find("ends before"), std::string::npos);
  std::string beyond = text_ply;
  beyond[beyond.size() - 2] = '4';
  EXPECT_NE(told("a.ply", beyond).find("a.ply:15: face 1 has the vertex 4, of 4"), std::string::npos);
}

}  // namespace
}  // namespace scree
