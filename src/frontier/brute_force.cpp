#include "frontier/brute_force.h"

#include <algorithm>
#include <limits>

#include "results/error_measures.h"
#include "results/metrics.h"
#include "scene/random.h"
#include "session/oracle_sample.h"
#include "session/surfaces_in_double.h"

namespace lightgrid {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr size_t least_pixels = 400, most_pixels = 20000;

}  // namespace

BruteForce::BruteForce(Renderer& renderer, GpuScene& gpu, const Settings& common, bool own_surfaces)
    : renderer_(renderer),
      gpu_(gpu),
      common_(common),
      technique_(find_technique(own_surfaces ? "visibility" : "forward")),
      pool_(std::make_shared<TargetPool>()) {}

void BruteForce::look(const View& view) {
  view_ = view;
  pictures_.clear();
}

const Image& BruteForce::picture(const Settings& settings) {
  for (const auto& [meaning, image] : pictures_) {
    if (same_model(meaning, settings)) return image;
  }
  return pictures_.emplace_back(settings, draw(settings)).second;
}

Image BruteForce::draw(const Settings& settings) {
  Settings meaning = with_exact_shadows(with_model(common_, settings));
  meaning.lights = ShadedLights::all;
  TechniqueRun run(renderer_, gpu_, view_, meaning, technique_, pool_);
  run.run_frame(true);
  return run.take_image();
}

const Image& BruteForce::truth() {
  Settings settings = common_;
  settings.ranges = {.range = LightRange::infinite};
  return picture(settings);
}

double BruteForce::brightest() { return brightest_channel(truth()); }

std::vector<uint32_t> random_pixels(const std::vector<uint32_t>& pixels, size_t count, uint64_t seed) {
  if (pixels.size() <= count) return pixels;
  Random random(seed);
  std::vector<uint32_t> sample;
  for (size_t i = 0; i < count; ++i) {
    const size_t begin = i * pixels.size() / count, end = (i + 1) * pixels.size() / count;
    sample.push_back(pixels[begin + size_t(random.next() % (end - begin))]);
  }
  return sample;
}

Precision::Precision(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& common,
                     size_t pairs)
    : renderer_(renderer), common_(common), pairs_(pairs) {
  for (Sample& sample : samples_) {
    for (const ErrorMeasure& measure : frontier_error_measures()) sample.precision.*measure.value = unknown;
  }
  if (!renderer_.gl) return;
  opengl_.emplace(renderer, gpu, view, common, find_technique("forward_plus"));
  visibility_.emplace(renderer, gpu, view, common, find_technique("visibility"));
}

void Precision::judge(Sample& sample, BruteForce& brute, const std::vector<glm::dvec3>& with_ranges) const {
  sample.precision =
      frontier_error(at_pixels(brute.picture(common_), sample.pixels), with_ranges, brightest_);
  sample.float_truth = at_pixels(brute.truth(), sample.pixels);
  sample.truth_in_float = frontier_error(sample.float_truth, sample.truth, brightest_);
}

void Precision::measure(const View& view, BruteForce& opengl, BruteForce* own, uint64_t seed) {
  if (!opengl_) return;
  opengl_->look(view);
  opengl_->run_frame(true);
  RenderView& v = opengl_->view();
  const std::vector<float> depth = read_depth(v);
  const SurfaceOracle oracle(v, depth);
  const size_t lights = std::max<size_t>(v.scene.lights.size(), 1);
  Sample& all = samples_[0];
  all.pixels = random_pixels(oracle.pixels(), std::clamp(pairs_ / lights, least_pixels, most_pixels), seed);
  all.truth = oracle.shade(all.pixels, false);
  const std::vector<glm::dvec3> with_ranges = oracle.shade(all.pixels, true);
  brightest_ = opengl.brightest();
  judge(all, opengl, with_ranges);
  if (!own) return;
  const ShownTriangles shown = read_triangles(v);
  visibility_->look(view);
  visibility_->run_frame(true);
  const std::vector<SceneTriangle> triangles = own_triangles(*visibility_);
  Sample& same = samples_[1];
  same.pixels.clear();
  same.truth.clear();
  std::vector<glm::dvec3> same_with_ranges;
  for (size_t i = 0; i < all.pixels.size(); ++i) {
    const uint32_t pixel = all.pixels[i];
    if (triangles[pixel] != shown.opaque[pixel]) continue;
    same.pixels.push_back(pixel);
    same.truth.push_back(all.truth[i]);
    same_with_ranges.push_back(with_ranges[i]);
  }
  judge(same, *own, same_with_ranges);
}

std::optional<SampledErrors> Precision::in_double(const Image& picture, bool own_surfaces) const {
  const Sample& sample = samples_[own_surfaces];
  if (!opengl_ || sample.pixels.empty()) return {};
  const Image at_sample = at_pixels(picture, sample.pixels);
  return SampledErrors{int(sample.pixels.size()), frontier_error(at_sample, sample.truth, brightest_),
                       frontier_error(at_sample, sample.float_truth, brightest_), sample.truth_in_float};
}

}  // namespace lightgrid
