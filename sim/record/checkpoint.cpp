// HDF5 is included here alone.
#include "sim/record/checkpoint.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "sim/record/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <functional>
#include <hdf5.h>
#include <string_view>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

/// Bytes before the HDF5 file: one of the places where its readers look for its beginning.
constexpr std::size_t head_bytes = 512;
constexpr std::string_view head_words = "scree checkpoint 1, xxh3 of the rest: ";

/// An object of the library, which is released with it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws RunError if the library gave none.
  Handle(hid_t id, Close close, const char* what) : id_(id), close_(close) {
    if (id < 0) throw RunError(fmt::format("HDF5 cannot {}", what));
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: the library's functions take it so

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t status, const char* what) {
  if (status < 0) throw RunError(fmt::format("HDF5 cannot {}", what));
}

/// Its own messages would go to stderr.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

/// Of one number, little-endian; of a record, its bytes.
Handle type_of(const FieldType& type) {
  hid_t id = -1;
  if (type.kind == FieldType::Kind::bytes) {
    id = H5Tcreate(H5T_OPAQUE, static_cast<std::size_t>(type.columns));
  } else if (type.kind == FieldType::Kind::real) {
    id = H5Tcopy(type.width == 4 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE);
  } else {
    id = H5Tcopy(type.kind == FieldType::Kind::integer ? H5T_STD_I8LE : H5T_STD_U8LE);
    if (id >= 0) H5Tset_size(id, static_cast<std::size_t>(type.width));
  }
  return {id, H5Tclose, "make a type"};
}

bool has_columns(const FieldType& type) { return type.kind != FieldType::Kind::bytes && type.columns > 1; }

std::uint64_t checksum_of(const SavedField& field) {
  return hash_of(field.bytes.data(), static_cast<std::size_t>(field.bytes.size()));
}

void write_field(hid_t file, hid_t links, const SavedField& field) {
  const std::array<hsize_t, 2> extent = {static_cast<hsize_t>(field.rows()),
                                         static_cast<hsize_t>(field.type.columns)};
  const Handle type = type_of(field.type);
  const Handle space(H5Screate_simple(has_columns(field.type) ? 2 : 1, extent.data(), nullptr), H5Sclose,
                     "make a shape");
  const Handle data(H5Dcreate2(file, field.name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT),
                    H5Dclose, "make a dataset");
  if (field.bytes.size() > 0)
    check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.bytes.data()), "write a dataset");
  const std::uint64_t sum = checksum_of(field);
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, "make a shape");
  const Handle note(H5Acreate2(data, "xxh3", H5T_STD_U64LE, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                    "make an attribute");
  check(H5Awrite(note, H5T_NATIVE_UINT64, &sum), "write an attribute");
}

/// The whole file in memory, after room for the head: so a disk that is full is told by the system's words,
/// and never by the library half way.
std::string file_of(const SavedState& state) {
  constexpr std::size_t most_overhead = 1 << 20;
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make settings");
  check(H5Pset_fapl_core(access, state.bytes() + most_overhead, false), "work in memory");
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make settings");
  check(H5Pset_create_intermediate_group(links, 1), "make groups");
  const Handle file(H5Fcreate("checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "make a file");
  for (const SavedField& field : state.fields) write_field(file, links, field);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "finish the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size < 0 ? -1 : 0, "finish the file");
  std::string bytes(head_bytes + static_cast<std::size_t>(size), ' ');
  check(H5Fget_file_image(file, bytes.data() + head_bytes, static_cast<std::size_t>(size)) < 0 ? -1 : 0,
        "finish the file");
  return bytes;
}

/// What the head says of the rest, in its own length.
std::string head_of(std::string_view rest) {
  return fmt::format("{}{:016x}\n", head_words, hash_of(rest.data(), rest.size()));
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::string bytes;
  if (stream) bytes.resize(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  stream.read(bytes.data(), std::ssize(bytes));
  if (!stream) throw RunError("cannot be read: " + std::string(std::strerror(errno)));
  return bytes;
}

FieldType read_type(hid_t data, hid_t type, int columns) {
  using Kind = FieldType::Kind;
  const int size = static_cast<int>(H5Tget_size(type));
  switch (H5Tget_class(type)) {
    case H5T_OPAQUE:
      return {Kind::bytes, 1, size};
    case H5T_FLOAT:
      return {Kind::real, size, columns};
    case H5T_INTEGER:
      return {H5Tget_sign(type) == H5T_SGN_2 ? Kind::integer : Kind::natural, size, columns};
    default:
      throw RunError(fmt::format("dataset {} is of a type that no state has", data));
  }
}

SavedField read_field(hid_t file, const char* name) {
  const Handle data(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "open a dataset");
  const Handle type(H5Dget_type(data), H5Tclose, "tell a type");
  const Handle space(H5Dget_space(data), H5Sclose, "tell a shape");
  std::array<hsize_t, 2> extent = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2) throw RunError(fmt::format("{} is no table", name));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  SavedField field{name, read_type(data, type, rank == 2 ? static_cast<int>(extent[1]) : 1), {}};
  field.bytes.resize(static_cast<std::int64_t>(extent[0]) * field.type.row());
  if (field.bytes.size() > 0)
    check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, field.bytes.data()), "read a dataset");
  std::uint64_t sum = 0;
  const Handle note(H5Aopen(data, "xxh3", H5P_DEFAULT), H5Aclose, "find a checksum");
  check(H5Aread(note, H5T_NATIVE_UINT64, &sum), "read a checksum");
  if (sum != checksum_of(field)) throw RunError(fmt::format("{} is damaged", name));
  return field;
}

herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

void write_checkpoint(const fs::path& file, const SavedState& state) {
  silence();
  std::string bytes = file_of(state);
  const std::string head = head_of(std::string_view(bytes).substr(head_bytes));
  std::ranges::copy(head, bytes.begin());
  write_file(file, bytes);
}

SavedState read_checkpoint(const fs::path& file) try {
  silence();
  {
    const std::string bytes = bytes_of(file);
    const std::string_view all = bytes;
    if (all.size() < head_bytes || !all.starts_with(head_words))
      throw RunError("is no checkpoint of this version");
    if (!all.starts_with(head_of(all.substr(head_bytes))))
      throw RunError("is damaged: its checksum is another");
  }
  const Handle in(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open the file");
  std::vector<std::string> names;
  check(H5Ovisit2(in, H5_INDEX_NAME, H5_ITER_NATIVE, note_dataset, &names, H5O_INFO_BASIC), "list datasets");
  SavedState state;
  for (const std::string& name : names) state.fields.push_back(read_field(in, name.c_str()));
  return state;
} catch (const RunError& error) {
  throw RunError(fmt::format("{}: {}", file.string(), error.what()));
}

std::vector<fs::path> CheckpointFolder::files() const {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder_, none)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  // Their numbers are as wide.
  std::ranges::sort(files, std::greater());
  return files;
}

void CheckpointFolder::add(std::int64_t step, const SavedState& state) const {
  constexpr std::size_t kept = 2;
  std::error_code error;
  fs::create_directory(folder_, error);
  if (error) throw RunError(fmt::format("cannot make {}: {}", folder_.string(), error.message()));
  write_checkpoint(folder_ / fmt::format("{:012}.h5", step), state);
  const std::vector<fs::path> all = files();
  for (std::size_t k = kept; k < all.size(); ++k) fs::remove(all[k], error);
}

std::optional<SavedState> CheckpointFolder::newest(std::vector<std::string>& damaged) const {
  for (const fs::path& file : files()) {
    try {
      return read_checkpoint(file);
    } catch (const RunError& error) {
      damaged.emplace_back(error.what());
    }
  }
  return std::nullopt;
}

void CheckpointFolder::clear() const {
  std::error_code error;
  fs::remove_all(folder_, error);
  if (error) throw RunError(fmt::format("cannot remove {}: {}", folder_.string(), error.message()));
}

}  // namespace scree
