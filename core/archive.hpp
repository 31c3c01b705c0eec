// The state that a run saves to go on later as if it had never stopped. Each part names its fields once, in
// archive(), for saving and for loading.
#pragma once

#include "core/array.hpp"
#include "core/math.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace scree {

/// The type of a field: rows of `columns` numbers, each `width` bytes wide. A record that is not a number
/// counts as one column for each of its bytes.
struct FieldType {
  enum class Kind : std::uint8_t { integer, natural, real, bytes };

  Kind kind;
  int width;
  int columns;

  int row() const { return width * columns; }  ///< size of a row (bytes)
  friend bool operator==(const FieldType&, const FieldType&) = default;
};

template <class T>
constexpr FieldType field_type_of() {
  using Kind = FieldType::Kind;
  constexpr int size = static_cast<int>(sizeof(T));
  if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, Quat>) {
    return {Kind::real, sizeof(double), size / static_cast<int>(sizeof(double))};
  } else if constexpr (std::is_enum_v<T>) {
    return field_type_of<std::underlying_type_t<T>>();
  } else if constexpr (std::is_floating_point_v<T>) {
    return {Kind::real, size, 1};
  } else if constexpr (std::is_integral_v<T>) {
    return {std::is_signed_v<T> ? Kind::integer : Kind::natural, size, 1};
  } else {
    return {Kind::bytes, 1, size};
  }
}

/// One saved field, on Host.
struct SavedField {
  std::string name;  ///< path through the parts that hold it, and its own name: contacts/slots/color
  FieldType type;
  Array<std::byte, Host> bytes;

  std::int64_t rows() const { return bytes.size() / type.row(); }
};

struct SavedState {
  std::vector<SavedField> fields;

  /// Returns null if there is no field with that name.
  const SavedField* find(std::string_view name) const;
  std::size_t bytes() const;
};

/// Visits the fields of one part after the other, and saves or loads them. The names within a part are
/// unique. Throws InputError if a state to be loaded lacks a field, or has it with another type.
class Archive {
 public:
  static Archive saving(SavedState& to) { return {&to, nullptr}; }
  static Archive loading(const SavedState& from) { return {nullptr, &from}; }
  bool is_loading() const { return from_ != nullptr; }

  /// Saves or loads a number or a record, which is copied as bytes.
  template <class T>
  void operator()(const char* name, T& value) {
    if (is_loading()) {
      const SavedField& field = field_of(name, field_type_of<T>(), 1);
      if constexpr (std::is_same_v<T, bool>) expect(*field.bytes.data() <= std::byte{1}, name);
      load<Host>(&value, field);
    } else {
      save<Host>(name, &value, 1);
    }
  }
  template <class T, class Space>
  void operator()(const char* name, Array<T, Space>& array) {
    if (is_loading()) {
      const SavedField& field = field_of(name, field_type_of<T>(), -1);
      array.resize(field.rows());
      load<Space>(array.data(), field);
    } else {
      save<Space>(name, array.data(), array.size());
    }
  }
  template <class T>
  void operator()(const char* name, std::vector<T>& list) {
    if (is_loading()) {
      const SavedField& field = field_of(name, field_type_of<T>(), -1);
      list.resize(static_cast<std::size_t>(field.rows()));
      load<Host>(list.data(), field);
    } else {
      save<Host>(name, list.data(), static_cast<std::int64_t>(list.size()));
    }
  }
  void operator()(const char* name, std::string& text);

  /// Throws InputError with the name of a loaded field unless the field's contents are valid (`holds`).
  void expect(bool holds, const char* name) const;

  /// Saves or loads all fields that part.archive(*this, more...) names.
  template <class Part, class... More>
  void part(const char* name, Part& part, More&&... more) {
    const std::size_t outside = prefix_.size();
    prefix_ += name;
    prefix_ += '/';
    part.archive(*this, more...);
    prefix_.resize(outside);
  }

 private:
  Archive(SavedState* to, const SavedState* from) : to_(to), from_(from) {}

  template <class Space, class T>
  void save(const char* name, const T* data, std::int64_t count) {
    SavedField field{prefix_ + name, field_type_of<T>(), {}};
    field.bytes.resize(count * static_cast<std::int64_t>(sizeof(T)));
    copy_bytes<Host, Space>(field.bytes.data(), data, static_cast<std::size_t>(field.bytes.size()));
    to_->fields.push_back(std::move(field));
  }
  template <class Space, class T>
  static void load(T* data, const SavedField& field) {
    copy_bytes<Space, Host>(data, field.bytes.data(), static_cast<std::size_t>(field.bytes.size()));
  }
  /// `rows` is the number of rows that the field must have; -1 allows any number.
  const SavedField& field_of(const char* name, const FieldType& type, std::int64_t rows) const;

  SavedState* to_;
  const SavedState* from_;
  std::string prefix_;
};

}  // namespace scree
