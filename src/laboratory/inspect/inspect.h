// Why a light is or is not in the list of a pixel, and where lights are listed but do not light the image.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "frames/frame_culler.h"
#include "measures/picture_pixel.h"
#include "measures/results.h"
#include "oracle/lit_set.h"
#include "oracle/seen_pairs.h"

namespace lightgrid::lab {

// How far, in metres, a light's sphere (or cone) reaches into each test's bound of the cell; negative: the
// distance by which it misses. In double, for the cell that the culler used.
struct TestMargins {
  double interval = 0;           // the cell's two distances
  double planes = 0;             // its four sides
  double aabb = 0;               // its box in view space
  double sphere = 0;             // the sphere around that box
  double exact = 0;              // the convex cell itself
  std::optional<double> cone;    // a spot's cone, up to a half-angle of 90 degrees, against that sphere
  std::optional<double> pieces;  // the parts of the cell that halfz, halfz-modified and mask32 distinguish
};

// The verdict on the shadow of a casting light at the pixel.
struct ShadowVerdict {
  SightAnswer truth;
  std::string by;                 // name of the instance that hides it; empty: several blended ones do
  bool shaded_as_hidden = false;  // by the frame

  bool leaked() const { return truth.sight == Sight::hidden && !shaded_as_hidden; }
  bool acned() const { return truth.sight == Sight::seen && shaded_as_hidden; }
};

struct DirectionalShadow {
  int light = 0;  // in the frame
  ShadowVerdict shadow;
};

struct LightVerdict {
  uint32_t index = 0;  // in the lists
  int light = 0;       // in the frame
  double radius_m = 0;
  double distance_m = 0;  // from the pixel's surface
  bool listed = false;
  std::string test;     // among the tests in use: the one that dropped it, or the one with the least margin
  double margin_m = 0;  // margin of that test
  TestMargins margins;
  bool touches = false;                 // some point of the convex cell may be lit, cone included
  bool lit = false;                     // by the oracle, at this pixel
  int lit_pixels = 0;                   // lit pixels of the cell
  std::optional<glm::dvec3> share;      // that effects let through here, of a lit light
  std::optional<ShadowVerdict> shadow;  // by add_shadows
};

struct PixelInspection {
  int x = 0, y = 0;  // row 0 at the bottom, as in memory
  float depth = 0;
  double distance_m = 0;  // along the view axis; infinite for background
  bool covered = false;   // shows a surface
  int cell_x = 0, cell_y = 0, slice = 0;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // the tile's pixels, end exclusive
  double near_m = 0, far_m = 0;        // bounds of the cell; near > far if none of its pixels shows a surface
  int covered_pixels = 0;              // covered pixels of the cell
  int directional = 0;                 // directional lights: they reach every pixel and are in no list
  std::vector<LightVerdict> lights;    // listed ones by index, then dropped ones, nearest to the cell first
  std::vector<DirectionalShadow> directional_shadows;  // by add_shadows
  int listed() const;
  int lit() const;
  int lost() const;  // lit but not listed
};

// `intervals`: FrameCuller's. `place` lies within the image.
PixelInspection inspect_pixel(const CapturedFrame& frame, const FrameGrid& grid,
                              const std::vector<DepthInterval>& intervals, const Settings& settings,
                              PicturePixel place);

// Sets the verdicts on the shadows of the lights that cast and are lit at the pixel; none if it shows no
// triangle. Returns whether the frame leaks or acnes a light.
bool add_shadows(PixelInspection& pixel, const Scene& scene, const PixelShadows& shadows);

// `hidden by node 3 "column" triangle 12, 1.250 m from the light; the frame shades it: LEAKED`.
std::string shadow_words(const ShadowVerdict& shadow, const Light& light);

// Pixels are counted from the upper left. Both omit dropped lights after the first `max_dropped`, but never lost ones.
std::string inspection_table(const CapturedFrame& frame, const PixelInspection& pixel, int max_dropped);
std::string inspection_json(const CapturedFrame& frame, const PixelInspection& pixel, const FrameGrid& grid,
                            int max_dropped);

// Maps of listed lights, listed but unlit ones, and lost ones.
struct InspectionMaps {
  PairCounts pairs;
  uint64_t covered = 0;                                 // pixels with a surface
  uint32_t top = 1;                                     // end of the scale of the three maps
  std::vector<uint32_t> listed, false_positives, lost;  // lights per pixel, row 0 at the bottom
  std::vector<uint32_t> leaked, acned;                  // likewise; empty without shadows
};

// shadows: of the frame; null: none.
InspectionMaps inspection_maps(const CapturedFrame& frame, const FrameGrid& grid,
                               const PairShadows* shadows = nullptr);

// "pairs" as in results.json, and how many pixels show a surface.
std::string inspection_json(const CapturedFrame& frame, const InspectionMaps& maps, const FrameGrid& grid);

// Writes listed.png, false_positives.png and lost.png, and with shadows leaked.png and acned.png; creates the
// folder if missing. Black is 0; the scale ends at `top`.
void write_inspection_maps(const std::filesystem::path& folder, const CapturedFrame& frame,
                           const InspectionMaps& maps);

}  // namespace lightgrid::lab
