// The library as an engine, for tests that derive from it to plant a fault in what it returns.
#pragma once

#include "verify/engine.h"

namespace lightgrid::lab::verify {

struct LibraryEngine : CullEngine {
  std::unique_ptr<CullEngine> library = device_engine("");

  std::string name() const override { return "the library with a fault"; }
  bool is_the_library() const override { return false; }
  HostGrid cull(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    return library->cull(options, view, lights, bounds);
  }
  std::vector<DepthInterval> depth_bounds(const CullerOptions& options, const CullView& view,
                                          const DepthImage& depth, bool blend) override {
    return library->depth_bounds(options, view, depth, blend);
  }
  HostGrid cull_depth(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    return library->cull_depth(options, view, lights, depth, blend);
  }
};

}  // namespace lightgrid::lab::verify
