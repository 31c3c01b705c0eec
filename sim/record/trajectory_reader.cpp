#include "sim/record/trajectory_reader.hpp"

#include "core/error.hpp"
#include "core/hash.hpp"
#include "sim/record/compressed.hpp"
#include "sim/record/plain_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view trailer_words = "scree trajectory 1, xxh3 and length of the lines before: ";
constexpr std::size_t trailer_bytes = trailer_words.size() + 16 + 1 + 15 + 1;

std::string last_line_of(std::string_view lines) {
  return fmt::format("{}{:016x} {:015}\n", trailer_words, hash_of(lines.data(), lines.size()), lines.size());
}

template <class T>
void append(std::span<const std::byte> bytes, std::vector<double>& numbers) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
    T number;
    std::memcpy(&number, bytes.data() + at, sizeof(T));
    numbers.push_back(static_cast<double>(number));
  }
}

void append(std::span<const std::byte> bytes, const FieldType& type, std::vector<double>& numbers) {
  using Kind = FieldType::Kind;
  if (type.kind == Kind::real && type.width == 4) return append<float>(bytes, numbers);
  if (type.kind == Kind::real && type.width == 8) return append<double>(bytes, numbers);
  if (type.kind == Kind::integer && type.width == 4) return append<std::int32_t>(bytes, numbers);
  if (type.kind == Kind::natural && type.width == 1) return append<std::uint8_t>(bytes, numbers);
  throw RunError("has numbers that no trajectory of this version has");
}

}  // namespace

std::string trajectory_trailer(const TrajectoryIndex& index) {
  const std::string lines = index.text();
  return lines + last_line_of(lines);
}

TrajectoryReader::TrajectoryReader(fs::path file)
    : file_(std::move(file)), stream_(file_, std::ios::binary), index_(read_index()) {}

TrajectoryIndex TrajectoryReader::read_index() try {
  std::error_code none;
  if (file_.has_parent_path() && !fs::exists(file_.parent_path(), none))
    throw InputError(fmt::format("{}: there is no such folder", file_.parent_path().string()));
  if (!fs::is_regular_file(file_, none))
    throw RunError(fs::exists(file_, none)
                       ? "is no file"
                       : "there is none; run the scene with record.trajectory: true to have one");
  const auto size = static_cast<std::int64_t>(fs::file_size(file_, none));
  std::string trailer(trailer_bytes, '\0');
  stream_.seekg(size - std::ssize(trailer));
  if (!stream_.read(trailer.data(), std::ssize(trailer)) || !trailer.starts_with(trailer_words))
    throw RunError("is no trajectory of this version");
  std::string_view words = std::string_view(trailer).substr(trailer_words.size());
  words.remove_suffix(1);
  take_word(words);
  const std::int64_t before = size - std::ssize(trailer);
  std::string lines(static_cast<std::size_t>(take_number(words, 0, before)), '\0');
  stream_.seekg(before - std::ssize(lines));
  if (!stream_.read(lines.data(), std::ssize(lines)))
    throw RunError(fmt::format("cannot be read: {}", std::strerror(errno)));
  if (trailer != last_line_of(lines)) throw RunError("is damaged: the checksum of its index is wrong");
  return TrajectoryIndex::parse(lines, before - std::ssize(lines));
} catch (const RunError& error) {
  throw InputError(fmt::format("{}: {}", file_.string(), error.what()));
}

int TrajectoryReader::column(std::string_view name) const {
  const auto& columns = index_.columns();
  const auto found = std::ranges::find(columns, name, &TrajectoryColumn::name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

std::vector<double> TrajectoryReader::numbers(std::size_t frame, std::size_t column) try {
  const FieldType& type = index_.columns()[column].type;
  const std::int64_t rows = index_.frames()[frame].rows;
  std::vector<double> numbers;
  std::vector<std::byte> bytes(static_cast<std::size_t>(index_.chunk_rows() * type.row()));
  std::vector<std::byte> packed;
  for (std::int64_t k = 0; k < index_.chunks_for(rows); ++k) {
    const TrajectoryChunk& chunk =
        index_.chunks()[static_cast<std::size_t>(index_.first_chunk(frame, column) + k)];
    packed.resize(static_cast<std::size_t>(chunk.bytes));
    stream_.seekg(chunk.place);
    if (!stream_.read(reinterpret_cast<char*>(packed.data()), chunk.bytes))
      throw RunError(fmt::format("cannot be read: {}", std::strerror(errno)));
    decompress(packed, type.width, bytes);
    append(bytes, type, numbers);
  }
  numbers.resize(static_cast<std::size_t>(rows * type.columns));
  return numbers;
} catch (const RunError& error) {
  throw InputError(fmt::format("{}: {}", file_.string(), error.what()));
}

}  // namespace scree
