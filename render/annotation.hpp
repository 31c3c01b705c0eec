// What is written on a picture: the legend of its colours, its time, the width of the grid's cells.
#pragma once

#include "render/coloring.hpp"
#include "render/image.hpp"
#include "render/renderer.hpp"
#include "render/text.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scree::render {

struct Annotation {
  bool legend = true;
  bool time_stamp = true;
};

/// Pictures less high than this have no room for text that can be read (pixels).
inline constexpr int least_annotated_height = 240;

/// Round numbers, 1, 2 or 5 times a power of ten apart, in [low, high], low < high: about `count` of them.
std::vector<double> round_ticks(double low, double high, int count);

/// 1, 2 or 5 times a power of ten: the nearest one that is not less than a positive value.
double rounded_up(double value);

/// A length in words, with the unit that suits it: "0.5 m", "2 mm".
std::string length_words(double metres);

/// A time in words, with so many digits that frames `interval` (s) apart differ.
std::string time_words(double seconds, double interval);

/// Writes on pictures of one size. The same input gives the same bytes.
class Annotator {
 public:
  /// `interval`: time between frames (s).
  Annotator(Annotation annotation, int picture_height, double interval);

  /// Values beyond the scale's ends are told by a sign at its tick labels. Style::range must be set where the
  /// colours are a scale, Style::cell where there are planes.
  void annotate(Image& image, const Frame& frame, const Style& style) const;

 private:
  void draw_scale(Image& image, const Frame& frame, const Style& style) const;
  void draw_kinds(Image& image, const Frame& frame, const Style& style) const;
  void draw_note(Image& image, const std::string& words) const;

  Annotation annotation_;
  Font font_;
  double interval_;
};

}  // namespace scree::render
