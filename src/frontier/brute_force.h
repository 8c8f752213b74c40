// Every light at every pixel: what settings mean, and the truth. And the error of brute force itself, and of
// pictures, against the oracle in double at a sample of pixels.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "frontier/record.h"
#include "session/technique_run.h"

namespace lightgrid {

// Pictures of one view, for techniques that share its surfaces: OpenGL's (`forward`) or those of the
// rasteriser in OpenCL (`visibility:lights=all`). Float; their own error against the oracle in double is
// measured apart.
class BruteForce {
 public:
  // `common`: the settings that all points share. All outlive it.
  BruteForce(Renderer& renderer, GpuScene& gpu, const Settings& common, bool own_surfaces);

  void look(const View& view);  // forgets the pictures of the view before

  // With the BRDF, ranges and window of `settings`.
  const Image& picture(const Settings& settings);
  Image draw(const Settings& settings);  // the same, not kept
  // Without ranges.
  const Image& truth();
  double brightest();  // channel of the truth

 private:
  Renderer& renderer_;
  GpuScene& gpu_;
  Settings common_;
  const Technique& technique_;
  View view_;
  std::shared_ptr<TargetPool> pool_;
  std::list<std::pair<Settings, Image>> pictures_;  // with their meaning
};

// On the surfaces that OpenGL shows, at opaque pixels, with the BRDF of `common`. For techniques with
// surfaces of their own the sample holds the pixels where both show the same triangle, and the figures
// contain what their texture filter does otherwise.
class Precision {
 public:
  // Without OpenGL nothing is measured: figures are NaN. All outlive it. `pairs`: of pixel and light that the
  // oracle may shade on a view.
  Precision(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& common, size_t pairs);

  // `own`: the pictures of the family whose surfaces are the rasteriser's; null: not needed. `seed`: of the
  // random pixels.
  void measure(const View& view, BruteForce& opengl, BruteForce* own, uint64_t seed);

  // Brute force with the ranges of `common` in float against the same in double.
  const ImageError& of(bool own_surfaces) const { return samples_[own_surfaces].precision; }
  // A picture of that view against the truth in double.
  std::optional<SampledErrors> in_double(const Image& picture, bool own_surfaces) const;

 private:
  struct Sample {
    std::vector<uint32_t> pixels;
    std::vector<glm::dvec3> truth;  // every light, no range
    Image float_truth;              // the same in float
    ImageError precision, truth_in_float;
  };

  void judge(Sample& sample, BruteForce& brute, const std::vector<glm::dvec3>& with_ranges) const;

  Renderer& renderer_;
  Settings common_;
  size_t pairs_;
  double brightest_ = 0;  // channel of the truth on OpenGL's surfaces
  std::optional<TechniqueRun> opengl_, visibility_;
  Sample samples_[2];  // of OpenGL's surfaces, of the rasteriser's
};

// A random one of each of `count` equal runs of `pixels`; all of them if there are no more. If a share f of
// the pixels is of some kind, the sample holds none of it with a probability of at most (1 - f)^count.
std::vector<uint32_t> random_pixels(const std::vector<uint32_t>& pixels, size_t count, uint64_t seed);

}  // namespace lightgrid
