// Surfaces of a scene in double, from the scene alone: a triangle's depth, attributes and textures at a place
// on the screen. With shading.h it gives what a pixel shows, whichever rasteriser and texture filter drew it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "oracle/shading.h"
#include "scene/scene.h"

namespace lightgrid::lab {

// A texture in double, filtered as OpenGL 4.6 says (8.14), which shares no formula with the kernels.
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

// A triangle in a view. In clip space corners that lie behind the eye need no clipping.
struct TriangleInView {
  int instance = 0;                    // number in the scene
  std::array<uint32_t, 3> vertices{};  // vertices of its mesh, in the mesh's order
  std::array<glm::dvec4, 3> corners{};
  // The determinant of the corners' x, y and w: above 0 if they appear counter-clockwise; 0: seen edge on.
  double turn() const;
};

class SceneSurfaces {
 public:
  // Both must outlive it.
  SceneSurfaces(const Scene& scene, const View& view) : scene_(scene), view_(view) {}

  glm::ivec2 size() const { return {view_.width, view_.height}; }  // the view's size, pixels

  TriangleInView triangle(int instance, const std::array<uint32_t, 3>& vertices) const;

  // place: pixels from the lower left corner of the image; a pixel's centre is at .5. None if the triangle
  // does not cover it or lies behind the eye there.
  std::optional<double> depth_at(const TriangleInView& triangle, const glm::dvec2& place) const;

  // Base colour and alpha at a place of the triangle's plane.
  glm::dvec4 base_color_at(const TriangleInView& triangle, const glm::dvec2& place);

  // In view space, at a place of the triangle's plane. Of unlit ones the base colour alone.
  Surface surface_at(const TriangleInView& triangle, const glm::dvec2& place);

 private:
  struct Weights;
  Weights weights_at(const TriangleInView& triangle, const glm::dvec2& place) const;
  glm::dvec4 sampled(const TextureSlot& slot, const TriangleInView& triangle, const Weights& weights);
  glm::dvec4 color_of(const TriangleInView& triangle, const Weights& weights);

  const Scene& scene_;
  const View& view_;
  std::map<int, TextureSampler> samplers_;  // by texture
};

}  // namespace lightgrid::lab
