// Every light at every pixel: what settings mean, and the truth.
#pragma once

#include <map>
#include <memory>

#include "session/technique_run.h"

namespace lightgrid {

// Pictures of one view, for techniques that share its surfaces: OpenGL's (`forward`) or those of the
// rasteriser in OpenCL
// (`visibility:lights=all`). Float; their own error against the oracle in double is measured apart.
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
  std::map<std::string, Image> pictures_;
};

}  // namespace lightgrid
