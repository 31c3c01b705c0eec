// Trajectories: what is written is read again, by scree and by HDF5, which knows nothing of scree.
#include "core/error.hpp"
#include "sim/record/exports.hpp"
#include "sim/record/trajectory_reader.hpp"
#include "sim/record/trajectory_writer.hpp"
#include "tests/sim/record/hdf5_dataset.hpp"
#include "tests/sim/record/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace scree {
namespace {

namespace fs = std::filesystem;
using Opening = AtomicFile::Opening;

/// A row of balls and boxes of all kinds, with a plane.
Scene scene_of(int bodies, TrajectorySettings settings = {}) {
  Scene scene;
  scene.record.trajectory = settings;
  for (int k = 0; k < bodies; ++k) {
    BodyTable& table = scene.bodies;
    table.position.emplace_back(k, 0, 0);
    table.orientation.push_back(Quat(std::cos(0.1 * k), std::sin(0.1 * k), 0, 0));
    table.velocity.emplace_back(0, 1.0 / (k + 1), 0);
    table.spin.emplace_back(0, 0, 0.3 * k);
    table.size.emplace_back(0.1, 0.2, 0.3);
    table.inverse_mass.push_back(1);
    table.inverse_inertia.push_back(Vec3::Ones());
    table.shape.push_back(k == 0 ? Shape::plane : k % 2 == 1 ? Shape::sphere : Shape::box);
    table.mobility.push_back(k == 0 ? Mobility::fixed : Mobility::free);
    table.material.push_back(k % 3);
    table.id.push_back(BodyNumber{k});
  }
  return scene;
}

/// What frame `f` of the tests shows: everybody has moved on, and in some frames somebody is away.
Snapshot shot(const Scene& scene, int f) {
  Snapshot snapshot{0.1 * f, 10 * f, scene.bodies};
  for (Vec3& x : snapshot.bodies.position) x += Vec3(0, f, 1.0 / (f + 3));
  if (f == 2 || f == 3) snapshot.bodies.mobility[1] = Mobility::absent;
  return snapshot;
}

constexpr int frames = 6;

fs::path write(const Scene& scene, const TemporaryFolder& folder, int threads = 1) {
  fs::path file = folder / "trajectory.vtkhdf";
  TrajectoryWriter writer(scene, file, Opening::anew, threads);
  for (int f = 0; f < frames; ++f) writer.append(shot(scene, f));
  writer.finish();
  writer.drop();
  return file;
}

/// Components that are there, one by one.
std::vector<double> flat(const std::vector<Vec3>& vectors) {
  std::vector<double> numbers;
  for (const Vec3& v : vectors) numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  return numbers;
}

template <class T>
std::vector<T> present(const std::vector<T>& values, const BodyTable& bodies) {
  std::vector<T> kept;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (bodies.mobility[k] != Mobility::absent) kept.push_back(values[k]);
  return kept;
}

std::vector<double> in_single(std::vector<double> numbers) {
  for (double& x : numbers) x = static_cast<double>(static_cast<float>(x));
  return numbers;
}

std::vector<double> column(TrajectoryReader& reader, std::size_t frame, const char* name) {
  const int column = reader.column(name);
  if (column < 0) return {};
  return reader.numbers(frame, static_cast<std::size_t>(column));
}

TEST(Trajectory, WhatIsWrittenIsReadAgain) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(7, {.spin = true, .in_double = true});
  TrajectoryReader reader(write(scene, folder));
  ASSERT_EQ(reader.index().frames().size(), frames);
  for (int f = 0; f < frames; ++f) {
    const auto frame = static_cast<std::size_t>(f);
    const Snapshot expected = shot(scene, f);
    const BodyTable& bodies = expected.bodies;
    EXPECT_EQ(reader.index().frames()[frame].step, expected.step);
    EXPECT_EQ(reader.index().frames()[frame].time, expected.time);
    EXPECT_EQ(column(reader, frame, "position"), flat(present(bodies.position, bodies)));
    EXPECT_EQ(column(reader, frame, "velocity"), flat(present(bodies.velocity, bodies)));
    EXPECT_EQ(column(reader, frame, "spin"), flat(present(bodies.spin, bodies)));
    std::vector<double> turns, ids, sizes;
    for (std::size_t k = 0; k < bodies.id.size(); ++k) {
      if (bodies.mobility[k] == Mobility::absent) continue;
      const Quat& q = bodies.orientation[k];
      turns.insert(turns.end(), {q.w(), q.x(), q.y(), q.z()});
      ids.push_back(static_cast<double>(k));
      const Vec3 size = k == 0 ? Vec3(0, 0, 0) : k % 2 == 1 ? Vec3(0.2, 0.2, 0.2) : Vec3(0.2, 0.4, 0.6);
      sizes.insert(sizes.end(), {size.x(), size.y(), size.z()});
    }
    EXPECT_EQ(column(reader, frame, "orientation"), turns);
    EXPECT_EQ(column(reader, frame, "id"), ids);
    EXPECT_EQ(column(reader, frame, "size"), sizes);
  }
}

TEST(Trajectory, HasWhatIsAskedForInSingleNumbers) {
  const TemporaryFolder folder;
  const Scene scene = scene_of(5, {.orientation = false, .velocity = false});
  TrajectoryReader reader(write(scene, folder));
  EXPECT_EQ(reader.column("orientation"), -1);
  EXPECT_EQ(reader.column("velocity"), -1);
  EXPECT_EQ(reader.column("spin"), -1);
  const Snapshot last = shot(scene, frames - 1);
  EXPECT_EQ(column(reader, frames - 1, "position"), in_single(flat(last.bodies.position)));
}

TEST(Trajectory, WhatDoesNotChangeIsWrittenOnce) {
  const TemporaryFolder folder;
  const TrajectoryReader reader(write(scene_of(7), folder));
  const auto id = static_cast<std::size_t>(reader.column("id"));
  const TrajectoryIndex& index = reader.index();
  EXPECT_EQ(index.first_chunk(0, id), index.first_chunk(1, id));
  EXPECT_NE(index.first_chunk(1, id), index.first_chunk(2, id)) << "one has gone";
  EXPECT_EQ(index.first_chunk(2, id), index.first_chunk(3, id));
  EXPECT_NE(index.first_chunk(3, id), index.first_chunk(4, id)) << "and come back";
  EXPECT_NE(index.first_chunk(0, 0), index.first_chunk(1, 0)) << "places are new in each";
}

TEST(Trajectory, ManyBodiesAreInSeveralChunksAndThreadsChangeNoByte) {
  const TemporaryFolder one, two;
  const Scene scene = scene_of(static_cast<int>(TrajectoryIndex::most_chunk_rows) + 1000);
  const fs::path file = write(scene, one, 1);
  TrajectoryReader reader(file);
  const Snapshot last = shot(scene, frames - 1);
  EXPECT_EQ(reader.index().chunks_for(last.bodies.count()), 2);
  EXPECT_EQ(column(reader, frames - 1, "position"), in_single(flat(last.bodies.position)));
  EXPECT_TRUE(text_of(file) == text_of(write(scene, two, 2)));
}

TEST(Trajectory, GoneOnWithItHasTheSameBytes) {
  const TemporaryFolder folder, other;
  const Scene scene = scene_of(7);
  SavedState saved;
  const fs::path file = folder / "trajectory.vtkhdf";
  {
    TrajectoryWriter writer(scene, file, Opening::anew, 1);
    for (int f = 0; f < 3; ++f) writer.append(shot(scene, f));
    Archive archive = Archive::saving(saved);
    archive.part("writer", writer);
    writer.append(shot(scene, 5));  // to be forgotten
    writer.finish();
  }
  TrajectoryWriter writer(scene, file, Opening::again, 1);
  Archive archive = Archive::loading(saved);
  archive.part("writer", writer);
  for (int f = 3; f < frames; ++f) writer.append(shot(scene, f));
  writer.finish();
  writer.drop();
  EXPECT_TRUE(text_of(file) == text_of(write(scene, other)));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1)
      << "the journal is gone";
}

TEST(Trajectory, WhateverByteIsWrongIsFoundOrIsNotScreesToRead) {
  const TemporaryFolder folder;
  const fs::path file = write(scene_of(3), folder);
  const std::string whole = text_of(file);
  const auto numbers_of = [&] {
    TrajectoryReader reader(file);
    std::vector<double> numbers;
    for (std::size_t f = 0; f < reader.index().frames().size(); ++f) {
      for (std::size_t c = 0; c < reader.index().columns().size(); ++c) {
        const std::vector<double> column = reader.numbers(f, c);
        numbers.insert(numbers.end(), column.begin(), column.end());
      }
    }
    return numbers;
  };
  const std::vector<double> expected = numbers_of();
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 13) {
    std::string damaged = whole;
    damaged[at] ^= 4;
    write_text(file, damaged);
    try {
      EXPECT_EQ(numbers_of(), expected) << at;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
    write_text(file, whole.substr(0, length));
    EXPECT_THROW(numbers_of(), InputError) << length;
  }
  EXPECT_THROW(TrajectoryReader(folder / "absent"), InputError);
  EXPECT_THROW(TrajectoryReader(folder.path()), InputError);
}

/// As the description of the format says that a step is read (VTK File Formats, "VTKHDF", temporal data).
TEST(Trajectory, HDF5ReadsTheStepsAsTheFormatSays) {
  constexpr int bodies = 300;  // more than a byte counts
  const TemporaryFolder folder;
  const Scene scene = scene_of(bodies);
  const fs::path file = write(scene, folder);
  TrajectoryReader reader(file);
  for (hsize_t f = 0; f < frames; ++f) {
    const auto number = [&](const std::string& name) {
      return static_cast<hsize_t>(dataset(file, "/VTKHDF/" + name, f, 1)[0]);
    };
    EXPECT_DOUBLE_EQ(dataset(file, "/VTKHDF/Steps/Values", f, 1)[0], 0.1 * static_cast<double>(f));
    EXPECT_EQ(number("Steps/NumberOfParts"), 1);
    const hsize_t part = number("Steps/PartOffsets");
    const auto points = static_cast<hsize_t>(dataset(file, "/VTKHDF/NumberOfPoints", part, 1)[0]);
    ASSERT_EQ(points, f == 2 || f == 3 ? bodies - 1 : bodies);
    EXPECT_EQ(dataset(file, "/VTKHDF/Points", number("Steps/PointOffsets"), points),
              column(reader, f, "position"));
    for (const char* name : {"orientation", "velocity", "id", "size", "shape", "mobility", "material"}) {
      const hsize_t first = number(std::string("Steps/PointDataOffsets/") + name);
      EXPECT_EQ(dataset(file, std::string("/VTKHDF/PointData/") + name, first, points),
                column(reader, f, name));
    }
    // One vertex for each point.
    EXPECT_EQ(static_cast<hsize_t>(dataset(file, "/VTKHDF/Vertices/NumberOfCells", part, 1)[0]), points);
    const auto cells = static_cast<hsize_t>(dataset(file, "/VTKHDF/Steps/CellOffsets", f, 1)[0]);
    const std::vector<double> ends = dataset(file, "/VTKHDF/Vertices/Offsets", cells + part, points + 1);
    const std::vector<double> vertices = dataset(file, "/VTKHDF/Vertices/Connectivity", cells, points);
    for (hsize_t k = 0; k <= points; ++k) EXPECT_EQ(ends[k], static_cast<double>(k));
    for (hsize_t k = 0; k < points; ++k) EXPECT_EQ(vertices[k], static_cast<double>(k));
  }
}

/// The words of a line.
std::vector<std::string> words(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::vector<std::string> lines(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

TEST(Trajectory, IsExportedAsXyz) {
  const TemporaryFolder folder;
  TrajectoryReader reader(write(scene_of(4), folder));
  const std::vector<std::string> text =
      lines(export_trajectory(reader, ExportFormat::xyz, {}, folder.path()).file);
  // Two lines before the particles of each frame, of which the plane is none.
  ASSERT_EQ(text.size(), frames * 2 + 4 * 3 + 2 * 2);
  EXPECT_EQ(text[0], "3");
  EXPECT_EQ(text[1],
            "Properties=type:I:1:pos:R:3:id:I:1:material:I:1:radius:R:1:aspherical_shape:R:3:orientation:R:4:"
            "velo:R:3:mobility:I:1 Time=0 Timestep=0 pbc=\"F F F\" types=\"1 sphere, 2 box, 3 capsule, 4 "
            "cylinder, 5 "
            "polyhedron as "
            "the box around it\" left_out=\"1 plane\"");
  EXPECT_EQ(words(text[2]), words("1 1 0 0.33333334 1 1 0.1 0 0 0 0.099833414 0 0 0.9950042 0 0.5 0 0"));
  EXPECT_EQ(words(text[3]),
            words("2 2 0 0.33333334 2 2 0 0.1 0.2 0.3 0.19866933 0 0 0.9800666 0 0.33333334 0 0"));
}

TEST(Trajectory, IsExportedForLammps) {
  const TemporaryFolder folder;
  TrajectoryReader reader(write(scene_of(4), folder));
  const std::vector<std::string> text =
      lines(export_trajectory(reader, ExportFormat::lammps, {}, folder.path()).file);
  const std::vector<std::string> start = {
      "ITEM: TIMESTEP",
      "0",
      "ITEM: TIME",
      "0",
      "ITEM: NUMBER OF ATOMS",
      "3",
      "ITEM: BOX BOUNDS ff ff ff",
      "1 3",
      "0 0",
      "0.33333334 0.33333334",
      ("ITEM: ATOMS id type x y z radius shapex shapey shapez quatw quati quatj "
       "quatk vx vy vz mobility"),
      "2 1 1 0 0.33333334 0.1 0.2 0.2 0.2 0.9950042 0.099833414 0 0 0 0.5 0 0"};
  ASSERT_GE(text.size(), start.size());
  EXPECT_TRUE(std::equal(start.begin(), start.end(), text.begin()));
}

TEST(Trajectory, IsExportedAsTables) {
  const TemporaryFolder folder;
  TrajectoryReader reader(write(scene_of(2), folder));
  const fs::path files = export_trajectory(reader, ExportFormat::csv, {}, folder.path()).file;
  EXPECT_EQ(std::distance(fs::directory_iterator(files), fs::directory_iterator()), frames);
  EXPECT_EQ(
      text_of(files / "00002.csv"),
      "position_x,position_y,position_z,orientation_w,orientation_x,orientation_y,orientation_z,velocity_x,"
      "velocity_y,velocity_z,id,size_x,size_y,size_z,shape,mobility,material\n"
      "0,2,0.2,1,0,0,0,0,1,0,0,0,0,0,2,1,0\n");
}

TEST(Trajectory, IsExportedForVtk) {
  const TemporaryFolder folder;
  TrajectoryReader reader(write(scene_of(4), folder));
  const std::string collection =
      text_of(export_trajectory(reader, ExportFormat::vtp, {}, folder.path()).file);
  EXPECT_NE(collection.find("<DataSet timestep=\"0.2\" file=\"vtp/00002.vtp\"/>"), std::string::npos);
  const std::string file = text_of(folder / "vtp/00000.vtp");
  const std::size_t start = file.find("<AppendedData encoding=\"raw\">\n_") + 31;
  // The offset that an array says, where its length and then its numbers are.
  const auto block = [&](const std::string& name) {
    const std::size_t array = file.find("Name=\"" + name + "\"");
    const std::size_t at = start + std::stoul(file.substr(file.find("offset=\"", array) + 8));
    std::uint64_t length = 0;
    std::memcpy(&length, file.data() + at, sizeof(length));
    return file.substr(at + sizeof(length), length);
  };
  const std::vector<double> position = column(reader, 0, "position");
  const std::string points = block("position");
  ASSERT_EQ(points.size(), position.size() * sizeof(float));
  for (std::size_t k = 0; k < position.size(); ++k) {
    float number = 0;
    std::memcpy(&number, points.data() + k * sizeof(float), sizeof(float));
    EXPECT_EQ(static_cast<double>(number), position[k]);
  }
  EXPECT_EQ(block("shape"), std::string("\2\0\1\0", 4));
  EXPECT_EQ(block("offsets").substr(0, 9), std::string("\1\0\0\0\0\0\0\0\2", 9));
}

}  // namespace
}  // namespace scree
