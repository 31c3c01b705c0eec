// The time for which the boxes of the broad phase have room for the bodies' motion.
#pragma once

#include "core/archive.hpp"

namespace scree {

/// Chooses for how many substeps boxes shall last. Boxes that last longer are made less often, but they are
/// larger, and more pairs have to be looked at in each substep.
class BoxLife {
 public:
  /// Returns for how long new boxes shall have room (s). `now`: time of the run (s); `substep`: length of a
  /// substep, which is the shortest life (s); `rate`: mean speed at which the bodies leave the places or the
  /// paths around which the boxes are, in their smallest_size (1/s); `along`: their mean speed along these
  /// paths (1/s).
  double choose(double now, double substep, double rate, double along);
  /// Returns for how many substeps the last boxes should last.
  int planned() const { return planned_; }
  /// Must be called when impacts have sent bodies out of their boxes, so that the impacts have to be found
  /// again: the next boxes have more room.
  void make_room();
  /// Must be called when the boxes have to be made anew for another reason than that bodies have left them.
  void forget() { planned_ = 0; }

  void archive(Archive& archive) {
    archive("made", made_);
    archive("substep", substep_);
    archive("planned", planned_);
    archive("most", most_);
    archive("kept_in_a_row", kept_in_a_row_);
    archive("room", room_);
  }

 private:
  static constexpr int longest = 32;

  void judge(double lasted);
  double cost_of(int substeps, double travel, double along) const;

  double made_ = 0;        // when the last boxes were made (s)
  double substep_ = 0;     // length of a substep then (s)
  int planned_ = 0;        // number of substeps for which they should last; 0 if there are none
  int most_ = longest;     // largest number that may be chosen
  int kept_in_a_row_ = 0;  // number of boxes, up to the last, that have lasted as long as they should
  double room_ = 0.5;      // room for what impacts add to the bodies' travel, in substeps
};

}  // namespace scree
