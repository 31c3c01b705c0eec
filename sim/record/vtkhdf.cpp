#include "sim/record/vtkhdf.hpp"

#include "core/error.hpp"
#include "sim/record/files.hpp"
#include "sim/record/hdf5.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace scree {

namespace {

using hdf5::check;
using hdf5::Handle;
namespace fs = std::filesystem;
using WholeNumbers = std::vector<std::int64_t>;

constexpr FieldType whole_number{FieldType::Kind::integer, sizeof(std::int64_t), 1};

/// Returns the settings of a file, a group or a dataset that does not record when it was made: otherwise the
/// same run would not give the same bytes.
Handle make_settings(hid_t kind) {
  const hid_t settings = H5Pcreate(kind);
  check(H5Pset_obj_track_times(settings, false), "make settings");
  return {settings, H5Pclose, "make settings"};
}

Handle make_group(hid_t in, const char* name) {
  const Handle settings = make_settings(H5P_GROUP_CREATE);
  return {H5Gcreate2(in, name, H5P_DEFAULT, settings, H5P_DEFAULT), H5Gclose, "make a group"};
}

void write_attribute(hid_t of, const char* name, hid_t type, hid_t space, const void* value) {
  const Handle attribute(H5Acreate2(of, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "make an attribute");
  check(H5Awrite(attribute, type, value), "write an attribute");
}

void write_attribute(hid_t of, const char* name, std::span<const std::int64_t> values) {
  const hsize_t extent = values.size();
  const Handle space(values.size() == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &extent, nullptr),
                     H5Sclose, "make a shape");
  write_attribute(of, name, H5T_NATIVE_INT64, space, values.data());
}

void write_attribute(hid_t of, const char* name, std::string_view word) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type");
  check(H5Tset_size(type, word.size()), "make a type");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a shape");
  write_attribute(of, name, type, space, word.data());
}

/// Makes a dataset of rows of numbers, in chunks if chunk_rows > 0.
Handle make_dataset(hid_t in, const std::string& name, const FieldType& type, std::int64_t rows,
                    std::int64_t chunk_rows) {
  const auto width = static_cast<hsize_t>(type.columns);
  const std::array<hsize_t, 2> extent = {static_cast<hsize_t>(rows), width};
  const std::array<hsize_t, 2> chunk = {static_cast<hsize_t>(chunk_rows), width};
  const int rank = type.columns > 1 ? 2 : 1;
  const Handle number = hdf5::type_of(type);
  const Handle space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose, "make a shape");
  const Handle settings = make_settings(H5P_DATASET_CREATE);
  if (chunk_rows > 0) {
    check(H5Pset_chunk(settings, rank, chunk.data()), "make settings");
    check(H5Pset_shuffle(settings), "make settings");
    check(H5Pset_deflate(settings, 1), "make settings");
  }
  return {H5Dcreate2(in, name.c_str(), number, space, H5P_DEFAULT, settings, H5P_DEFAULT), H5Dclose,
          "make a dataset"};
}

/// Writes whole numbers as one dataset, `columns` numbers to a row.
void write_numbers(hid_t in, const char* name, const WholeNumbers& numbers, int columns = 1) {
  constexpr std::int64_t chunk_rows = 1 << 16;
  FieldType type = whole_number;
  type.columns = columns;
  const std::int64_t rows = std::ssize(numbers) / columns;
  const Handle data = make_dataset(in, name, type, rows, rows > chunk_rows ? chunk_rows : 0);
  check(H5Dwrite(data, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "write a dataset");
}

void write_reals(hid_t in, const char* name, const std::vector<double>& numbers) {
  const FieldType type{FieldType::Kind::real, sizeof(double), 1};
  const Handle data = make_dataset(in, name, type, std::ssize(numbers), 0);
  check(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), "write a dataset");
}

/// The frames and chunks that a column's dataset consists of, in its order. Frames that share their chunks
/// share their rows.
struct Placing {
  WholeNumbers first_rows;  ///< first row of each frame
  WholeNumbers chunks;      ///< chunks, by their numbers in the index
};

Placing place(const TrajectoryIndex& index, std::size_t column) {
  Placing placing;
  for (std::size_t f = 0; f < index.frames().size(); ++f) {
    const std::int64_t rows = index.frames()[f].rows;
    const std::int64_t first = index.first_chunk(f, column);
    if (f > 0 && first == index.first_chunk(f - 1, column) && rows == index.frames()[f - 1].rows) {
      placing.first_rows.push_back(placing.first_rows.back());
      continue;
    }
    placing.first_rows.push_back(std::ssize(placing.chunks) * index.chunk_rows());
    for (std::int64_t k = 0; k < index.chunks_for(rows); ++k) placing.chunks.push_back(first + k);
  }
  return placing;
}

/// Copies chunks from the journal to files of HDF5, and notes where each is in the file.
class ChunkCopier {
 public:
  ChunkCopier(const TrajectoryIndex& index, const fs::path& journal)
      : index_(index), journal_(journal, std::ios::binary), path_(journal), moved_(index.chunks()) {
    if (!journal_) fail();
  }

  void copy(hid_t in, const std::string& name, std::size_t column, const Placing& placing) {
    const std::int64_t rows = index_.chunk_rows();
    const Handle data =
        make_dataset(in, name, index_.columns()[column].type, std::ssize(placing.chunks) * rows, rows);
    std::string bytes;
    for (std::size_t k = 0; k < placing.chunks.size(); ++k) {
      const auto number = static_cast<std::size_t>(placing.chunks[k]);
      const TrajectoryChunk& chunk = index_.chunks()[number];
      bytes.resize(static_cast<std::size_t>(chunk.bytes));
      journal_.seekg(chunk.place);
      if (!journal_.read(bytes.data(), chunk.bytes)) fail();
      const std::array<hsize_t, 2> at = {k * static_cast<hsize_t>(rows), 0};
      check(H5Dwrite_chunk(data, H5P_DEFAULT, 0, at.data(), bytes.size(), bytes.data()), "write a chunk");
      haddr_t place = 0;
      hsize_t size = 0;
      unsigned filters = 0;
      check(H5Dget_chunk_info_by_coord(data, at.data(), &filters, &place, &size), "find a chunk");
      moved_[number] = {static_cast<std::int64_t>(place), static_cast<std::int64_t>(size)};
    }
  }
  const std::vector<TrajectoryChunk>& moved() const { return moved_; }

 private:
  [[noreturn]] void fail() const {
    throw RunError(fmt::format("cannot read {}: {}", path_.string(), std::strerror(errno)));
  }

  const TrajectoryIndex& index_;
  std::ifstream journal_;
  fs::path path_;
  std::vector<TrajectoryChunk> moved_;
};

/// The parts of the dataset of cells. Frames with the same number of points share a part.
struct Parts {
  WholeNumbers points;    ///< number of points of each part
  WholeNumbers of_frame;  ///< part of each frame
};

Parts parts_of(const TrajectoryIndex& index) {
  Parts parts;
  for (const TrajectoryFrame& frame : index.frames()) {
    if (parts.points.empty() || parts.points.back() != frame.rows) parts.points.push_back(frame.rows);
    parts.of_frame.push_back(std::ssize(parts.points) - 1);
  }
  return parts;
}

/// The kinds of cells of the format, in its order.
struct CellKind {
  const char* name;
  std::int64_t points;  ///< number of points of a cell; 0: there are no such cells
};
using CellKinds = std::array<CellKind, 4>;

CellKinds kinds_of(Cells cells) {
  return {{{"Vertices", cells == Cells::vertices ? 1 : 0},
           {"Lines", cells == Cells::lines ? 2 : 0},
           {"Polygons", 0},
           {"Strips", 0}}};
}

/// Writes the cells of one kind: either every point is in one cell, in order, or there are none.
void write_cells(hid_t root, const CellKind& kind, const Parts& parts) {
  WholeNumbers cells, ids, offsets, connectivity;
  for (const std::int64_t points : parts.points) {
    const std::int64_t count = kind.points > 0 ? points / kind.points : 0;
    cells.push_back(count);
    ids.push_back(count * kind.points);
    for (std::int64_t k = 0; k <= count; ++k) offsets.push_back(k * kind.points);
    for (std::int64_t k = 0; k < ids.back(); ++k) connectivity.push_back(k);
  }
  const Handle group = make_group(root, kind.name);
  write_numbers(group, "NumberOfCells", cells);
  write_numbers(group, "NumberOfConnectivityIds", ids);
  write_numbers(group, "Offsets", offsets);
  write_numbers(group, "Connectivity", connectivity);
}

void write_steps(hid_t root, const TrajectoryIndex& index, const CellKinds& kinds, const Parts& parts,
                 const std::vector<Placing>& placings) {
  WholeNumbers first_point(parts.points.size(), 0);
  std::exclusive_scan(parts.points.begin(), parts.points.end(), first_point.begin(), std::int64_t{0});
  WholeNumbers first_cells, first_ids;
  std::vector<double> times;
  for (std::size_t f = 0; f < index.frames().size(); ++f) {
    times.push_back(index.frames()[f].time);
    const std::int64_t point = first_point[static_cast<std::size_t>(parts.of_frame[f])];
    for (const CellKind& kind : kinds) {
      first_cells.push_back(kind.points > 0 ? point / kind.points : 0);
      first_ids.push_back(kind.points > 0 ? point : 0);
    }
  }
  const std::int64_t frames = std::ssize(index.frames());
  const Handle group = make_group(root, "Steps");
  write_attribute(group, "NSteps", {&frames, 1});
  write_reals(group, "Values", times);
  write_numbers(group, "PartOffsets", parts.of_frame);
  write_numbers(group, "NumberOfParts", WholeNumbers(index.frames().size(), 1));
  write_numbers(group, "PointOffsets", placings[0].first_rows);
  write_numbers(group, "CellOffsets", first_cells, static_cast<int>(kinds.size()));
  write_numbers(group, "ConnectivityIdOffsets", first_ids, static_cast<int>(kinds.size()));
  const Handle offsets = make_group(group, "PointDataOffsets");
  for (std::size_t c = 1; c < placings.size(); ++c)
    write_numbers(offsets, index.columns()[c].name.c_str(), placings[c].first_rows);
}

/// Writes the HDF5 part of the file. Returns where the chunks are in it.
std::vector<TrajectoryChunk> write_hdf5(const fs::path& part, const TrajectoryIndex& index, Cells cells,
                                        const fs::path& journal) {
  const hdf5::Session session;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make settings");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V110), "make settings");
  const Handle settings = make_settings(H5P_FILE_CREATE);
  const Handle file(H5Fcreate(part.c_str(), H5F_ACC_TRUNC, settings, access), H5Fclose, "make a file");
  const Handle root = make_group(file, "VTKHDF");
  write_attribute(root, "Version", std::array<std::int64_t, 2>{2, 0});
  write_attribute(root, "Type", "PolyData");
  std::vector<Placing> placings;
  for (std::size_t c = 0; c < index.columns().size(); ++c) placings.push_back(place(index, c));
  const Parts parts = parts_of(index);
  write_numbers(root, "NumberOfPoints", parts.points);
  ChunkCopier copier(index, journal);
  copier.copy(root, "Points", 0, placings[0]);
  const Handle data = make_group(root, "PointData");
  for (std::size_t c = 1; c < placings.size(); ++c)
    copier.copy(data, index.columns()[c].name, c, placings[c]);
  const CellKinds kinds = kinds_of(cells);
  for (const CellKind& kind : kinds) write_cells(root, kind, parts);
  write_steps(root, index, kinds, parts, placings);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "finish the file");
  return copier.moved();
}

/// Frees the disk space of the file at once, since the run may still have to write; the library may keep the
/// file open.
void discard(const fs::path& part) {
  std::error_code none;
  fs::resize_file(part, 0, none);
  fs::remove(part, none);
}

}  // namespace

void write_vtkhdf(const fs::path& file, const TrajectoryIndex& index, Cells cells, const fs::path& journal) {
  const fs::path part = fs::path(file) += ".part";
  TrajectoryIndex of_file = index;
  try {
    errno = 0;
    of_file.move_chunks(write_hdf5(part, index, cells, journal));
  } catch (const RunError& error) {
    // The library gives neither the file nor the reason.
    const std::string reason = errno != 0 ? std::strerror(errno) : error.what();
    discard(part);
    throw RunError(fmt::format("cannot write {}: {}", part.string(), reason));
  }
  AtomicFile whole(file, AtomicFile::Opening::again);
  whole.write(trajectory_trailer(of_file));
  whole.commit();
}

}  // namespace scree
