// The pixel's cell of the light grid.
//   SLICES: tiles are cut into depth slices.
#include "shared/light_grid.h"
#include "shared/slices.h"
#include "shaders/common/fragment_place.glsl"

uint cell_at(uvec2 pixel, float depth) {
  uint cell = cell_of_pixel(pixel.x, pixel.y, view.tile_size, view.tiles_x);
#ifdef SLICES
  cell = cell_in_slice(cell, slice_of_key(-depth), view.tiles_x, view.tiles_y);
#endif
  return cell;
}

uint cell_here() { return cell_at(uvec2(gl_FragCoord.xy), fragment_place().z); }
