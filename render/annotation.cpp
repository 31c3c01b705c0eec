#include "render/annotation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree::render {

namespace {

const Color ink(0.13f, 0.14f, 0.16f);
const Color paper(0.97f, 0.97f, 0.97f);
constexpr float paper_opacity = 0.72f;

std::string title_of(ColorBy color_by) {
  switch (color_by) {
    case ColorBy::speed:
      return "speed (m/s)";
    case ColorBy::size:
      return "radius (m)";
    case ColorBy::kinetic_energy:
      return "kinetic energy (J)";
    case ColorBy::force:
      return "contact force (N)";
    case ColorBy::material:
      return "material";
    case ColorBy::level:
      return "grid level";
    case ColorBy::id:
      break;
  }
  return "";
}

struct Clipped {
  bool below = false, above = false;
};

Clipped clipped_by(const std::array<double, 2>& range, const Frame& frame, ColorBy color_by) {
  Clipped clipped;
  const BodyTable& bodies = frame.snapshot.bodies;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (!is_colored(bodies, k)) continue;
    const double value = value_of(frame, color_by, k);
    clipped.below |= value < range[0];
    clipped.above |= value > range[1];
  }
  return clipped;
}

// Returns round values and the two ends of the range, all of them at least `least_apart` from one another.
std::vector<double> ticks_with_ends(double low, double high, double least_apart) {
  std::vector<double> ticks = {low};
  for (const double tick : round_ticks(low, high, 5)) {
    if (tick - low >= least_apart && high - tick >= least_apart) ticks.push_back(tick);
  }
  ticks.push_back(high);
  return ticks;
}

bool has_plane(const BodyTable& bodies) {
  return std::find(bodies.shape.begin(), bodies.shape.end(), Shape::plane) != bodies.shape.end();
}

}  // namespace

double rounded_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<double> round_ticks(double low, double high, int count) {
  const double step = rounded_up((high - low) / count);
  std::vector<double> ticks;
  const double tolerance = 1e-6 * step;
  for (double k = std::ceil((low - tolerance) / step); k * step <= high + tolerance; ++k) {
    ticks.push_back(k * step + 0.0);  // + 0: no negative zero
  }
  return ticks;
}

std::string length_words(double metres) {
  struct Unit {
    double metres;
    const char* name;
  };
  for (const Unit& unit : {Unit{1e3, "km"}, Unit{1, "m"}, Unit{1e-3, "mm"}, Unit{1e-6, "µm"}}) {
    // A tenth of a metre reads better than a hundred millimetres.
    if (metres >= 0.0999 * unit.metres) return fmt::format("{:.3g} {}", metres / unit.metres, unit.name);
  }
  return fmt::format("{:.3g} m", metres);
}

std::string time_words(double seconds, double interval) {
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(interval) - 1e-9)), 0, 9);
  return fmt::format("{:.{}f} s", seconds, digits);
}

Annotator::Annotator(Annotation annotation, int picture_height, double interval)
    : annotation_(annotation), font_(std::max(picture_height / 42, 11)), interval_(interval) {}

void Annotator::annotate(Image& image, const Frame& frame, const Style& style) const {
  std::string note;
  if (annotation_.time_stamp) note = "t = " + time_words(frame.snapshot.time, interval_);
  if (annotation_.legend && style.cell && has_plane(frame.snapshot.bodies)) {
    note += (note.empty() ? "" : "    ") + ("grid " + length_words(*style.cell));
  }
  if (!note.empty()) draw_note(image, note);
  if (!annotation_.legend) return;
  if (is_scale(style.color_by)) {
    draw_scale(image, frame, style);
  } else if (frame.kinds.size() > 1) {
    draw_kinds(image, frame, style);
  }
}

// Draws the time and the width of the grid's cells in the lower left corner.
void Annotator::draw_note(Image& image, const std::string& words) const {
  const int em = font_.size();
  fill(image, em, image.height - 3 * em, font_.width(words) + em, 2 * em, paper, paper_opacity);
  font_.draw(image, em + em / 2, image.height - em - 5 * em / 8, words, ink);
}

// Draws the colour scale at the right edge: a bar, with ticks and their values beside it.
void Annotator::draw_scale(Image& image, const Frame& frame, const Style& style) const {
  const auto [low, high] = *style.range;
  const Clipped clipped = clipped_by(*style.range, frame, style.color_by);
  const std::string title = title_of(style.color_by);
  const int em = font_.size(), bar_width = em, bar_height = 12 * em;
  const double least_apart = 1.4 * em / bar_height * (high - low);
  const std::vector<double> ticks = ticks_with_ends(low, high, least_apart);
  int label_width = font_.width(title) - bar_width - em / 2;
  const auto label_of = [&](double tick, bool first, bool last) {
    const char* sign = last && clipped.above ? "≥ " : first && clipped.below ? "≤ " : "";
    return sign + fmt::format("{:.3g}", tick);
  };
  // The label has room for the sign whether there is one or not, so that nothing moves from frame to frame.
  for (const double tick : ticks) {
    label_width = std::max(label_width, font_.width("≥ " + fmt::format("{:.3g}", tick)));
  }
  const int width = bar_width + em / 2 + label_width + em;
  const int left = image.width - em - width, top = em;
  fill(image, left, top, width, bar_height + 4 * em, paper, paper_opacity);
  font_.draw(image, left + em / 2, top + 11 * em / 8, title, ink);
  const int bar_left = left + em / 2, bar_top = top + 5 * em / 2;
  for (int y = 0; y < bar_height; ++y) {
    const double t = 1 - (y + 0.5) / bar_height;
    fill(image, bar_left, bar_top + y, bar_width, 1, srgb_of(scale_color(t)));
  }
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const int y = bar_top + static_cast<int>(std::lround((1 - (ticks[k] - low) / (high - low)) * bar_height));
    fill(image, bar_left + bar_width, y, em / 4, std::max(em / 14, 1), ink);
    font_.draw(image, bar_left + bar_width + em / 2, y + 3 * em / 8,
               label_of(ticks[k], k == 0, k + 1 == ticks.size()), ink);
  }
}

// Draws the list of kinds at the right edge: a square of each colour, with the name of its kind.
void Annotator::draw_kinds(Image& image, const Frame& frame, const Style& style) const {
  // More rows would fill the picture; the kinds that are left out are counted in the last row.
  constexpr std::size_t most = 12;
  const std::vector<Color>& palette =
      style.color_by == ColorBy::material ? style.palette : category_palette();
  const std::size_t shown = std::min(frame.kinds.size(), most);
  std::vector<std::string> rows(frame.kinds.begin(),
                                frame.kinds.begin() + static_cast<std::ptrdiff_t>(shown));
  if (shown < frame.kinds.size()) rows.push_back(fmt::format("and {} more", frame.kinds.size() - shown));
  const std::string title = title_of(style.color_by);
  const int em = font_.size(), line = 3 * em / 2;
  int label_width = font_.width(title) - line;
  for (const std::string& row : rows) label_width = std::max(label_width, font_.width(row));
  const int width = em + line + label_width;
  const int left = image.width - em - width, top = em;
  fill(image, left, top, width, line * (static_cast<int>(rows.size()) + 1) + em / 2, paper, paper_opacity);
  font_.draw(image, left + em / 2, top + 11 * em / 8, title, ink);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int base = top + 11 * em / 8 + line * (static_cast<int>(k) + 1);
    if (k < shown && !palette.empty())
      fill(image, left + em / 2, base - 7 * em / 8, em, em, palette[k % palette.size()]);
    font_.draw(image, left + em / 2 + line, base, rows[k], ink);
  }
}

}  // namespace scree::render
