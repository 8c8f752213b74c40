#include "frontier/precision.h"

#include "compare/oracle_sample.h"
#include "compare/silhouettes.h"
#include "frontier/errors.h"

namespace lightgrid {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Image as_image(const std::vector<glm::dvec3>& colors) {
  Image image(int(colors.size()), 1);
  for (size_t i = 0; i < colors.size(); ++i) image.pixels[i] = glm::vec4(glm::vec3(colors[i]), 1);
  return image;
}

}  // namespace

Precision::Precision(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& common,
                     size_t samples)
    : renderer_(renderer), common_(common), samples_(samples) {
  of_opengl_ = of_own_ = {unknown, unknown, unknown, unknown, {}};
  if (!renderer_.gl) return;
  forward_.emplace(renderer, gpu, view, common, find_technique("forward"));
  visibility_.emplace(renderer, gpu, view, common, find_technique("visibility"));
}

void Precision::measure(const View& view, BruteForce& opengl, BruteForce* own) {
  if (!forward_) return;
  forward_->look(view);
  forward_->run_frame(true);
  const std::vector<float> depth = read_depth(forward_->view());
  const SurfaceOracle oracle(forward_->view(), depth);
  const size_t most = affordable_samples(samples_, forward_->view().scene.lights.size());
  std::vector<uint32_t> pixels = sample_pixels(oracle.pixels(), most);
  const Image exact = as_image(oracle.shade(pixels, true));
  of_opengl_ = error_figures(at_pixels(opengl.picture(common_), pixels), exact, opengl.brightest());
  if (!own) return;
  const ShownTriangles shown = read_triangles(forward_->view());
  visibility_->look(view);
  visibility_->run_frame(true);
  const std::vector<SceneTriangle> triangles = own_triangles(*visibility_);
  std::erase_if(pixels, [&](uint32_t pixel) { return triangles[pixel] != shown.opaque[pixel]; });
  const Image exact_inside = as_image(oracle.shade(pixels, true));
  of_own_ = error_figures(at_pixels(own->picture(common_), pixels), exact_inside, own->brightest());
}

}  // namespace lightgrid
