// Compares images with the oracle at a sample of pixels.
#pragma once

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"

namespace lightgrid::lab {

// Shades pixels of a view with the oracle, from the surfaces and the depth image of the last frame of
// `forward`.
class SurfaceOracle {
 public:
  // shadows: of the view's scene, kept by the caller; null: the oracle finds them itself, where lights cast.
  SurfaceOracle(RenderView& v, std::vector<float> depth, ShadowTruth* shadows = nullptr);

  // Pixels with an opaque surface and no blended one, ascending; the oracle can shade only these.
  const std::vector<uint32_t>& pixels() const { return pixels_; }
  uint64_t pixels_left_out() const { return left_out_; }  // blended

  // The `pixels` where neither a shadow nor a cone's hard edge turns on rounding; window: of lights in range.
  std::vector<uint32_t> decided(std::vector<uint32_t> pixels, bool window = true) const;

  // Radiance at `pixels` from every light that is not hidden there; window: with ranges.
  std::vector<glm::dvec3> shade(const std::vector<uint32_t>& pixels, bool window) const;

 private:
  RenderView& v_;
  std::vector<float> depth_;
  SurfaceImages surfaces_;
  std::vector<ViewLight> lights_;
  std::unique_ptr<ShadowTruth> own_shadows_;
  ShadowTruth* shadows_;
  std::vector<CastingTriangle> triangles_;  // where lights cast
  std::vector<uint32_t> masks_;             // masks of each pixel's surface; empty: full masks
  std::vector<uint32_t> pixels_;
  uint64_t left_out_ = 0;
};

// A row of these pixels of an image, for the metrics.
Image at_pixels(const Image& image, const std::vector<uint32_t>& pixels);

// At most `most` pixels of `among`, those where the images differ most; without pixels that are equal.
std::vector<uint32_t> most_different(const Image& image, const Image& reference,
                                     const std::vector<uint32_t>& among, size_t most);

// Both images against `radiance`, the oracle's at `pixels`, relative to the brightest channel of the
// reference.
OracleError oracle_error(const Image& image, const Image& reference, const std::vector<uint32_t>& pixels,
                         const std::vector<glm::dvec3>& radiance);

// How many pixels the oracle shades without ranges, where every light reaches each: `most`, fewer for more
// than 20,000 lights, or 200 that cast.
size_t affordable_samples(size_t most, const Scene& scene);

}  // namespace lightgrid::lab
