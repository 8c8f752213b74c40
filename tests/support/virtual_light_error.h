// The error of a picture with virtual lights against the truth of one bounce, at a sample of its pixels.
#pragma once

#include "support/one_bounce.h"

#ifdef LIGHTGRID_EMBREE
#include <optional>

#include "accuracy/surfaces_in_double.h"
#include "plan/settings/model.h"
#include "run/technique_run.h"
#include "run/virtual_lights.h"

namespace lightgrid {
using namespace lab;

// Relative to the mean of the truth. Channels count alike.
struct VirtualLightError {
  double bias = 0;      // error of the sum over all pixels
  double mean_abs = 0;  // mean over pixels, for single placements; with the truth's noise
  double rms = 0;       // over pixels, of single placements; without the reference's own noise
  double spread = 0;  // the part of it that changes from one placement to the next: the root of the variance
};

class OneBounceView {
 public:
  // The scene has one light and no blended surface. Pixels: at most this many, of those with a surface.
  OneBounceView(Renderer& renderer, Scene scene, const View& view, const Settings& settings, size_t pixels,
                int samples)
      : renderer_(renderer),
        scene_(std::move(scene)),
        light_(scene_.lights.at(0)),
        view_(view),
        settings_(settings) {
    scene_.ambient = glm::vec3(0);
    scene_.lights.clear();
    TechniqueRun run(renderer_, scene_, view_, settings_, find_technique("visibility"));
    run.run_frame();
    dark_ = run.image();
    const std::vector<SceneTriangle> shown = own_triangles(run);
    std::vector<uint32_t> covered;
    for (uint32_t p = 0; p < shown.size(); ++p)
      if (shown[p].instance >= 0) covered.push_back(p);
    pixels_ = sample_pixels(covered, pixels);
    OneBounce truth(scene_, settings_[setting::brdf]);
    for (const uint32_t p : pixels_) {
      const auto half = [&](uint64_t seed) {
        return truth.radiance(view_, int(p % uint32_t(view_.width)), int(p / uint32_t(view_.width)),
                              shown[p].instance, shown[p].vertices, light_, samples / 2, seed);
      };
      const glm::dvec3 a = half(1), b = half(2);
      truth_.push_back((a + b) * 0.5);
      noise_ += glm::dot(a - b, a - b) / 12;  // the mean's variance, a channel
    }
    noise_ /= double(pixels_.size());
    for (const glm::dvec3& t : truth_) mean_ += (t.x + t.y + t.z) / 3 / double(truth_.size());
  }

  // Draws virtual lights from here on; visibility unless set.
  void set_technique(const char* technique) { technique_ = technique; }
  // The ranges of virtual lights from here on.
  void set_ranges(const LightRanges& ranges) { lightgrid::set_ranges(settings_, ranges); }

  double truth_mean() const { return mean_; }
  double truth_noise() const { return std::sqrt(noise_) / mean_; }  // noise of one pixel
  const std::vector<glm::dvec3>& truth() const { return truth_; }
  const Scene& scene() const { return scene_; }

  // The scene with these virtual lights alone.
  Scene& with_virtual(const VirtualLightSettings& choice, bool shadows) {
    scene_.lights = {light_};
    VirtualLights(scene_, renderer_.cl->info().name, settings_, choice).place();
    scene_.lights.erase(scene_.lights.begin());
    for (Light& light : scene_.lights) light.casts_shadow = shadows;
    return scene_;
  }

  std::vector<glm::dvec3> added(const VirtualLightSettings& choice, bool shadows) {
    with_virtual(choice, shadows);
    TechniqueRun run(renderer_, scene_, view_, settings_, find_technique(technique_));
    run.run_frame();
    std::vector<glm::dvec3> all;
    for (const uint32_t p : pixels_)
      all.push_back(glm::dvec3(run.image().pixels[p]) - glm::dvec3(dark_.pixels[p]));
    return all;
  }

  VirtualLightError error(VirtualLightSettings choice, bool shadows, int seeds) {
    VirtualLightError e;
    std::vector<glm::dvec3> sum(pixels_.size()), squares(pixels_.size());
    double squared = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      choice.seed = uint64_t(seed);
      const std::vector<glm::dvec3> now = added(choice, shadows);
      for (size_t i = 0; i < now.size(); ++i) {
        const glm::dvec3 d = now[i] - truth_[i];
        e.bias += (d.x + d.y + d.z) / 3;
        e.mean_abs += (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) / 3;
        squared += glm::dot(d, d) / 3;
        sum[i] += now[i];
        squares[i] += now[i] * now[i];
      }
    }
    const double n = double(pixels_.size()) * seeds;
    e.bias /= n * mean_;
    e.mean_abs /= n * mean_;
    e.rms = std::sqrt(std::max(squared / n - noise_, 0.0)) / mean_;
    double variance = 0;
    for (size_t i = 0; i < sum.size() && seeds > 1; ++i) {
      const glm::dvec3 v = (squares[i] - sum[i] * sum[i] / double(seeds)) / double(seeds - 1);
      variance += (v.x + v.y + v.z) / 3;
    }
    e.spread = std::sqrt(std::max(variance / double(pixels_.size()), 0.0)) / mean_;
    return e;
  }

 private:
  Renderer& renderer_;
  Scene scene_;
  Light light_;
  View view_;
  Settings settings_;
  const char* technique_ = "visibility";
  Image dark_;
  std::vector<uint32_t> pixels_;
  std::vector<glm::dvec3> truth_;
  double mean_ = 0, noise_ = 0;
};

}  // namespace lightgrid
#endif
