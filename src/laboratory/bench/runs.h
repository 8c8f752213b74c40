// The timed work: a frame's culling, and the rasterising of a scene, each with one set of settings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/standard_frames.h"
#include "culling/light_culler.h"
#include "frames/frame_culler.h"
#include "plan/settings.h"
#include "raster/raster_view.h"
#include "scene/scene.h"

namespace lightgrid::lab {

class CullingRun {
 public:
  // Uploads the lights and runs twice, so that kernels are built and memory has its size. Slices and z-bins
  // are used only if set by name. Runs of one frame share its depth, so that the cache is equally warm for
  // all.
  CullingRun(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const cl::Buffer& depth,
             const Settings& settings);

  // Depth bounds, cull and the finished grid, with one wait at the end.
  void run();

  // Other transfers that a frame may need, each with its own wait.
  void upload_lights();
  void download_grid();  // cells and indices into host memory, and masks and z-bins if there are any

  const Settings& settings() const { return settings_; }  // as used: one slice if the grid has none
  const LightGrid& grid() const { return grid_; }
  const cl::Buffer& depth() const { return depth_; }
  size_t depth_bytes() const { return depth_bytes_; }

 private:
  ClDevice& device_;
  Settings settings_;
  std::vector<CullLight> lights_;
  std::unique_ptr<LightCuller> culler_;
  ClGridStorage storage_;
  cl::Buffer depth_;
  size_t depth_bytes_ = 0;
  LightGrid grid_;
  std::vector<char> host_;
};

// Names of the rows that a case of the rasteriser may have.
const std::vector<std::string>& raster_rows();

// The work of one run, from which the costs of its kernels follow.
struct KernelWork {
  size_t pixels = 0, tiles = 0, cells = 0, bins = 0, lights = 0;  // a tile has one cell a slice
  size_t indices = 0, index_bytes = 0;                            // entries of the grid's lists, and their
                                                                  // total size
  size_t mask_bytes = 0, z_bins = 0;
  bool exact = false, cones = false;
  // The rasteriser has these (its tiles are 64 x 64 pixels): vertices and triangles of all instances, drawn
  // or not, and RasterCounts.
  size_t vertices = 0, triangles = 0, clusters = 0, records = 0, tile_entries = 0;
};

// A built-in scene's opaque and masked triangles. Masks are not looked up: masked triangles are drawn whole.
class RasterRun {
 public:
  // The scene's first camera. Draws twice, so that kernels are built and room has its size.
  RasterRun(ClDevice& device, ProgramCache& programs, const Scene& scene, int width, int height,
            const Settings& settings);

  // Vertices to the visibility buffer, with the wait in which the rasteriser reads its counters.
  void run() { raster_.draw(); }

  KernelWork work() const;  // work of the last run

 private:
  RasterScene geometry_;
  RasterView raster_;
  KernelWork scene_;
};

}  // namespace lightgrid::lab
