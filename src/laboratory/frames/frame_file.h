// Captured frames: a depth image, lights and a view as files, from `lightgrid capture` or another engine
// (docs/frames.md). A fault is an Error(input) of one line that names file, field and value. Sizes stated in
// a file are checked against the file's length before use.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "culling/light_culler.h"
#include "scene/camera.h"
#include "scene/view_lights.h"

namespace lightgrid::lab {

struct CapturedFrame {
  std::string name;  // name of its folder, or of its scene
  // clip_from_view as the frame has it: depth reversed or standard. near_m and far_m are informative.
  View view;
  int tile = 16;
  double surfaces_far_m = 0;  // bound of the distance of visible surfaces; 0: unknown
  std::vector<Light> lights;
  std::vector<float> depth;  // z/w of clip_from_view, row 0 at the bottom; may hold any float
};

// A grid as stored in a frame, with the settings that made it.
struct FrameGrid {
  HostGrid lists;
  int tile = 16;
  std::vector<float> slice_edges;               // inner edges, metres; empty for one slice
  std::vector<float> z_bin_edges;               // likewise; empty for no z-bins
  std::map<std::string, std::string> settings;  // as to_strings returns them
  // Each pixel's cell, row 0 at the bottom, in grids whose cells are no tiles and slices; no_cell: the pixel
  // reads no list. Empty: by tile and slice.
  std::vector<uint32_t> cell_of_pixel;
};
inline constexpr uint32_t no_cell = 0xffffffffu;

CapturedFrame read_frame(const std::filesystem::path& folder);

// The frame's own grid; absent without grid.json. Checked against the frame: number of cells, lists within
// the indices, indices of existing lights.
std::optional<FrameGrid> read_frame_grid(const std::filesystem::path& folder, const CapturedFrame& frame);

// Writes view.json, lights.json and depth.f32, and removes an older frame's files and grid; creates the
// folder if missing. As base/write_file.h's write_files: a full disk leaves the older frame as it was, and no
// error leaves files of both.
void write_frame(const std::filesystem::path& folder, const CapturedFrame& frame);

// Writes grid.json, grid.u32 and indices.u32; masks.u32 and z_bins.u32 if the grid has them. Likewise.
void write_frame_grid(const std::filesystem::path& folder, const FrameGrid& grid);

// The point and spot lights in view space, in the order of the grid's indices.
std::vector<ViewLight> local_lights(const CapturedFrame& frame);
std::vector<Light> local_world_lights(const CapturedFrame& frame);

// True if the near plane is at depth 1.
bool depth_is_reversed(const View& view);

// The depth image for the oracle (oracle/lit_set.h): positive on surfaces, 0 at the far plane of either
// depth direction. Otherwise values of clip_from_view.
std::vector<float> covered_depth(const CapturedFrame& frame);

}  // namespace lightgrid::lab
