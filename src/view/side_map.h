// A map over one side's picture: lights listed, lit and lost, or the difference from `forward`.
#pragma once

#include <memory>
#include <string>

#include "results/metrics.h"
#include "session/technique_run.h"
#include "view/listed.h"
#include "view/side.h"

namespace lightgrid {

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
