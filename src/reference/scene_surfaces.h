// Surfaces of a scene in double, from the scene alone: a triangle's depth, attributes and textures at a place
// on the screen. With shading.h it gives what a pixel shows, whichever rasteriser and texture filter drew it.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "reference/shading.h"
#include "reference/texture_sampler.h"

namespace lightgrid {

// A triangle in a view. In clip space corners that lie behind the eye need no clipping.
struct TriangleInView {
  int instance = 0;                    // of the scene
  std::array<uint32_t, 3> vertices{};  // of its mesh, in the mesh's order
  std::array<glm::dvec4, 3> corners{};
  // The determinant of the corners' x, y and w: above 0 if they appear counter-clockwise; 0: seen edge on.
  double turn() const;
};

class SceneSurfaces {
 public:
  // Both must outlive it.
  SceneSurfaces(const Scene& scene, const View& view) : scene_(scene), view_(view) {}

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

}  // namespace lightgrid
