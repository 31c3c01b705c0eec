#include "render/gl/visible.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scree::render::gl {

namespace {

constexpr float nothing = std::numeric_limits<float>::max();

// A grid of covered depths: each cell has the depth of the nearest body so far that hides all of the cell.
class CoverGrid {
 public:
  CoverGrid(int width, int height, float cell)
      : cell_(cell),
        width_(static_cast<int>(std::ceil(static_cast<float>(width) / cell))),
        height_(static_cast<int>(std::ceil(static_cast<float>(height) / cell))),
        depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), nothing) {}

  bool hides(const Disc& disc) const {
    // The disc is wider here, and narrower in cover(), by more than rounding can take away.
    const float x = disc.x / cell_, y = disc.y / cell_, radius = disc.outer / cell_ + 0.01f;
    const int first = first_cell(y - radius, height_), last = last_cell(y + radius, height_);
    for (int row = first; row <= last; ++row) {
      const auto low = static_cast<float>(row);
      const float aside = std::max({low - y, y - (low + 1), 0.0f});
      const float span = std::sqrt(std::max(radius * radius - aside * aside, 0.0f));
      const float* cells = &depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_)];
      const int end = last_cell(x + span, width_);
      for (int k = first_cell(x - span, width_); k <= end; ++k) {
        if (cells[k] >= disc.near) return false;
      }
    }
    return true;
  }

  void cover(const Disc& disc) {
    const float x = disc.x / cell_, y = disc.y / cell_, radius = disc.inner / cell_ - 0.01f;
    const int first = first_cell(y - radius, height_), last = last_cell(y + radius, height_);
    for (int row = first; row <= last; ++row) {
      const auto low = static_cast<float>(row);
      const float aside = std::max(y - low, low + 1 - y);
      if (aside >= radius) continue;
      const float span = std::sqrt(radius * radius - aside * aside);
      float* cells = &depth_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_)];
      const int end = last_cell(x + span - 1, width_);
      for (int k = first_cell(x - span + 1, width_); k <= end; ++k) cells[k] = std::min(cells[k], disc.far);
    }
  }

 private:
  // Cell numbers are clamped before they become integers, because discs may be far outside.
  static int first_cell(float x, int size) {
    return static_cast<int>(std::clamp(std::floor(x), 0.0f, static_cast<float>(size)));
  }
  static int last_cell(float x, int size) {
    return static_cast<int>(std::clamp(std::floor(x), -1.0f, static_cast<float>(size - 1)));
  }

  float cell_;
  int width_, height_;
  std::vector<float> depth_;  // depth of the body that covers the cell
};

// Returns some thousand values of a member of the discs, in ascending order.
std::vector<float> sorted_sample(const std::vector<Disc>& discs, float Disc::*member) {
  std::vector<float> values;
  for (std::size_t k = 0; k < discs.size(); k += 1 + discs.size() / 1024) values.push_back(discs[k].*member);
  std::sort(values.begin(), values.end());
  return values;
}

// Returns the width of a cell, so that the radius of a typical disc is about three cells. Fewer cells cover
// badly, more take longer.
float cell_for(const std::vector<Disc>& discs) {
  const std::vector<float> radii = sorted_sample(discs, &Disc::outer);
  return std::clamp(radii[radii.size() / 2] / 3, 1.0f, 16.0f);
}

// Returns the indices of the discs by ascending depth, to the resolution of 4096 classes. A few discs far off
// share the outer classes.
std::vector<std::int32_t> front_to_back(const std::vector<Disc>& discs) {
  constexpr int classes = 4096;
  const std::vector<float> depths = sorted_sample(discs, &Disc::far);
  const float low = depths[depths.size() / 64], high = depths[depths.size() - 1 - depths.size() / 64];
  const float scale = high > low ? (classes - 1) / (high - low) : 0;
  const auto class_of = [&](const Disc& disc) {
    return static_cast<std::size_t>(std::clamp((disc.far - low) * scale, 0.0f, classes - 1.0f));
  };
  std::array<std::int32_t, classes + 1> start{};
  for (const Disc& disc : discs) ++start[class_of(disc) + 1];
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  std::vector<std::int32_t> order(discs.size());
  for (std::size_t k = 0; k < discs.size(); ++k) {
    order[static_cast<std::size_t>(start[class_of(discs[k])]++)] = static_cast<std::int32_t>(k);
  }
  return order;
}

}  // namespace

std::vector<std::int32_t> visible_discs(const std::vector<Disc>& discs, int width, int height) {
  std::vector<std::int32_t> visible;
  if (discs.empty()) return visible;
  CoverGrid grid(width, height, cell_for(discs));
  for (const std::int32_t k : front_to_back(discs)) {
    const Disc& disc = discs[static_cast<std::size_t>(k)];
    if (grid.hides(disc)) continue;
    grid.cover(disc);
    visible.push_back(disc.body);
  }
  std::sort(visible.begin(), visible.end());
  return visible;
}

}  // namespace scree::render::gl
