#include "sim/record/vtk_poly_data.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace scree {

namespace {

template <class T>
void append_bytes(std::string& bytes, const std::vector<double>& numbers) {
  for (const double number : numbers) {
    const auto value = static_cast<T>(number);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
}

/// Appends the length of the numbers, and the numbers in the type, to the block. Returns VTK's name for the
/// type.
std::string_view append_block(std::string& block, const std::vector<double>& numbers, const FieldType& type) {
  using Kind = FieldType::Kind;
  const std::uint64_t bytes = numbers.size() * static_cast<std::uint64_t>(type.width);
  block.append(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
  if (type.kind == Kind::natural) return append_bytes<std::uint8_t>(block, numbers), "UInt8";
  if (type.kind == Kind::integer && type.width == 8)
    return append_bytes<std::int64_t>(block, numbers), "Int64";
  if (type.kind == Kind::integer) return append_bytes<std::int32_t>(block, numbers), "Int32";
  if (type.width == 4) return append_bytes<float>(block, numbers), "Float32";
  return append_bytes<double>(block, numbers), "Float64";
}

/// Describes arrays in XML, and collects their numbers in a block that follows.
class Writer {
 public:
  void add(std::string_view name, const FieldType& type, const std::vector<double>& numbers) {
    const std::size_t offset = block_.size();
    const std::string_view word = append_block(block_, numbers, type);
    fmt::format_to(
        std::back_inserter(text_),
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        word, name, type.columns, offset);
  }
  void add(const VtkPolyData::Array& array) { add(array.name, array.type, array.numbers); }
  void add(std::string_view section, const std::vector<VtkPolyData::Array>& arrays) {
    if (arrays.empty()) return;
    open(section);
    for (const VtkPolyData::Array& array : arrays) add(array);
    close(section);
  }
  void open(std::string_view section) { fmt::format_to(std::back_inserter(text_), "<{}>\n", section); }
  void close(std::string_view section) { fmt::format_to(std::back_inserter(text_), "</{}>\n", section); }
  void say(std::string_view text) { text_ += text; }
  std::string finish() {
    text_ += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    return std::move(text_) + block_ + "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string text_, block_;
};

constexpr FieldType index_type{FieldType::Kind::integer, sizeof(std::int64_t), 1};

}  // namespace

void VtkPolyData::add_cell(std::span<const std::int64_t> of_points) {
  for (const std::int64_t point : of_points) connectivity.push_back(static_cast<double>(point));
  offsets.push_back(static_cast<double>(connectivity.size()));
}

std::string VtkPolyData::text() const {
  const auto count = [this](Kind of) { return kind == of ? offsets.size() : 0; };
  Writer out;
  out.say(fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" "
      "NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
      points.numbers.size() / 3, count(Kind::vertices), count(Kind::lines), count(Kind::polygons)));
  out.add("PointData", point_data);
  out.add("CellData", cell_data);
  out.open("Points");
  out.add(points);
  out.close("Points");
  const char* cells = kind == Kind::vertices ? "Verts" : kind == Kind::lines ? "Lines" : "Polys";
  out.open(cells);
  out.add("connectivity", index_type, connectivity);
  out.add("offsets", index_type, offsets);
  out.close(cells);
  return out.finish();
}

}  // namespace scree
