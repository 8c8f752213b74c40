// A picture with blended surfaces, in double: which fragments a pixel has comes from the run's own
// layers, all else from the scene.
#pragma once

#include <map>
#include <set>

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "oracle/scene_surfaces.h"
#include "plan/settings/model.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;

struct BlendedInDouble {
  std::vector<uint32_t> pixels;  // with blended surfaces, which the oracle can decide
  std::vector<glm::dvec3> radiance;
  size_t left_out = 0;  // pixels with blended surfaces where a shadow turns on rounding
};

// The scene's blended surfaces over the picture that the same technique makes without them.
inline BlendedInDouble blended_in_double(TechniqueRun& run, ShadowTruth& truth) {
  const RenderView& v = run.view();
  Scene bare = v.scene;
  const auto blends = [&](const Instance& i) {
    return v.scene.materials[size_t(v.scene.meshes[size_t(i.mesh)].material)].alpha_mode == AlphaMode::blend;
  };
  std::erase_if(bare.instances, blends);
  TechniqueRun under(test_devices(), bare, v.view, v.plan.settings, run.technique());
  under.run_frame();

  std::map<int, size_t> order;  // of drawing, by instance
  for (const int i : v.plan.surfaces.blended) order.emplace(i, order.size());
  SceneSurfaces surfaces(v.scene, v.view);
  const std::vector<ViewLight> lights = lights_in_view(v.scene, v.view, ranges_of(v.plan.settings));
  struct Fragment {
    glm::dvec3 radiance;
    double alpha;
  };
  std::map<uint32_t, std::map<std::pair<size_t, int>, Fragment>> fragments;  // of a pixel, by drawing order
  std::set<uint32_t> undecided;
  for (const HostShadowLayer& layer : run.frame().blended_shadows()) {
    std::vector<uint32_t> pixels;
    std::map<uint32_t, Surface> at;
    std::map<uint32_t, double> alpha;
    std::vector<float> depth(layer.depth.size());
    std::vector<CastingTriangle> triangles(layer.depth.size());
    for (uint32_t p = 0; p < depth.size(); ++p) {
      const glm::ivec2 own = layer.triangles[p];
      if (own.x < 0) continue;
      const std::vector<uint32_t>& indices =
          v.scene.meshes[size_t(v.scene.instances[size_t(own.x)].mesh)].indices;
      const uint32_t* corners = &indices[3 * size_t(own.y)];
      const TriangleInView t = surfaces.triangle(own.x, {corners[0], corners[1], corners[2]});
      const glm::dvec2 centre(int(p) % v.view.width + 0.5, int(p) / v.view.width + 0.5);
      const auto there = surfaces.depth_at(t, centre);
      if (!there) {
        undecided.insert(p);  // an edge passes through the centre
        continue;
      }
      depth[p] = float(*there);
      triangles[p] = {own.x, uint32_t(own.y)};
      at[p] = surfaces.surface_at(t, centre);
      alpha[p] = surfaces.base_color_at(t, centre).a;
      pixels.push_back(p);
    }
    const auto seen = truth.at_pixels(v, depth, triangles, pixels);
    const std::vector<glm::dvec3> radiance = shade_pixels(
        v.view, depth, [&](uint32_t p) { return at.at(p); }, lights,
        {.brdf = v.plan.settings[setting::brdf], .ambient = v.scene.ambient, .hidden = seen->hidden()},
        pixels);
    for (size_t i = 0; i < pixels.size(); ++i) {
      const uint32_t p = pixels[i];
      if (seen->has_either(p)) undecided.insert(p);
      fragments[p][{order.at(triangles[p].instance), int(triangles[p].triangle)}] = {radiance[i],
                                                                                     alpha.at(p)};
    }
  }
  BlendedInDouble found;
  for (const auto& [pixel, over] : fragments) {
    if (undecided.contains(pixel)) {
      ++found.left_out;
      continue;
    }
    glm::dvec3 color(under.image().pixels[pixel]);
    for (const auto& [place, f] : over) color = f.radiance * f.alpha + color * (1 - f.alpha);
    found.pixels.push_back(pixel);
    found.radiance.push_back(color);
  }
  return found;
}

// The largest error of a colour channel over the pixel's own in double.
inline double worst_error(const Image& image, const BlendedInDouble& in_double) {
  double most = 0;
  for (size_t i = 0; i < in_double.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double expected = in_double.radiance[i][c];
      most = std::max(most, std::abs(double(image.pixels[in_double.pixels[i]][c]) - expected) / expected);
    }
  }
  return most;
}

}  // namespace lightgrid
