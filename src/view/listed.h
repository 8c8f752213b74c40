// The lights that a side's last frame listed, compared with the oracle: as maps over the picture, and at one
// pixel.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "session/technique_run.h"
#include "inspect/inspect.h"
#include "reference/lit_set.h"
#include "view/controls.h"

namespace lightgrid {

// The oracle's input for a frame, copied from the devices.
struct ListedFrame {
  View view;
  std::vector<float> depth;
  std::vector<ViewLight> lights;  // point and spot lights, in the lists' order
  std::vector<int> scene_lights;  // their indices in the scene
  ListedLights lists;
};
ListedFrame read_listed_frame(TechniqueRun& run);

// A light at a pixel.
struct PixelLight {
  int light = 0;  // index in the scene
  std::string name;
  double distance_m = 0;  // from the surface
  double radius_m = 0;
  bool listed = false, lit = false;
  std::string test;     // that kept or dropped it (inspect/inspect.h); empty: no light grid was culled
  double margin_m = 0;  // of that test
};

struct PixelLights {
  bool covered = false;   // shows a surface
  double distance_m = 0;  // of the surface along the view axis
  int listed = 0, lit = 0, lost = 0;
  // Listed or lit ones: lost first, then lit, then the rest; each group by distance. Then, with a light grid,
  // the nearest to the cell of those that culling dropped.
  std::vector<PixelLight> lights;
};
PixelLights lights_at(const ListedFrame& frame, const Scene& scene, PicturePixel pixel);

// What culling decided about each light at the pixel: the frame's depth is culled once more, with the
// run's settings. Empty if the technique's plan has no light grid.
std::optional<PixelInspection> inspect_pixel(TechniqueRun& run, const std::vector<float>& depth,
                                             PicturePixel pixel);

// Adds the deciding tests and their margins, and up to `most_dropped` dropped lights.
void add_margins(PixelLights& lights, const PixelInspection& inspection, const Scene& scene,
                 int most_dropped);

// "lamp 3 1.20 of 3.00 m" and "kept by aabb +0.430 m": the two lines of a light. The second may be empty.
std::array<std::string, 2> lines_of(const PixelLight& light);

// Counts every pixel's lights on other threads: takes about a second for a full picture and a thousand
// lights.
class ListedCount {
 public:
  void start(ListedFrame frame, size_t picture);  // `picture`: its number
  bool running() const { return running_.valid(); }
  // The counts of the last started picture, when done; null before. `wait`: waits for them.
  const LitPairs* result(size_t picture, bool wait);
  size_t picture() const { return picture_; }

 private:
  std::future<LitPairs> running_;
  std::optional<LitPairs> done_;
  size_t picture_ = 0, done_picture_ = 0;
};

}  // namespace lightgrid
