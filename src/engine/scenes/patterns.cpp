#include "scenes/patterns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/image.h"
#include "scene/random.h"

namespace lightgrid::patterns {
namespace {

uint8_t byte(float unit) { return uint8_t(std::clamp(unit, 0.f, 1.f) * 255 + 0.5f); }

// The sRGB curve at 4096 samples: within half a byte of the curve itself, and fifty times as fast.
uint8_t srgb_byte(float linear) {
  static const auto table = [] {
    std::array<uint8_t, 4096> bytes;
    for (int i = 0; i < 4096; ++i) bytes[i] = byte(srgb_from_linear(float(i) / 4095));
    return bytes;
  }();
  return table[int(std::clamp(linear, 0.f, 1.f) * 4095 + 0.5f)];
}

float unit_of(uint64_t hash) { return float(hash >> 40) * 0x1p-24f; }

Bitmap blank(const std::string& name, int size) {
  return {name, size, size, std::vector<uint8_t>(size_t(size) * size * 4)};
}

uint8_t* put(uint8_t* texel, uint8_t r, uint8_t g, uint8_t b, uint8_t a) {
  texel[0] = r;
  texel[1] = g;
  texel[2] = b;
  texel[3] = a;
  return texel + 4;
}

void add_octave(Field& field, int cells_x, int cells_y, float weight, uint64_t seed) {
  const int size = field.size();
  std::vector<float> lattice(size_t(cells_x) * cells_y);
  Random random(seed);
  for (float& value : lattice) value = random.uniform() * weight;
  for (int y = 0; y < size; ++y) {
    const int row = y * cells_y / size, next_row = (row + 1) % cells_y;
    const float ty = step_between(0, 1, float(y) * cells_y / size - row);
    for (int x = 0; x < size; ++x) {
      const int column = x * cells_x / size, next = (column + 1) % cells_x;
      const float tx = step_between(0, 1, float(x) * cells_x / size - column);
      const float* low = &lattice[size_t(row) * cells_x];
      const float* high = &lattice[size_t(next_row) * cells_x];
      const float a = low[column] + (low[next] - low[column]) * tx;
      const float b = high[column] + (high[next] - high[column]) * tx;
      field.at(x, y) += a + (b - a) * ty;
    }
  }
}

}  // namespace

float step_between(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

Field noise(int size, int cells_x, int cells_y, int octaves, uint64_t seed) {
  Field field(size);
  float total = 0, weight = 1;
  for (int octave = 0; octave < octaves; ++octave, weight /= 2) total += weight;
  weight = 1 / total;
  for (int octave = 0; octave < octaves; ++octave, weight /= 2) {
    add_octave(field, std::min(cells_x << octave, size), std::min(cells_y << octave, size), weight,
               seed + octave);
  }
  return field;
}

Cell cell_at(int x, int y, int size, int columns, int rows, bool bond) {
  const float height = float(size) / rows, width = float(size) / columns;
  const int row = int(y / height);
  float shifted = x + (bond && row % 2 ? width / 2 : 0);
  if (shifted >= float(size)) shifted -= float(size);
  const int column = int(shifted / width);
  Cell cell;
  cell.x = (shifted + 0.5f - column * width) / width * 2 - 1;
  cell.y = (y + 0.5f - row * height) / height * 2 - 1;
  cell.edge_px = std::min((1 - std::abs(cell.x)) * width, (1 - std::abs(cell.y)) * height) / 2;
  cell.hash = Random::mix(uint64_t(row) * 8191 + column + 1);
  cell.random = unit_of(cell.hash);
  return cell;
}

Bitmap color_bitmap(const std::string& name, int size, const ColorAt& color) {
  Bitmap bitmap = blank(name, size);
  uint8_t* texel = bitmap.rgba.data();
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const glm::vec4 c = color(x, y);
      texel = put(texel, srgb_byte(c.r), srgb_byte(c.g), srgb_byte(c.b), byte(c.a));
    }
  }
  return bitmap;
}

Bitmap roughness_bitmap(const std::string& name, const Field& roughness) {
  Bitmap bitmap = blank(name, roughness.size());
  uint8_t* texel = bitmap.rgba.data();
  for (int y = 0; y < roughness.size(); ++y) {
    for (int x = 0; x < roughness.size(); ++x) texel = put(texel, 255, byte(roughness.at(x, y)), 255, 255);
  }
  return bitmap;
}

Bitmap normal_bitmap(const std::string& name, const Field& height_px) {
  Bitmap bitmap = blank(name, height_px.size());
  uint8_t* texel = bitmap.rgba.data();
  for (int y = 0; y < height_px.size(); ++y) {
    for (int x = 0; x < height_px.size(); ++x) {
      const float along_u = (height_px.at(x + 1, y) - height_px.at(x - 1, y)) / 2;
      const float along_v = (height_px.at(x, y + 1) - height_px.at(x, y - 1)) / 2;
      const glm::vec3 n = glm::normalize(glm::vec3(-along_u, along_v, 1)) * 0.5f + 0.5f;
      texel = put(texel, byte(n.x), byte(n.y), byte(n.z), 255);
    }
  }
  return bitmap;
}

}  // namespace lightgrid::patterns
