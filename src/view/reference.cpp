#include "view/reference.h"

namespace lightgrid {

const Image& ReferencePicture::draw(const View& view, const Settings& settings) {
  if (run_ && brdf_ == settings.brdf && ranges_ == settings.ranges) {
    run_->look(view);
  } else {
    brdf_ = settings.brdf, ranges_ = settings.ranges;
    Settings plain;
    plain.brdf = brdf_, plain.ranges = ranges_;
    run_ = std::make_unique<TechniqueRun>(renderer_, gpu_, view, plain, find_technique("forward"));
  }
  run_->run_frame(true);
  return run_->image();
}

}  // namespace lightgrid
