// Why a light stands in the list of a pixel, or does not; and where over the image lights are listed in vain.
#pragma once

#include <optional>
#include <string>

#include "capture/frame_culler.h"

namespace lightgrid {

// How far, in metres, a light's sphere (or cone) reaches into what a test takes the cell for; negative: that
// much too far away. In double, of the cell that the culler saw.
struct TestMargins {
  double interval = 0;           // the cell's two distances
  double planes = 0;             // its four sides
  double aabb = 0;               // its box in view space
  double sphere = 0;             // the sphere around that box
  double exact = 0;              // the convex cell itself
  std::optional<double> cone;    // a spot's cone, up to a half-angle of 90 degrees, against that sphere
  std::optional<double> pieces;  // the parts of the cell that halfz, halfz-modified and mask32 tell apart
};

struct LightVerdict {
  uint32_t index = 0;     // as lists count
  int light = 0;          // as the frame counts
  double distance_m = 0;  // from the pixel's surface
  bool listed = false;
  std::string test;     // of the tests in use: the one that dropped it, or the one that came closest to
  double margin_m = 0;  // that test's
  TestMargins margins;
  bool touches = false;  // the convex cell, cone included: some point of the cell may be lit
  bool lit = false;      // by the oracle, at this pixel
  int lit_pixels = 0;    // of the cell
};

struct PixelInspection {
  int x = 0, y = 0;
  float depth = 0;
  double distance_m = 0;  // along the view axis; infinite where nothing is
  bool covered = false;   // a surface is there
  int cell_x = 0, cell_y = 0, slice = 0;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // the tile's pixels, the last ones not included
  double near_m = 0, far_m = 0;        // of the cell; near > far where no pixel of it shows a surface
  int covered_pixels = 0;              // of the cell
  int directional = 0;                 // lights that reach every pixel and stand in no list
  std::vector<LightVerdict> lights;  // listed ones by index, then dropped ones, the nearest to the cell first
  int listed() const;
  int lit() const;
  int lost() const;  // lit but not listed
};

// `intervals`: FrameCuller's. x and y lie within the image.
PixelInspection inspect_pixel(const CapturedFrame& frame, const FrameGrid& grid,
                              const std::vector<DepthInterval>& intervals, const Settings& settings, int x,
                              int y);

// Both leave out dropped lights after the first `most_dropped`; lost ones are never left out.
std::string inspection_table(const CapturedFrame& frame, const PixelInspection& pixel, int most_dropped);
std::string inspection_json(const CapturedFrame& frame, const PixelInspection& pixel, const FrameGrid& grid,
                            int most_dropped);

}  // namespace lightgrid
