// Images held against the double-precision oracle at a sample of pixels.
#pragma once

#include "compare/oracle.h"

namespace lightgrid {

// What the oracle shades at some pixels of a view, out of the surfaces and the depth image of its last frame of `forward`.
class SurfaceOracle {
 public:
  SurfaceOracle(RenderView& v, const std::vector<float>& depth);

  // Those that show a surface which no blended one covers, ascending; others the oracle cannot shade.
  const std::vector<uint32_t>& pixels() const { return pixels_; }
  uint64_t pixels_left_out() const { return left_out_; }  // blended

  // Radiance at `pixels`, of every light; window: with its range.
  std::vector<glm::dvec3> shade(const std::vector<uint32_t>& pixels, bool window) const;

 private:
  RenderView& v_;
  const std::vector<float>& depth_;
  SurfaceImages surfaces_;
  std::vector<ViewLight> lights_;
  std::vector<uint32_t> pixels_;
  uint64_t left_out_ = 0;
};

// The pixels of `among` at which the images differ most, at most `most` of them; equal ones are not named.
std::vector<uint32_t> most_different(const Image& image, const Image& reference, const std::vector<uint32_t>& among, size_t most);

// Both images against `radiance`, the oracle's at `pixels`, over the brightest channel of the reference.
OracleError oracle_error(const Image& image, const Image& reference, const std::vector<uint32_t>& pixels,
                         const std::vector<glm::dvec3>& radiance);

// How many pixels the oracle may shade without ranges, where every light reaches each: up to `most`, fewer where there are
// more than 20,000 lights.
size_t affordable_samples(size_t most, size_t lights);

}  // namespace lightgrid
