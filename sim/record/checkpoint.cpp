#include "sim/record/checkpoint.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "core/space.hpp"
#include "sim/record/files.hpp"
#include "sim/record/hdf5.hpp"
#include "sim/record/plain_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t first_line_bytes = checkpoint_head.size() + 17;

using hdf5::check;
using hdf5::Handle;

bool has_columns(const FieldType& type) { return type.kind != FieldType::Kind::bytes && type.columns > 1; }

std::uint64_t checksum_of(const SavedField& field) {
  return hash_of(field.bytes.data(), static_cast<std::size_t>(field.bytes.size()));
}

/// Writes a field. Returns the position of its bytes in the file; 0 if it has none.
haddr_t write_field(hid_t file, hid_t links, const SavedField& field) {
  const std::array<hsize_t, 2> extent = {static_cast<hsize_t>(field.rows()),
                                         static_cast<hsize_t>(field.type.columns)};
  const Handle type = hdf5::type_of(field.type);
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
  return field.bytes.size() > 0 ? H5Dget_offset(data) : 0;
}

std::string first_line_of(std::string_view rest) {
  return fmt::format("{}{:016x}\n", checkpoint_head, hash_of(rest.data(), rest.size()));
}

/// Returns the directory, with a line for each field. The lengths of the lines do not depend on `head`, the
/// number of bytes before the HDF5 part.
std::string directory_of(const SavedState& state, const std::vector<haddr_t>& places, std::size_t head) {
  std::string lines;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& [name, type, bytes] = state.fields[k];
    fmt::format_to(std::back_inserter(lines), "{} {} {:015} {}\n", words_of(type), state.fields[k].rows(),
                   places[k] + head, name);
  }
  return lines + '\n';
}

/// Returns the whole file. It is made in memory, so that a full disk is reported in the words of the system,
/// and never by the library half way.
std::string file_of(const SavedState& state) {
  const hdf5::Session session;
  constexpr std::size_t most_overhead = 1 << 20;
  constexpr std::size_t least_head = 512;  // HDF5's readers look there, and at every larger power of two
  const std::size_t most = state.bytes() + most_overhead;
  // The library does not always check whether it was given memory, so the memory for it and for the copy is
  // taken once before.
  Host::deallocate(Host::allocate(2 * most));
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make settings");
  check(H5Pset_fapl_core(access, most, false), "work in memory");
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make settings");
  check(H5Pset_create_intermediate_group(links, 1), "make groups");
  const Handle file(H5Fcreate("checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "make a file");
  std::vector<haddr_t> places;
  for (const SavedField& field : state.fields) places.push_back(write_field(file, links, field));
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "finish the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size < 0 ? -1 : 0, "finish the file");
  const std::size_t head =
      std::bit_ceil(std::max(first_line_bytes + directory_of(state, places, 0).size(), least_head));
  std::string bytes(head + static_cast<std::size_t>(size), ' ');
  std::ranges::copy(directory_of(state, places, head), bytes.begin() + first_line_bytes);
  check(H5Fget_file_image(file, bytes.data() + head, static_cast<std::size_t>(size)) < 0 ? -1 : 0,
        "finish the file");
  std::ranges::copy(first_line_of(std::string_view(bytes).substr(first_line_bytes)), bytes.begin());
  return bytes;
}

std::string bytes_of(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) throw RunError("is no file");
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::string bytes;
  if (stream) bytes.resize(static_cast<std::size_t>(stream.tellg()));
  stream.seekg(0);
  stream.read(bytes.data(), std::ssize(bytes));
  if (!stream) throw RunError("cannot be read: " + std::string(std::strerror(errno)));
  return bytes;
}

/// Returns the field that a line of the directory describes, with its bytes from the file.
SavedField field_of(std::string_view line, std::string_view file) {
  const auto size = std::ssize(file);
  SavedField field{{}, take_type(line), {}};
  const std::int64_t bytes = take_number(line, 0, size / field.type.row()) * field.type.row();
  const std::int64_t place = take_number(line, 0, size - bytes);
  field.name = line;
  field.bytes.resize(bytes);
  std::ranges::copy(
      std::as_bytes(std::span(file.substr(static_cast<std::size_t>(place), static_cast<std::size_t>(bytes)))),
      field.bytes.data());
  return field;
}

/// Returns the fields that the directory describes. The HDF5 part is not read, since HDF5 does not check
/// input that may be hostile.
SavedState state_of(std::string_view file) {
  SavedState state;
  std::int64_t left = std::ssize(file);  // a byte belongs to at most one field
  for (std::size_t at = first_line_bytes;;) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos) throw RunError("is not valid: its directory has no end");
    if (end == at) return state;
    state.fields.push_back(field_of(file.substr(at, end - at), file));
    at = end + 1;
    left -= state.fields.back().bytes.size();
    if (left < 0) throw RunError("is not valid: its fields have more bytes than the file");
  }
}

}  // namespace

void prepare_checkpoints() {
  SavedState little;
  Archive archive = Archive::saving(little);
  double number = 0;
  archive("number", number);
  file_of(little);
}

void write_checkpoint(const fs::path& file, const SavedState& state) { write_file(file, file_of(state)); }

SavedState read_checkpoint(const fs::path& file) try {
  const std::string bytes = bytes_of(file);
  const std::string_view all = bytes;
  if (all.size() < first_line_bytes || !all.starts_with(checkpoint_head))
    throw RunError("is no checkpoint of this version of scree");
  if (!all.starts_with(first_line_of(all.substr(first_line_bytes))))
    throw RunError("is damaged: its checksum is wrong");
  return state_of(all);
} catch (const RunError& error) {
  throw RunError(fmt::format("{}: {}", file.string(), error.what()));
}

std::vector<fs::path> CheckpointFolder::files() const {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder_, none)) {
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  }
  // The names sort by their numbers, which all have the same width.
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
