// One view of one set of lights, as the culling kernels read it.
#pragma once

#include "shared/language.h"

#if !defined(__OPENCL_VERSION__)
namespace lightgrid {
#endif

typedef struct CullParams {
  // View space is turned so that its third axis d is the distance along the view axis (d = -z).
  // Its axes x, y and d are unit directions in the world.
  float x_axis_x, x_axis_y, x_axis_z;
  float y_axis_x, y_axis_y, y_axis_z;
  float d_axis_x, d_axis_y, d_axis_z;
  float eye_x, eye_y, eye_z;                 // relative to the lights' origin, metres
  float eye_rest_x, eye_rest_y, eye_rest_z;  // rounding error of the floats above
  // Slope x / d or y / d at pixel coordinate p; orthographic: x or y itself, metres (view_params.h).
  float slope_x_scale, slope_x_offset;
  float slope_y_scale, slope_y_offset;
  // The inverse: slope * scale + offset is the tile coordinate (tile column or row, with a fraction).
  float tile_x_scale, tile_x_offset;
  float tile_y_scale, tile_y_offset;
  float inset;  // pixels by which a cell is smaller than its pixels: 0.5 if it contains pixel
                // centres only, else 0
  // Depth value to distance: perspective depth_b / ((depth + depth_a) + depth_a_rest), orthographic
  // (depth_b - depth) * depth_a.
  float depth_a, depth_a_rest, depth_b;
  float depth_step;     // one step of the depth format, if coarser than the slack covers; else 0
  float near_distance;  // from the eye to the near plane
  // Slack for the rounding of tile sides (docs/hard_cases.md#slack): perspective, of a
  // distance; orthographic, metres.
  float side_slack, side_slack_m;
  float cone_slack_m;                                // rounding of a spot's uploaded position
  uint orthographic;                                 // 0 or 1
  uint standard_depth;                               // 1: near 0, far 1; 0: reversed
  uint width, height;                                // view, pixels
  uint tile_size, tiles_x, tiles_y, bins_x, bins_y;  // pixels a side; counts (shared/light_grid.h)
  uint regions_x, regions_y, region_bins;  // lanes shape: a region is region_bins x region_bins bins
  uint slices;                             // cells a tile
  uint light_count, light_stride;          // floats from a coordinate of all lights to the next one
  uint depth_row, depth_first;  // depth input: floats from row to row, index of the view's lower left sample
  uint pool_batches, staging_units;  // capacity, in batches of 16 candidates and in units of 16 indices
  uint index_capacity;               // entries for which the grid has room
} CullParams;

#if !defined(__OPENCL_VERSION__)
}  // namespace lightgrid
#endif
