// Which triangle of a scene is nearest at each pixel, in double, and its surface there
// (oracle/scene_surfaces.h). Shares the plain structs that describe a scene with the renderer, and nothing
// else. Blended surfaces are left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle/scene_surfaces.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid::double_surfaces {
using namespace lab;

using glm::dvec2, glm::dvec3, glm::dvec4;

// The nearest triangle at a pixel.
struct Hit {
  int instance = -1;      // number in the scene; -1: nothing
  uint32_t triangle = 0;  // number in its mesh
  double depth = 0;
};

class Surfaces {
 public:
  // `instances`: those that may be drawn, in drawing order.
  Surfaces(const Scene& scene, const View& view, const std::vector<int>& instances)
      : scene_(scene), view_(view), in_double_(scene, view) {
    hits_.resize(size_t(view.width) * view.height);
    for (const int instance : instances) draw(instance);
  }

  const std::vector<Hit>& hits() const { return hits_; }  // row 0 at the bottom

  // The surface in view space at a pixel that has one.
  Surface surface_at(uint32_t pixel) {
    const dvec2 centre(pixel % uint32_t(view_.width) + 0.5, pixel / uint32_t(view_.width) + 0.5);
    return in_double_.surface_at(triangle_of(hits_[pixel].instance, hits_[pixel].triangle), centre);
  }

 private:
  TriangleInView triangle_of(int instance, uint32_t number) const {
    const uint32_t* index = &scene_.meshes[scene_.instances[instance].mesh].indices[3 * size_t(number)];
    return in_double_.triangle(instance, {index[0], index[1], index[2]});
  }

  void draw(int number) {
    const Instance& instance = scene_.instances[number];
    const Mesh& mesh = scene_.meshes[instance.mesh];
    const Material& m = scene_.materials[mesh.material];
    const bool mirrored = glm::determinant(glm::dmat3(instance.world_from_object)) < 0;
    for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const TriangleInView triangle = triangle_of(number, t);
      const auto& c = triangle.corners;
      const double turn = triangle.turn() * (mirrored ? -1 : 1);
      if (turn == 0 || (turn < 0 && !m.double_sided)) continue;
      // All in front of the eye: the pixels between the corners. Else all of them.
      dvec2 low(0), high(view_.width - 1, view_.height - 1);
      if (c[0].w > 1e-6 && c[1].w > 1e-6 && c[2].w > 1e-6) {
        dvec2 least(1e30), most(-1e30);
        for (const dvec4& v : c) {
          const dvec2 pixel = (dvec2(v) / v.w * 0.5 + 0.5) * dvec2(view_.width, view_.height);
          least = glm::min(least, pixel);
          most = glm::max(most, pixel);
        }
        low = glm::max(low, glm::floor(least) - 1.0);
        high = glm::min(high, glm::ceil(most));
      }
      for (int y = int(low.y); y <= int(high.y); ++y) {
        for (int x = int(low.x); x <= int(high.x); ++x) {
          const dvec2 centre(x + 0.5, y + 0.5);
          const std::optional<double> depth = in_double_.depth_at(triangle, centre);
          Hit& nearest = hits_[size_t(y) * view_.width + x];
          if (!depth || !(*depth > nearest.depth) || *depth > 1) continue;
          if (m.alpha_mode == AlphaMode::mask &&
              in_double_.base_color_at(triangle, centre).a < m.alpha_cutoff)
            continue;
          nearest = {number, t, *depth};
        }
      }
    }
  }

  const Scene& scene_;
  const View& view_;
  SceneSurfaces in_double_;
  std::vector<Hit> hits_;
};

}  // namespace lightgrid::double_surfaces
