// A periodic space as it is shown and written: its cell, and in pictures also the bodies that reach through
// its ends, at both ends.
#pragma once

#include "render/frame.hpp"

namespace scree::cli {

/// Moves every body of a periodic space to its image in the cell; boundaries stay.
void move_into_cell(BodyTable& bodies);

/// Adds an image of each body that reaches through an end of the cell, at the other end. Lines, and the data
/// by which bodies are coloured, must be in the frame already.
void append_images(render::Frame& frame);

}  // namespace scree::cli
