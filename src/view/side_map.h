// The lights that a side's last frame listed, compared with the oracle, at one pixel and as maps over the
// picture; and the map of its difference from `forward`.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspect/inspect.h"
#include "reference/lit_set.h"
#include "results/metrics.h"
#include "session/technique_run.h"
#include "view/side.h"

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

// The colours of a map and their numbers. Black is 0.
struct MapScale {
  const Ramp* ramp = nullptr;
  std::string least, middle, most;  // at the ramp's ends and between; empty: not shown
};

class MapOfSide {
 public:
  // The map of the side's last picture, in progress or done. Only for pictures of full size with the camera
  // at rest; `wait`: waits until it is done. `reference`: draws `forward` on the same view; called for
  // `difference` alone.
  template <typename Reference>
  void follow(SideMap wanted, Side& side, bool wait, const Reference& reference) {
    if (shown_picture_ == side.pictures() && shown_ == wanted) return;
    if (wanted == SideMap::difference) {
      show_difference(side, reference());
    } else {
      show_counts(wanted, side, wait);
    }
  }

  bool shows(SideMap wanted, const Side& side) const {
    return shown_picture_ == side.pictures() && shown_ == wanted;
  }
  GLuint texture() const { return texture_.name(); }
  const std::string& legend() const { return legend_; }  // of the displayed map
  const MapScale& scale() const { return scale_; }

 private:
  void show_counts(SideMap wanted, Side& side, bool wait);
  void show_difference(Side& side, const Image& reference);
  void put(const Image& image, SideMap map, const Side& side);

  ListedCount count_;
  SideMap shown_ = SideMap::picture;
  size_t shown_picture_ = 0;
  int width_ = 0, height_ = 0;
  GlTexture texture_;
  std::string legend_;
  MapScale scale_;
};

// The picture of `forward`, with which both sides are compared.
class ReferencePicture {
 public:
  // Both outlive it.
  ReferencePicture(Renderer& renderer, GpuScene& gpu) : renderer_(renderer), gpu_(gpu) {}

  // The scene changed: lights may have moved.
  void scene_changed() { run_.reset(); }

  // Draws this view with the model of the side's settings. Every call shades every light at every pixel: slow
  // with many lights.
  const Image& draw(const View& view, const Settings& settings);

 private:
  Renderer& renderer_;
  GpuScene& gpu_;
  std::unique_ptr<TechniqueRun> run_;
  Settings model_;  // that run_ draws
};

}  // namespace lightgrid
