// The lights that a side's last frame listed, compared with the oracle, at one pixel and as maps over the
// picture; and the maps of its difference from `forward`, and of
// pixels whose samples see several surfaces.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "inspect/inspect.h"
#include "measures/metrics.h"
#include "view/pair_count.h"
#include "view/side.h"

namespace lightgrid::app {

// The lights at a pixel that the frame listed or the oracle finds lit: lost first, then lit, then the rest;
// each group by distance. Tests are empty. Of the place only what a pixel has without a light grid is set.
lab::PixelInspection lights_at(const ListedFrame& listed, lab::PicturePixel pixel);

// The decision of culling about each light at the pixel: the frame's depth is culled once more, with the
// run's settings. Empty if the technique's plan has no light grid.
std::optional<lab::PixelInspection> inspect_pixel(TechniqueRun& run, const lab::CapturedFrame& frame,
                                                  lab::PicturePixel pixel);

// Adds the deciding tests and their margins, and up to `max_dropped` dropped lights, those nearest to the
// cell first.
void add_margins(lab::PixelInspection& lights, const lab::PixelInspection& inspection, int max_dropped);

// The lines of a light: "lamp 3 1.20 of 3.00 m", "kept by aabb +0.430 m", and shadow_words if it casts a
// shadow. The last two may be empty.
std::array<std::string, 3> lines_of(const lab::LightVerdict& verdict, const Scene& scene);
std::array<std::string, 2> lines_of(const lab::DirectionalShadow& verdict, const Scene& scene);
// Sorts: lost lights, those that the frame leaks or acnes, hidden ones, all others.
void put_hidden_first(lab::PixelInspection& pixel);
// "3 of 5 that cast are hidden"; empty if none casts.
std::string shadows_at_pixel(const lab::PixelInspection& pixel);

// The colours of a map and their numbers. Black is 0.
struct MapScale {
  const lab::Ramp* ramp = nullptr;
  std::string least, middle, most;  // at the ramp's ends and between; empty: not shown
};

// A map of a side; `light` of the scene: of its pairs alone, where pairs are counted.
struct MapChoice {
  SideMap map = SideMap::picture;
  std::optional<int> light;
  bool operator==(const MapChoice&) const = default;
};

class MapOfSide {
 public:
  // It outlives this.
  explicit MapOfSide(lab::SceneOcclusion& occlusion) : occlusion_(occlusion), count_(occlusion) {}

  // The map of the side's last picture, in progress or done. Only for pictures of full size with the camera
  // at rest; `wait`: waits until it is done. `reference`: draws `forward` on the same view; called for
  // `difference` alone.
  template <typename Reference>
  void follow(const MapChoice& wanted, Side& side, bool wait, const Reference& reference) {
    if (shows(wanted, side)) return;
    if (wanted.map == SideMap::difference) {
      show_difference(wanted, side, reference());
    } else if (wanted.map == SideMap::edges) {
      show_edges(wanted, side);
    } else {
      show_counts(wanted, side, wait);
    }
  }
  // Before the scene changes (PairCount::leave_scene).
  void leave_scene() { count_.leave_scene(); }

  bool shows(const MapChoice& wanted, const Side& side) const {
    return shown_picture_ == side.pictures() && shown_ == wanted;
  }
  bool counts() const { return count_.running(); }
  double progress() const { return count_.progress(); }
  GLuint texture() const { return texture_.name(); }
  const std::string& legend() const { return legend_; }  // legend of the displayed map
  const MapScale& scale() const { return scale_; }

 private:
  void show_counts(const MapChoice& wanted, Side& side, bool wait);
  void show_edges(const MapChoice& wanted, Side& side);
  void show_difference(const MapChoice& wanted, Side& side, const Image& reference);
  void put(const Image& image, const MapChoice& map, const Side& side);

  lab::SceneOcclusion& occlusion_;
  PairCount count_;
  MapChoice shown_;
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

}  // namespace lightgrid::app
