#include "accuracy/surfaces_in_double.h"

#include <algorithm>
#include <cmath>

#include "accuracy/oracle_sample.h"
#include "measures/metrics.h"
#include "oracle/scene_surfaces.h"
#include "plan/settings/model.h"

namespace lightgrid::lab {

SurfacesInDouble surfaces_in_double(const RenderView& v, const std::vector<SceneTriangle>& shown,
                                    const std::vector<uint32_t>& pixels, ShadowTruth* shadows) {
  SurfacesInDouble found;
  SceneSurfaces scene(v.scene, v.view);
  std::vector<Surface> surfaces;
  std::vector<uint32_t> place(shown.size());  // in `surfaces`
  std::vector<float> depth(shown.size());
  for (const uint32_t pixel : pixels) {
    if (shown[pixel].instance < 0) continue;
    const TriangleInView triangle = scene.triangle(shown[pixel].instance, shown[pixel].vertices);
    const uint32_t width = uint32_t(v.view.width);
    const glm::dvec2 centre(pixel % width + 0.5, pixel / width + 0.5);
    const std::optional<double> depth_there = scene.depth_at(triangle, centre);
    if (!depth_there) continue;
    depth[pixel] = float(*depth_there);
    place[pixel] = uint32_t(surfaces.size());
    surfaces.push_back(scene.surface_at(triangle, centre));
    found.pixels.push_back(pixel);
  }
  ShadeSettings settings{.brdf = v.plan.settings[setting::brdf], .ambient = v.scene.ambient};
  settings.base = base_terms(v.scene, v.view, v.plan);
  ShadowTruth own_shadows(v.scene, 0);
  if (!shadows) shadows = &own_shadows;
  std::unique_ptr<SeenPairs> seen;
  if (shadows->casts()) {
    seen = shadows->at_pixels(v, depth, casting_triangles(v.scene, shown), found.pixels);
    std::erase_if(found.pixels, [&](uint32_t pixel) { return seen->has_either(pixel); });
    settings.hidden = seen->hidden();
  }
  found.radiance = shade_pixels(
      v.view, depth, [&](uint32_t pixel) { return surfaces[place[pixel]]; },
      lights_in_view(v.scene, v.view, ranges_of(meant_by(v.plan.settings))), settings, found.pixels);
  return found;
}

SurfacesError surfaces_error(const Image& image, const SurfacesInDouble& in_double, double brightest) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  SurfacesError error{.pixels = in_double.pixels.size()};
  if (in_double.pixels.empty()) return error;
  double sum = 0, sum_in_double = 0, squares = 0;
  std::vector<double> largest(in_double.pixels.size());
  for (size_t i = 0; i < in_double.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double own = image.pixels[in_double.pixels[i]][c], expected = in_double.radiance[i][c];
      const double apart = std::isnan(own) ? infinity : std::abs(own - expected);
      sum += own;
      sum_in_double += expected;
      squares += apart * apart;
      largest[i] = std::max(largest[i], apart);
    }
  }
  const auto over = [&](double value, double whole) {
    return value == 0 ? 0 : whole > 0 ? value / whole : std::copysign(infinity, value);
  };
  std::ranges::sort(largest);
  error.sum_rel = over(sum - sum_in_double, sum_in_double);
  error.max_rel = over(largest.back(), brightest);
  error.rmse_rel = over(std::sqrt(squares / (3.0 * double(largest.size()))), brightest);
  error.p99_rel = over(largest[(largest.size() * 99 + 99) / 100 - 1], brightest);
  return error;
}

namespace {

// Blended, or beside a pixel that is: at its edge the two rasterisers may differ too.
std::vector<bool> near_blended(const std::vector<bool>& blended, const PixelGrid& grid) {
  std::vector<bool> near(blended.size(), false);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      if (!blended[grid.index(x, y)]) continue;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, grid.height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, grid.width - 1); ++u)
          near[grid.index(u, v)] = true;
      }
    }
  }
  return near;
}

}  // namespace

SilhouetteError silhouette_error(const Image& image, const std::vector<SceneTriangle>& own,
                                 const Image& reference, const ShownTriangles& shown) {
  const std::vector<bool> left_out = near_blended(shown.blended, {image.width, image.height});
  std::vector<uint32_t> inside;
  SilhouetteError error;
  for (uint32_t i = 0; i < own.size(); ++i) {
    if (own[i] != shown.opaque[i]) {
      ++error.silhouettes;
    } else if (left_out[i]) {
      ++error.blended;
    } else {
      inside.push_back(i);
    }
  }
  error.inside = inside.size();
  if (inside.empty()) return error;
  const ImageError of_inside = compare_images(at_pixels(image, inside), at_pixels(reference, inside));
  const double brightest = brightest_channel(reference);
  const auto relative = [&](double value) { return value == 0 ? 0 : value / brightest; };
  error.max_rel = relative(of_inside.max_abs);
  error.rmse_rel = relative(of_inside.rmse);
  error.p99_rel = relative(of_inside.p99);
  return error;
}

}  // namespace lightgrid::lab
