#include "session/surfaces_in_double.h"

#include <algorithm>
#include <cmath>

#include "reference/scene_surfaces.h"
#include "results/metrics.h"

namespace lightgrid {

SurfacesInDouble surfaces_in_double(const RenderView& v, const std::vector<SceneTriangle>& shown,
                                    const std::vector<uint32_t>& pixels) {
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
  found.radiance = shade_pixels(
      v.view, depth, [&](uint32_t pixel) { return surfaces[place[pixel]]; },
      lights_in_view(v.scene, v.view, v.plan.settings.ranges),
      {.brdf = v.plan.settings.brdf, .ambient = v.scene.ambient}, found.pixels);
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
      sum += own, sum_in_double += expected, squares += apart * apart;
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

}  // namespace lightgrid
