// Every light at every pixel: what settings mean, and the truth. And the error of brute force itself, and of
// pictures, against the oracle in double at a sample of pixels.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <vector>

#include "accuracy/shadow_truth.h"
#include "frontier/record.h"
#include "run/frames.h"

namespace lightgrid::lab {

// The truth that a sweep's pictures are compared with. Where lights cast, all lights keep their ranges unless
// `own_ranges` says otherwise, so that the error of ranges does not cover that of shadows. Where the settings
// also give shadows a source (shadow-source, or shadow-rays), lights that cast are spheres. areas: it is the
// mean over pixels' areas; lights then keep their ranges for the same reason.
FrontierTruth chosen_truth(const Settings& common, bool casts, std::optional<bool> own_ranges = {},
                           bool areas = false);

// Returns whether the oracle can judge a pair's shadow: not where a light is partly hidden, or a pixel's
// lights share one estimate.
bool counts_shadow_pairs(const Settings& settings, const FrontierTruth& truth);

// The view at `scale` times its size, of which the part from pixel (x, y) of the view, of so many of its
// pixels.
View part_of_view(const View& view, int x, int y, int width, int height, int scale);

// Pictures of one view, for techniques that share its surfaces: OpenGL's (`forward`) or those of the
// rasteriser in OpenCL (`visibility:lights=all`). Float; their own error against the oracle in double is
// measured apart.
class BruteForce {
 public:
  // `common`: the settings that all points share. All outlive it.
  BruteForce(Renderer& renderer, GpuScene& gpu, const Settings& common, const FrontierTruth& truth,
             bool own_surfaces);

  void look(const View& view);  // forgets the pictures of the view before

  // With the BRDF, ranges and window of `settings`, and exact shadows of points, or of spheres: the truth's,
  // or those of `settings`. With their samples, where the truth is of pixels' areas; else of pixels' centres.
  const Image& picture(const Settings& settings);
  Image draw(const Settings& settings);  // the same, not kept
  // With exact shadows of points.
  const Image& picture_of_points(const Settings& settings);
  const Image& truth();
  // Draws the truth of pixels' centres, frame after frame.
  std::unique_ptr<TechniqueRun> truth_run(const View& view) const;
  // For a reference of areas, which is the same for both kinds of surfaces.
  void take_truth(const Image& of_areas) { of_areas_ = of_areas; }
  double brightest();       // channel of the truth
  const Image& authored();  // the truth whose lights have the ranges of `common`

 private:
  Settings meaning(const Settings& settings, double source_m) const;
  Settings meaning_of_truth() const;
  const Image& kept(const Settings& meaning);
  Image drawn(const Settings& meaning);
  Image mean_over_areas(const Settings& meaning);

  Renderer& renderer_;
  GpuScene& gpu_;
  Settings common_;
  FrontierTruth truth_;
  const Technique& technique_;
  View view_;
  std::shared_ptr<TargetPool> pool_;
  std::list<std::pair<Settings, Image>> pictures_;  // with their meanings
  std::optional<Image> of_areas_;                   // the truth, where it is of areas
};

// On the surfaces that OpenGL shows, at opaque pixels, with the BRDF of `common`. For techniques with
// surfaces of their own the sample holds the pixels where both show the same triangle, and the figures
// contain what their texture filter does otherwise. Where lights cast, the sample holds the pixels where no
// shadow turns on rounding.
class Precision {
 public:
  // Without OpenGL nothing is measured: figures are NaN. All outlive it. `pairs`: of pixel and light that the
  // oracle may shade on a view.
  Precision(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& common,
            const FrontierTruth& truth, size_t pairs);

  // `own`: the pictures of the family whose surfaces are the rasteriser's; null: not needed. `seed`: of the
  // random pixels. `shadows`: of the scene.
  void measure(const View& view, BruteForce& opengl, BruteForce* own, uint64_t seed, ShadowTruth& shadows);

  // Brute force with the ranges of `common` in float against the same in double, with shadows of points.
  const ImageError& of(bool own_surfaces) const { return samples_[own_surfaces].precision; }
  // A picture of that view against the truth in double. None where the truth's lights are spheres, or it is
  // of areas.
  std::optional<SampledErrors> in_double(const Image& picture, bool own_surfaces) const;

 private:
  struct Sample {
    std::vector<uint32_t> pixels;
    std::vector<glm::dvec3> truth;        // every light, no range
    std::vector<glm::dvec3> float_truth;  // the same from float
    ImageError precision, truth_in_float;
  };

  void judge(Sample& sample, BruteForce& brute, const std::vector<glm::dvec3>& with_ranges) const;

  Renderer& renderer_;
  Settings common_;
  FrontierTruth truth_;
  size_t pairs_;
  double brightest_ = 0;  // channel of the truth on OpenGL's surfaces
  std::optional<TechniqueRun> opengl_, visibility_;
  Sample samples_[2];  // OpenGL's surfaces, then the rasteriser's
};

// A random one of each of `count` equal runs of `pixels`; all of them if there are no more. If a share f of
// the pixels is of some kind, the sample holds none of it with a probability of at most (1 - f)^count.
std::vector<uint32_t> random_pixels(const std::vector<uint32_t>& pixels, size_t count, uint64_t seed);

}  // namespace lightgrid::lab
