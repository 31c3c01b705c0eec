// The reader of LAMMPS dumps that are text (LAMMPS manual, "dump command"). Their frames consist of items,
// the last of which, ATOMS, names the columns of its rows.
#pragma once

#include "sim/scene/frame_rows.hpp"

#include <array>

namespace scree {

class DumpRows final : public FrameRows {
 public:
  DumpRows(TextLines lines, std::optional<std::int64_t> frame, const Reader& reader);

 private:
  struct Head {
    Frame frame;
    std::string names;  ///< the line that names the columns
    SourceMark mark;    ///< start of this line
    std::string units;  ///< word after ITEM: UNITS; empty: not given
    std::array<double, 3> low{}, high{};
    bool is_oblique = false;  ///< the cell's edges are not along the axes
  };

  Head read_head();
  void read_box(Head& head);
  std::string_view next_value();
  void read_names(const Head& head);
  void add(const Cell& name, const Head& head);
  bool has(BodyColumn column) const;
};

}  // namespace scree
