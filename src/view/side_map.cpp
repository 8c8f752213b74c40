#include "view/side_map.h"

#include <algorithm>

#include "passes/read_back.h"
#include "results/metrics.h"
#include "session/runs.h"

namespace lightgrid {

void MapOfSide::show_counts(SideMap wanted, Side& side, bool wait) {
  const size_t picture = side.pictures();
  const LitPairs* pairs = count_.result(picture, wait);
  if (!pairs && !count_.running()) {
    count_.start(read_listed_frame(side.run()), picture);
    pairs = count_.result(picture, wait);
  }
  if (!pairs) return;
  const auto& counts = wanted == SideMap::listed ? pairs->listed_of_pixel
                       : wanted == SideMap::lit  ? pairs->lit_of_pixel
                                                 : pairs->lost_of_pixel;
  const uint32_t top = wanted == SideMap::lost ? 1 : top_of_scale(counts);
  legend_ = fmt::format("{} a pixel: black 0, yellow {} or more; {} pairs listed, {} lit, {} lost",
                        map_names()[int(wanted)], top, pairs->listed, pairs->lit, pairs->lost);
  put(heat_map(side.width(), side.height(), counts, top), wanted, side);
}

void MapOfSide::show_difference(Side& side, const Image& reference) {
  Image image;
  RenderView& v = side.run().view();
  read_back(v, side.run().frame().image, image);
  const ImageError error = compare_images(image, reference);
  legend_ =
      fmt::format("difference from forward: black equal, blue 1e-7, red 1 of the brightest; greatest {:.2g}",
                  error.max_rel);
  put(difference_image(image, reference), SideMap::difference, side);
}

void MapOfSide::put(const Image& image, SideMap map, const Side& side) {
  if (image.width != width_ || image.height != height_) {
    width_ = image.width;
    height_ = image.height;
    texture_ = make_texture_2d(GL_RGBA32F, width_, height_);
  }
  glTextureSubImage2D(texture_.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, image.pixels.data());
  shown_ = map;
  shown_picture_ = side.pictures();
}

const Image& ReferencePicture::draw(const View& view, const Settings& settings) {
  if (run_ && same_model(model_, settings)) {
    run_->look(view);
  } else {
    model_ = with_model({}, settings);
    const EveryLight forward = every_light_technique(renderer_);
    run_ = std::make_unique<TechniqueRun>(renderer_, gpu_, view, model_, *forward.technique);
  }
  run_->run_frame(true);
  return run_->image();
}

}  // namespace lightgrid
