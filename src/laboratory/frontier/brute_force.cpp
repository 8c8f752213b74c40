#include "frontier/brute_force.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "accuracy/oracle_sample.h"
#include "accuracy/surfaces_in_double.h"
#include "measures/error_measures.h"
#include "measures/metrics.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr size_t min_pixels = 400, max_pixels = 20000;
constexpr int places_a_side = 16;   // places per side of a pixel, in a truth of areas
constexpr int rays_of_truth = 256;  // to a sphere; docs/shadows.md has their error

}  // namespace

FrontierTruth chosen_truth(const Settings& common, bool casts, std::optional<bool> own_ranges, bool areas) {
  FrontierTruth truth{.own_ranges = own_ranges.value_or(casts || areas)};
  if (areas) truth.places = places_a_side * places_a_side;
  const bool spheres = common.given(setting::shadow_source_m) || common[setting::shadow_rays] > 1;
  if (casts && spheres && common[setting::shadow_source_m] > 0) {
    truth.source_m = common[setting::shadow_source_m];
    truth.shadow_rays = rays_of_truth;
  }
  return truth;
}

bool counts_shadow_pairs(const Settings& settings, const FrontierTruth& truth) {
  return truth.source_m == 0 && !soft_shadows(settings) && !picks_shadows(settings);
}

View part_of_view(const View& view, int x, int y, int width, int height, int scale) {
  View part = view;
  part.width = width * scale;
  part.height = height * scale;
  const double across = double(view.width) / width, up = double(view.height) / height;
  for (int column = 0; column < 4; ++column) {
    glm::dvec4& c = part.clip_from_view[column];
    c.x = across * c.x + (across - 2.0 * x / width - 1) * c.w;
    c.y = up * c.y + (up - 2.0 * y / height - 1) * c.w;
  }
  return part;
}

BruteForce::BruteForce(Renderer& renderer, GpuScene& gpu, const Settings& common, const FrontierTruth& truth,
                       bool own_surfaces)
    : renderer_(renderer),
      gpu_(gpu),
      common_(common),
      truth_(truth),
      technique_(find_technique(own_surfaces ? "visibility" : "forward")),
      pool_(std::make_shared<TargetPool>()) {}

void BruteForce::look(const View& view) {
  if (view != view_) of_areas_.reset();  // it takes 256 frames
  view_ = view;
  pictures_.clear();
}

Settings BruteForce::meaning(const Settings& settings, double source_m) const {
  Settings meaning = meant_by(with_model(common_, settings));
  meaning = with_samples(std::move(meaning), truth_.places ? settings[setting::samples] : 1);
  meaning.set(setting::samples_masks, settings[setting::samples_masks]);
  meaning.set(setting::samples_resolve, settings[setting::samples_resolve]);
  meaning.set(setting::lights, ShadedLights::all);
  meaning.set(setting::shadow_rays, source_m > 0 ? rays_of_truth : 1);
  meaning.set(setting::shadow_source_m, source_m);
  return meaning;
}

const Image& BruteForce::kept(const Settings& meaning) {
  const auto samples_of = [](const Settings& s) {
    return s[setting::samples] == 1
               ? std::tuple(1, SampleMasks(), SamplesResolve())
               : std::tuple(s[setting::samples], s[setting::samples_masks], s[setting::samples_resolve]);
  };
  for (const auto& [of, image] : pictures_) {
    if (same_model(of, meaning) && of[setting::shadow_source_m] == meaning[setting::shadow_source_m] &&
        samples_of(of) == samples_of(meaning))
      return image;
  }
  return pictures_.emplace_back(meaning, drawn(meaning)).second;
}

Image BruteForce::drawn(const Settings& meaning) {
  TechniqueRun run(renderer_, gpu_, view_, meaning, technique_, pool_);
  run.run_frame(true);
  return run.take_image();
}

// Drawn at 16 times the size, a part after the other, from lists: these hold every light that reaches a
// pixel. Textures are filtered with a place's share of the pixel.
Image BruteForce::mean_over_areas(const Settings& meaning) {
  Settings settings = with_samples(meaning, 1);
  settings.set(setting::lights, ShadedLights::grid);
  const int width = (view_.width + places_a_side - 1) / places_a_side,
            height = (view_.height + places_a_side - 1) / places_a_side;
  const auto part_at = [&](int x, int y) { return part_of_view(view_, x, y, width, height, places_a_side); };
  TechniqueRun run(renderer_, gpu_, part_at(0, 0), settings, find_technique("visibility"));
  run.prepare();
  Image mean(view_.width, view_.height);
  for (int y = 0; y < view_.height; y += height) {
    for (int x = 0; x < view_.width; x += width) {
      run.look(part_at(x, y));
      run.run_frame(true);
      const Image& part = run.image();
      for (size_t i = 0; i < part.pixels.size(); ++i) {
        const int px = x + int(i) % part.width / places_a_side, py = y + int(i) / part.width / places_a_side;
        if (px < mean.width && py < mean.height)
          mean.pixels[size_t(py) * size_t(mean.width) + size_t(px)] +=
              part.pixels[i] / float(places_a_side * places_a_side);
      }
    }
  }
  return mean;
}

static double source_of(const Settings& settings, const FrontierTruth& truth) {
  if (truth.source_m > 0) return truth.source_m;
  return soft_shadows(settings) ? settings[setting::shadow_source_m] : 0;
}

const Image& BruteForce::picture(const Settings& settings) {
  return kept(meaning(settings, source_of(settings, truth_)));
}

Image BruteForce::draw(const Settings& settings) {
  return drawn(meaning(settings, source_of(settings, truth_)));
}

const Image& BruteForce::picture_of_points(const Settings& settings) { return kept(meaning(settings, 0)); }

Settings BruteForce::meaning_of_truth() const {
  Settings settings = common_;
  if (!truth_.own_ranges)
    set_ranges(settings, {.range = LightRange::infinite, .effects = ranges_of(common_).effects});
  return meaning(settings, truth_.source_m);
}

const Image& BruteForce::truth() {
  if (!truth_.places) return kept(meaning_of_truth());
  if (!of_areas_) of_areas_ = mean_over_areas(meaning_of_truth());
  return *of_areas_;
}

std::unique_ptr<TechniqueRun> BruteForce::truth_run(const View& view) const {
  return std::make_unique<TechniqueRun>(renderer_, gpu_, view, with_samples(meaning_of_truth(), 1),
                                        technique_, pool_);
}

const Image& BruteForce::authored() { return kept(meaning(common_, truth_.source_m)); }

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
                     const FrontierTruth& truth, size_t pairs)
    : renderer_(renderer), common_(with_samples(common, 1)), truth_(truth), pairs_(pairs) {
  for (Sample& sample : samples_) {
    for (const ErrorMeasure& measure : frontier_error_measures()) sample.precision.*measure.value = unknown;
  }
  if (!renderer_.gl) return;
  opengl_.emplace(renderer, gpu, view, common_, find_technique("forward_plus"));
  visibility_.emplace(renderer, gpu, view, common_, find_technique("visibility"));
}

void Precision::judge(Sample& sample, BruteForce& brute, const std::vector<glm::dvec3>& with_ranges) const {
  sample.precision =
      frontier_error(at_pixels(brute.picture_of_points(common_), sample.pixels), with_ranges, brightest_);
  if (truth_.source_m > 0 || truth_.places) return;
  const Image float_truth = at_pixels(brute.truth(), sample.pixels);
  sample.truth_in_float = frontier_error(float_truth, sample.truth, brightest_);
  sample.float_truth.assign(float_truth.pixels.begin(), float_truth.pixels.end());
}

void Precision::measure(const View& view, BruteForce& opengl, BruteForce* own, uint64_t seed,
                        ShadowTruth& shadows) {
  if (!opengl_) return;
  opengl_->look(view);
  opengl_->run_frame(true);
  RenderView& v = opengl_->view();
  const std::vector<float> depth = read_depth(v);
  const SurfaceOracle oracle(v, depth, &shadows);
  const size_t lights = std::max<size_t>(v.scene.lights.size(), 1);
  Sample& all = samples_[0];
  all.pixels = oracle.decided(
      random_pixels(oracle.pixels(), std::clamp(pairs_ / lights, min_pixels, max_pixels), seed),
      truth_.own_ranges);
  const std::vector<glm::dvec3> with_ranges = oracle.shade(all.pixels, true);
  all.truth = truth_.own_ranges ? with_ranges : oracle.shade(all.pixels, false);
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
  if (!opengl_ || sample.pixels.empty() || truth_.source_m > 0 || truth_.places) return {};
  const Image at_sample = at_pixels(picture, sample.pixels);
  return SampledErrors{int(sample.pixels.size()), frontier_error(at_sample, sample.truth, brightest_),
                       frontier_error(at_sample, sample.float_truth, brightest_), sample.truth_in_float};
}

}  // namespace lightgrid::lab
