// Meshes from files: the same mesh in each format, and what is left out.
#include "sim/scene/mesh_file.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

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

class MeshFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  fs::path folder_ = fs::temp_directory_path() / ("scree_mesh_file_test_" + std::to_string(::getpid()));
};

constexpr std::array<std::array<std::array<float, 3>, 3>, 2> facets = {
    {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}}}, {{{0, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}}}}};

std::string binary_stl() {
  std::string text(80, 's');  // begins like no text one
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

TEST_F(MeshFile, AllFormatsGiveTheSameMesh) {
  const std::string obj =
      "# a square, bent\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3 -1\n";
  const TriangleMesh from_obj = read_mesh_file(write("a.obj", obj), 2);
  for (const fs::path& file : {write("a.stl", binary_stl()), write("b.STL", text_stl())}) {
    const TriangleMesh mesh = read_mesh_file(file, 2);
    ASSERT_EQ(mesh.vertices.size(), 4u) << file;
    ASSERT_EQ(mesh.triangles, from_obj.triangles) << file;
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(mesh.vertices[k], from_obj.vertices[k]) << file;
  }
  EXPECT_EQ(from_obj.vertices[2], Vec3(2, 2, 1));
}

TEST_F(MeshFile, EqualPlacesAreOneVertexAndTrianglesWithoutAreaAreLeftOut) {
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 2 0 0\nf 1 2 3\nf 2 3 4\nf 1 2 5\nf 1 1 2\n";
  const SceneMesh scene = read_scene_mesh(write("a.obj", obj), 1);
  EXPECT_EQ(scene.mesh.vertices.size(), 4u);
  EXPECT_EQ(scene.triangles.size(), 1u);
  EXPECT_EQ(scene.mesh.left_out, 3);
}

TEST_F(MeshFile, WhatIsWrongIsNamedWithItsLine) {
  const auto told = [&](const char* name, const std::string& text) -> std::string {
    try {
      read_scene_mesh(write(name, text), 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(told("a.obj", "v 0 0 0\nv 1 nan 0\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nv 1 0\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nf 1 2 3\n").find("a.obj:2: "), std::string::npos);
  EXPECT_NE(told("a.obj", "v 0 0 0\nf 1 1\n").find("three vertices"), std::string::npos);
  EXPECT_NE(told("a.obj", "").find("no triangle"), std::string::npos);
  EXPECT_NE(told("a.ply", "").find("neither"), std::string::npos);
  EXPECT_NE(told("a.stl", "").find("empty"), std::string::npos);
  EXPECT_NE(told("a.stl", binary_stl() + "x").find("a.stl:1: "), std::string::npos);
  std::string broken = binary_stl();
  const float nan = NAN;
  std::memcpy(broken.data() + 84 + 12, &nan, sizeof nan);
  EXPECT_NE(told("a.stl", broken).find("triangle 1 "), std::string::npos);
}

}  // namespace
}  // namespace scree
