// The annotation of a picture: the legend of its colours, its time, and the width of the grid's cells.
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

/// The least height of a picture that has room for readable text (pixels).
inline constexpr int least_annotated_height = 240;

/// Returns about `count` round numbers in [low, high], low < high. They are 1, 2 or 5 times a power of ten
/// apart.
std::vector<double> round_ticks(double low, double high, int count);

/// Returns the least of the numbers 1, 2 or 5 times a power of ten that is not less than a positive value.
double rounded_up(double value);

/// Returns a length in words, in the unit that suits it: "0.5 m", "2 mm".
std::string length_words(double metres);

/// Returns a time in words, with enough digits that the times of frames `interval` (s) apart differ.
std::string time_words(double seconds, double interval);

/// Writes the annotation on pictures of one size. The same input gives the same bytes.
class Annotator {
 public:
  /// `interval` is the time between frames (s).
  Annotator(Annotation annotation, int picture_height, double interval);

  /// Annotates a picture. If bodies have values beyond an end of the scale, a sign at the tick label of that
  /// end shows it. Style::range must be set if the colours are a scale, Style::cell if there are planes.
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
