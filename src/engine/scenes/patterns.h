// Images computed from integer hashes: tileable, the same on every machine.
#pragma once

#include <functional>
#include <string>

#include "scene/scene.h"

namespace lightgrid::patterns {

// A square of numbers that repeats in both directions; row 0 is v = 0.
class Field {
 public:
  explicit Field(int size) : size_(size), values_(size_t(size) * size) {}
  int size() const { return size_; }
  float& at(int x, int y) { return values_[index(x, y)]; }
  float at(int x, int y) const { return values_[index(x, y)]; }

 private:
  // size is a power of two, so that negative coordinates wrap as well.
  size_t index(int x, int y) const { return size_t(y & (size_ - 1)) * size_ + (x & (size_ - 1)); }
  int size_;
  std::vector<float> values_;
};

// Value noise in 0..1 (0.5 on average): the first octave has cells_x by cells_y cells, each further one twice
// as many at half the weight.
Field noise(int size, int cells_x, int cells_y, int octaves, uint64_t seed);

// The position of a texel within rectangular masonry.
struct Cell {
  float x, y;     // -1..1 across the cell
  float edge_px;  // to the nearest edge, in texels
  uint64_t hash;  // hash of the cell
  float random;   // 0..1, of the cell
};

// columns by rows cells in a square of `size` texels; each second row is shifted by half a cell where `bond`.
Cell cell_at(int x, int y, int size, int columns, int rows, bool bond);

// 0 below low, 1 above high, smooth between.
float step_between(float low, float high, float value);

using ColorAt = std::function<glm::vec4(int x, int y)>;

// Linear colours and coverage in; colours are stored through the sRGB curve.
Bitmap color_bitmap(const std::string& name, int size, const ColorAt& color);

// glTF's: green is roughness, blue is metallic.
Bitmap roughness_bitmap(const std::string& name, const Field& roughness);

// Tangent-space normals of a height field: x along u, y against v (as in glTF). Heights in texels.
Bitmap normal_bitmap(const std::string& name, const Field& height_px);

}  // namespace lightgrid::patterns
