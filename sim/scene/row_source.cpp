#include "sim/scene/row_source.hpp"

#include "sim/scene/csv_rows.hpp"
#include "sim/scene/dump_rows.hpp"
#include "sim/scene/scalar.hpp"
#include "sim/scene/xyz_rows.hpp"

#include <utility>

namespace scree {

std::unique_ptr<RowSource> open_rows(const std::filesystem::path& file, std::optional<std::int64_t> frame,
                                     const Reader& reader) {
  TextLines lines(file, reader);
  const std::string first(lines.next_filled() ? trimmed(lines.text()) : "");
  lines.go_to({});
  // The names of a table's columns never begin like these.
  if (first.starts_with("ITEM: ")) return std::make_unique<DumpRows>(std::move(lines), frame, reader);
  if (is_whole_number(first)) return std::make_unique<XyzRows>(std::move(lines), frame, reader);
  if (frame) reader.fail({1, 1}, "a table has no frames; leave `frame` out in the scene");
  return std::make_unique<CsvRows>(std::move(lines), reader);
}

}  // namespace scree
