#include "culling/light_culler.h"
#include "shared/light_grid.h"

namespace lightgrid {

ViewParams view_params(const View& view, int tile, int lights, int directional, glm::vec3 ambient) {
  const glm::dmat4& clip = view.clip_from_view;  // column, row
  ViewParams p{};
  p.orthographic = view.orthographic;
  // NDC x = 2 px / width - 1. Perspective: NDC x = clip[0][0] * (x / d) - clip[2][0], since w = d = -z.
  const double ndc_x_offset = view.orthographic ? clip[3][0] : -clip[2][0];
  const double ndc_y_offset = view.orthographic ? clip[3][1] : -clip[2][1];
  p.slope_x_scale = float(2.0 / (view.width * clip[0][0]));
  p.slope_x_offset = float((-1.0 - ndc_x_offset) / clip[0][0]);
  p.slope_y_scale = float(2.0 / (view.height * clip[1][1]));
  p.slope_y_offset = float((-1.0 - ndc_y_offset) / clip[1][1]);
  if (view.orthographic) {
    // depth = clip[2][2] * z + clip[3][2], z = -d
    p.depth_a = float(1.0 / clip[2][2]);
    p.depth_b = float(clip[3][2]);
  } else {
    // depth = (clip[2][2] * z + clip[3][2]) / d
    p.depth_a = float(clip[2][2]);
    p.depth_b = float(clip[3][2]);
  }
  p.near_distance = float(view.near_m);
  p.width = view.width, p.height = view.height;
  p.tile_size = tile;
  p.tiles_x = (view.width + tile - 1) / tile, p.tiles_y = (view.height + tile - 1) / tile;
  p.bins_x = (p.tiles_x + BIN_TILES - 1) / BIN_TILES, p.bins_y = (p.tiles_y + BIN_TILES - 1) / BIN_TILES;
  p.light_count = lights, p.directional_count = directional;
  p.ambient_r = ambient.r, p.ambient_g = ambient.g, p.ambient_b = ambient.b;
  return p;
}

}  // namespace lightgrid
