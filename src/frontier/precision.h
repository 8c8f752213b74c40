// The error of brute force itself: float against the oracle in double.
#pragma once

#include <memory>
#include <optional>

#include "compare/run_technique.h"
#include "frontier/brute_force.h"

namespace lightgrid {

// On the surfaces that OpenGL shows, at a sample of opaque pixels, with the ranges and the BRDF of `common`.
// For techniques with surfaces of their own the sample holds the pixels where both show the same triangle,
// and the figure contains what their texture filter does otherwise.
class Precision {
 public:
  // Without OpenGL nothing is measured: figures are NaN. All outlive it.
  Precision(Renderer& renderer, GpuScene& gpu, const View& view, const Settings& common, size_t samples);

  // `own`: the pictures of the family whose surfaces are the rasteriser's; null: not needed.
  void measure(const View& view, BruteForce& opengl, BruteForce* own);
  const ErrorFigures& of_opengl() const { return of_opengl_; }
  const ErrorFigures& of_own_surfaces() const { return of_own_; }

 private:
  Renderer& renderer_;
  Settings common_;
  size_t samples_;
  std::optional<TechniqueRun> forward_, visibility_;
  ErrorFigures of_opengl_, of_own_;
};

}  // namespace lightgrid
