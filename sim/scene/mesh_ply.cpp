// The reader of PLY files (Turk 1994): the elements `vertex` and `face`, as text or binary in either byte
// order.
#include "sim/scene/mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

namespace scree {
namespace {

enum class Number { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Number> number_called(std::string_view name) {
  using N = Number;
  constexpr std::pair<std::string_view, Number> names[] = {
      {"char", N::int8},     {"int8", N::int8},       {"uchar", N::uint8},    {"uint8", N::uint8},
      {"short", N::int16},   {"int16", N::int16},     {"ushort", N::uint16},  {"uint16", N::uint16},
      {"int", N::int32},     {"int32", N::int32},     {"uint", N::uint32},    {"uint32", N::uint32},
      {"float", N::float32}, {"float32", N::float32}, {"double", N::float64}, {"float64", N::float64}};
  for (const auto& [known, number] : names)
    if (known == name) return number;
  return {};
}

struct Property {
  std::string name;
  Number type;
  std::optional<Number> count;  ///< type of the length if the property is a list
};

struct Element {
  std::string name;
  std::int64_t count;
  std::vector<Property> properties;
};

enum class Form { text, little_endian, big_endian };

struct Header {
  Form form;
  std::vector<Element> elements;
};

class HeaderReader {
 public:
  explicit HeaderReader(MeshSource& source) : source_(source) {}

  Header read() {
    // Lines of the header must end as the first one does, because binary numbers after it may begin with a
    // \n.
    const std::string_view end = line_end(source_.rest());
    std::string_view line;
    if (!source_.next_line(line, end) || Words(line).next() != "ply")
      source_.fail("does not begin with `ply`");
    std::optional<Form> form;
    while (source_.next_line(line, end)) {
      Words words(line);
      const std::string_view kind = words.next();
      if (kind == "end_header") {
        if (!form) source_.fail_in_line("the header has no `format`");
        return {*form, std::move(elements_)};
      }
      if (kind == "format")
        form = read_form(words);
      else if (kind == "element")
        read_element(words);
      else if (kind == "property")
        read_property(words);
      else if (!kind.empty() && kind != "comment" && kind != "obj_info")
        source_.fail_in_line(fmt::format("`{}` is no word of a PLY header", excerpt(kind)));
    }
    source_.fail("ends within its header");
  }

 private:
  Form read_form(Words& words) const {
    const std::string_view word = words.next();
    if (word == "ascii") return Form::text;
    if (word == "binary_little_endian") return Form::little_endian;
    if (word == "binary_big_endian") return Form::big_endian;
    source_.fail_in_line(fmt::format(
        "the format must be one of ascii, binary_little_endian, binary_big_endian, not `{}`", excerpt(word)));
  }

  void read_element(Words& words) {
    const std::string_view name = words.next(), digits = words.next();
    std::int64_t count = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
    if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || count < 0)
      source_.fail_in_line(fmt::format("an element needs a name and a number, not `{}`", excerpt(digits)));
    elements_.push_back({std::string(name), count, {}});
  }

  void read_property(Words& words) {
    if (elements_.empty()) source_.fail_in_line("a property must follow its element");
    std::string_view type = words.next();
    std::optional<Number> count;
    if (type == "list") {
      count = type_called(words.next());
      if (*count == Number::float32 || *count == Number::float64)
        source_.fail_in_line("the length of a list must be an integer");
      type = words.next();
    }
    const Number number = type_called(type);
    elements_.back().properties.push_back({std::string(words.next()), number, count});
  }

  Number type_called(std::string_view name) const {
    const std::optional<Number> number = number_called(name);
    if (!number) source_.fail_in_line(fmt::format("`{}` is no type of PLY", excerpt(name)));
    return *number;
  }

  MeshSource& source_;
  std::vector<Element> elements_;
};

/// The reader of the numbers after the header, one after another.
class Numbers {
 public:
  Numbers(MeshSource& source, Form form) : source_(source), form_(form) {}

  double next(Number type) {
    if (form_ == Form::text) return source_.number(word());
    switch (type) {
      case Number::int8:
        return take<std::int8_t>();
      case Number::uint8:
        return take<std::uint8_t>();
      case Number::int16:
        return take<std::int16_t>();
      case Number::uint16:
        return take<std::uint16_t>();
      case Number::int32:
        return take<std::int32_t>();
      case Number::uint32:
        return take<std::uint32_t>();
      case Number::float32:
        return take<float>();
      case Number::float64:
        break;
    }
    return take<double>();
  }

  [[noreturn]] void fail(std::string_view what) const {
    form_ == Form::text ? source_.fail_in_line(what) : source_.fail(what);
  }

 private:
  std::string_view word() {
    std::string_view line;
    for (std::string_view word = words_.next();; word = words_.next()) {
      if (!word.empty()) return word;
      if (!source_.next_line(line)) source_.fail(ended);
      words_ = Words(line);
    }
  }

  template <class T>
  T take() {
    std::array<char, sizeof(T)> bytes;
    const std::string_view rest = source_.rest();
    if (rest.size() < bytes.size()) source_.fail(ended);
    std::copy_n(rest.begin(), bytes.size(), bytes.begin());
    static_assert(std::endian::native == std::endian::little);
    if (form_ == Form::big_endian) std::ranges::reverse(bytes);
    source_.skip(bytes.size());
    return std::bit_cast<T>(bytes);
  }

  static constexpr const char* ended = "ends before all that its header says";

  MeshSource& source_;
  Form form_;
  Words words_{{}};
};

class BodyReader {
 public:
  BodyReader(MeshSource& source, const Header& header, MeshMaker& mesh)
      : numbers_(source, header.form), source_(source), mesh_(mesh) {}

  void read(const Element& element) {
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    for (std::int64_t k = 0; k < element.count && !element.properties.empty(); ++k)
      for (const Property& property : element.properties) skip(property);
    if (element.count > 0)
      mesh_.warn(fmt::format("its {} elements `{}` are skipped, which are neither vertices nor faces",
                             element.count, excerpt(element.name)));
  }

 private:
  void read_vertices(const Element& element) {
    constexpr std::array names = {"x", "y", "z"};
    for (const char* name : names)
      if (std::ranges::none_of(element.properties,
                               [&](const Property& p) { return p.name == name && !p.count; }))
        source_.fail(fmt::format("its vertices have no property `{}`", name));
    for (std::int64_t k = 0; k < element.count; ++k) {
      Vec3 place = Vec3::Zero();
      for (const Property& property : element.properties) {
        const auto axis = std::ranges::find(names, property.name) - names.begin();
        if (property.count || axis == std::ssize(names)) {
          skip(property);
          continue;
        }
        place[axis] = numbers_.next(property.type);
        if (!std::isfinite(place[axis])) numbers_.fail(fmt::format("vertex {} is at no finite place", k));
      }
      vertices_.push_back(mesh_.vertex(place));
    }
  }

  void read_faces(const Element& element) {
    const auto is_corners = [](const Property& p) {
      return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::ranges::none_of(element.properties, is_corners))
      source_.fail("its faces have no list `vertex_indices`");
    std::vector<int> corners;
    for (std::int64_t k = 0; k < element.count; ++k) {
      for (const Property& property : element.properties) {
        if (!is_corners(property)) {
          skip(property);
          continue;
        }
        corners.clear();
        for (std::int64_t left = length(property); left > 0; --left)
          corners.push_back(corner(numbers_.next(property.type), k));
        if (corners.size() < 3) numbers_.fail(fmt::format("face {} has less than three vertices", k));
        mesh_.polygon(corners);
      }
    }
  }

  int corner(double index, std::int64_t face) const {
    if (!(index >= 0 && index < static_cast<double>(vertices_.size())) || index != std::floor(index))
      numbers_.fail(fmt::format("face {} has the vertex {}, of {} from 0 on", face, index, vertices_.size()));
    return vertices_[static_cast<std::size_t>(index)];
  }

  std::int64_t length(const Property& list) {
    const double length = numbers_.next(*list.count);
    constexpr double most = 4294967295.0;
    if (!(length >= 0 && length <= most) || length != std::floor(length))
      numbers_.fail(fmt::format("a list cannot have the length {}", length));
    return static_cast<std::int64_t>(length);
  }

  void skip(const Property& property) {
    for (std::int64_t left = property.count ? length(property) : 1; left > 0; --left)
      numbers_.next(property.type);
  }

  Numbers numbers_;
  MeshSource& source_;
  MeshMaker& mesh_;
  std::vector<int> vertices_;
};

}  // namespace

void read_ply(MeshSource& source, MeshMaker& mesh) {
  const Header header = HeaderReader(source).read();
  BodyReader body(source, header, mesh);
  for (const Element& element : header.elements) body.read(element);
  if (header.form != Form::text && !source.rest().empty())
    mesh.warn(fmt::format("{} bytes after the last of its elements are skipped", source.rest().size()));
}

}  // namespace scree
