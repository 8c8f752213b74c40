// A texture in double, filtered as OpenGL 4.6 says (8.14). Shares no formula with the kernels.
#pragma once

#include <unordered_map>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// Colours are decoded from sRGB first. A mip level is the average of the one before it, by area; neither is
// rounded. Levels are not stored: a texel of one is averaged when a filter first takes it, and remembered. So
// one sampler serves one thread.
class TextureSampler {
 public:
  // Both must outlive it.
  TextureSampler(const Bitmap& bitmap, const Texture& texture);

  // right, up: the change of uv from one pixel to the next.
  glm::dvec4 at(const glm::dvec2& uv, const glm::dvec2& right, const glm::dvec2& up);

 private:
  // The share of each texel of a row of level 0 in one texel of a smaller row.
  struct Share {
    int first = 0;
    std::vector<double> of_texel;
  };
  struct Side {
    std::vector<int> sizes;                  // by level
    std::vector<std::vector<Share>> shares;  // by level, made when first used
    const Share& share(int level, int texel);
  };

  glm::dvec4 stored(int x, int y) const;
  glm::dvec4 texel(int level, double x, double y);
  glm::dvec4 filtered(int level, const glm::dvec2& uv, bool linear);

  const Bitmap& bitmap_;
  const Texture& texture_;
  Side columns_, rows_;
  std::unordered_map<uint64_t, glm::dvec4> averages_;  // by level, row and column
};

}  // namespace lightgrid
