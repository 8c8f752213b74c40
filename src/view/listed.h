// The lights that a side's last frame listed, compared with the oracle: as maps over the picture, and at one
// pixel.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "inspect/inspect.h"
#include "reference/lit_set.h"
#include "session/technique_run.h"
#include "view/controls.h"

namespace lightgrid {

// The last frame of a side, copied from the devices, with the lights that it listed.
struct ListedFrame {
  CapturedFrame frame;
  std::vector<ViewLight> lights;  // point and spot lights, in the lists' order
  ListedLights lists;
};
ListedFrame read_listed_frame(TechniqueRun& run);

// The lights at a pixel that the frame listed or the oracle finds lit: lost first, then lit, then the rest;
// each group by distance. Tests are empty. Of the place only what a pixel has without a light grid is set.
PixelInspection lights_at(const ListedFrame& listed, PicturePixel pixel);

// What culling decided about each light at the pixel: the frame's depth is culled once more, with the
// run's settings. Empty if the technique's plan has no light grid.
std::optional<PixelInspection> inspect_pixel(TechniqueRun& run, const CapturedFrame& frame,
                                             PicturePixel pixel);

// Adds the deciding tests and their margins, and up to `most_dropped` dropped lights, those nearest to the
// cell first.
void add_margins(PixelInspection& lights, const PixelInspection& inspection, int most_dropped);

// "lamp 3 1.20 of 3.00 m" and "kept by aabb +0.430 m": the two lines of a light. The second may be empty.
std::array<std::string, 2> lines_of(const LightVerdict& verdict, const Scene& scene);

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
