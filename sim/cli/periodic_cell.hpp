// A periodic space as it is shown and written: its cell, in pictures with what sticks out of it at both ends.
#pragma once

#include "render/frame.hpp"

namespace scree::cli {

/// Moves every body of a periodic space to its image in the cell; boundaries stay.
void move_into_cell(BodyTable& bodies);

/// Draws bodies that reach through an end of the cell at the other one too. Lines and what the colours know
/// of bodies must be there already.
void append_images(render::Frame& frame);

}  // namespace scree::cli
