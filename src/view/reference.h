// The picture of `forward`, with which both sides are compared.
#pragma once

#include <memory>

#include "session/technique_run.h"

namespace lightgrid {

class ReferencePicture {
 public:
  // Both outlive it.
  ReferencePicture(Renderer& renderer, GpuScene& gpu) : renderer_(renderer), gpu_(gpu) {}

  // The scene changed: lights may have moved.
  void scene_changed() { run_.reset(); }

  // Draws this view with the side's BRDF and ranges. Every call shades every light at every pixel: slow with
  // many lights.
  const Image& draw(const View& view, const Settings& settings);

 private:
  Renderer& renderer_;
  GpuScene& gpu_;
  std::unique_ptr<TechniqueRun> run_;
  Brdf brdf_ = Brdf::ggx;
  LightRanges ranges_;
};

}  // namespace lightgrid
