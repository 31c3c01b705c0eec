#include "core/archive.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace scree {

const SavedField* SavedState::find(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, &SavedField::name);
  return found == fields.end() ? nullptr : &*found;
}

std::size_t SavedState::bytes() const {
  std::size_t sum = 0;
  for (const SavedField& field : fields) sum += static_cast<std::size_t>(field.bytes.size());
  return sum;
}

void Archive::operator()(const char* name, std::string& text) {
  std::vector<char> letters(text.begin(), text.end());
  (*this)(name, letters);
  text.assign(letters.begin(), letters.end());
}

const SavedField& Archive::field_of(const char* name, const FieldType& type, std::int64_t rows) const {
  const SavedField* field = from_->find(prefix_ + name);
  if (field == nullptr)
    throw InputError("the saved state has no '" + prefix_ + name + "': it is of another version or scene");
  expect(field->type == type && (rows < 0 || field->rows() == rows), name);
  return *field;
}

void Archive::expect(bool holds, const char* name) const {
  if (!holds)
    throw InputError("the saved state has '" + prefix_ + name +
                     "' of another kind or length: it is of another version or scene");
}

}  // namespace scree
