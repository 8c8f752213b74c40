// The window's contents: the two sides' images, and space for panels beside them. Drawn into a separate
// framebuffer, so that a screenshot does not depend on what covers the window.
#pragma once

#include <filesystem>

#include "renderer/renderer.h"

namespace lightgrid::app {

struct ScreenImage {
  GLuint texture = 0;   // linear RGBA
  bool is_map = false;  // shown without a tone map
};

class Screen {
 public:
  explicit Screen(Renderer& renderer);

  // Starts a frame of the window's size: clears and binds its framebuffer.
  void begin(int width, int height);
  // Draws into the left `picture_width` pixels, over the whole height. `line`: fraction of the picture's
  // width. `drawn`: the images' size; tone-mapped at that, then enlarged. Maps let through as much of what is
  // drawn already as their opacity leaves.
  void draw(const ScreenImage& left, const ScreenImage& right, double line, int picture_width,
            PixelGrid drawn, float map_opacity = 1);
  // Copies into the window's own framebuffer.
  void finish();

  void save(const std::filesystem::path& path);  // the last frame as a PNG

  float exposure = 1;   // pictures are multiplied by it before the tone map; maps are not
  bool filmic = false;  // pictures have the filmic curve (base/display.h)

 private:
  Renderer& renderer_;
  int width_ = 0, height_ = 0;
  PixelGrid small_size_;
  GlTexture image_, small_image_;  // small: of a picture that is enlarged
  GlFramebuffer framebuffer_, small_;
  GlSampler sampler_;
};

}  // namespace lightgrid::app
