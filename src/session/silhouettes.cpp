#include "session/silhouettes.h"

#include <algorithm>
#include <cmath>

#include "cl/transfer.h"
#include "session/oracle_sample.h"
#include "results/metrics.h"

namespace lightgrid {
namespace {

// Blended, or beside a pixel that is: at its edge the two rasterisers may differ too.
std::vector<bool> near_blended(const std::vector<bool>& blended, int width, int height) {
  std::vector<bool> near(blended.size(), false);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!blended[size_t(y) * width + x]) continue;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
          near[size_t(v) * width + u] = true;
      }
    }
  }
  return near;
}

}  // namespace

std::vector<SceneTriangle> own_triangles(TechniqueRun& run) {
  const RenderView& v = run.view();
  std::vector<uint32_t> numbers(v.pixels());
  read_buffer(*v.renderer.cl, "reading triangles", run.frame().triangles->numbers, numbers.data(),
              numbers.size() * 4);
  const std::span<const int> instances = run.frame().triangles->instances;
  std::vector<uint32_t> first;  // by place in `instances`
  uint32_t count = 0;
  for (const int i : instances) {
    first.push_back(count);
    count += uint32_t(v.scene.meshes[v.scene.instances[i].mesh].indices.size() / 3);
  }
  std::vector<SceneTriangle> triangles;
  for (const uint32_t number : numbers) {
    if (number >= count) {
      triangles.emplace_back();
      continue;
    }
    const size_t place = size_t(std::ranges::upper_bound(first, number) - first.begin()) - 1;
    const std::vector<uint32_t>& indices = v.scene.meshes[v.scene.instances[instances[place]].mesh].indices;
    triangles.push_back(scene_triangle(instances[place], &indices[3 * size_t(number - first[place])]));
  }
  return triangles;
}

SilhouetteError silhouette_error(const Image& image, const std::vector<SceneTriangle>& own,
                                 const Image& reference, const ShownTriangles& shown) {
  const std::vector<bool> left_out = near_blended(shown.blended, image.width, image.height);
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

}  // namespace lightgrid
