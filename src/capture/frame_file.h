// Captured frames: a depth image, lights and a view as files, from `lightgrid capture` or another engine
// (docs/frames.md). What is wrong in one is an Error(input) of one line that names file, field and value; no
// file's claim about a size is believed before the file is seen to have it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/view_lights.h"
#include "culling/light_culler.h"

namespace lightgrid {

struct CapturedFrame {
  std::string name;  // of its folder, or of its scene
  // clip_from_view as the frame has it: depth reversed or standard. near_m and far_m are told, not used.
  View view;
  int tile = 16;
  double surfaces_far_m = 0;  // no surface in view can be farther; 0: nobody knows
  std::vector<Light> lights;
  std::vector<float> depth;  // z/w of clip_from_view, row 0 at the bottom; any float may stand here
};

// A grid as it lies in a frame, with what made it.
struct FrameGrid {
  HostGrid lists;
  int tile = 16;
  std::vector<float> slice_edges;               // inner edges, metres; empty for one slice
  std::vector<float> z_bin_edges;               // likewise; empty for no z-bins
  std::map<std::string, std::string> settings;  // as to_strings gives them
};

CapturedFrame read_frame(const std::filesystem::path& folder);

// The frame's own grid, which may be absent: then no grid.json is there. Checked against the frame: cells of
// its size, lists that lie within the indices, indices that are lights.
std::optional<FrameGrid> read_frame_grid(const std::filesystem::path& folder, const CapturedFrame& frame);

// view.json, lights.json and depth.f32, into a folder made where it is missing.
void write_frame(const std::filesystem::path& folder, const CapturedFrame& frame);

// grid.json, grid.u32 and indices.u32, likewise; masks.u32 and z_bins.u32 where the grid has such.
void write_frame_grid(const std::filesystem::path& folder, const FrameGrid& grid);

// The point and spot lights as the view sees them, in the order that indices count them.
std::vector<ViewLight> local_lights(const CapturedFrame& frame);
std::vector<Light> local_world_lights(const CapturedFrame& frame);

// Is the near plane at depth 1?
bool depth_is_reversed(const View& view);

// The depth image as the oracle reads it (reference/lit_set.h): positive where a surface is, 0 at the far
// plane of either kind of depth. Values stay those of clip_from_view.
std::vector<float> covered_depth(const CapturedFrame& frame);

}  // namespace lightgrid
