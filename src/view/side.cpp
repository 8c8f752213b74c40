#include "view/side.h"

#include "base/error.h"
#include "base/timer.h"

namespace lightgrid {

bool Side::choose(const SideControls& wanted, const View& view) {
  const auto settings = to_strings(wanted.settings);
  if (run_ && technique_ == wanted.technique && settings_ == settings) return false;
  if (!run_ || technique_ != wanted.technique) timings_.clear();
  technique_ = wanted.technique;
  settings_ = settings;
  problem_.clear();
  stale_ = true;
  try {
    auto run = std::make_unique<TechniqueRun>(renderer_, gpu_, view, wanted.settings,
                                              find_technique(wanted.technique));
    run->prepare();
    run_ = std::move(run);
  } catch (const Error& error) {
    if (!run_) throw;
    problem_ = error.what();
    return false;
  }
  return true;
}

void Side::look(const View& view, const SceneChanges& changes) {
  run_->look(view, changes);
  stale_ = true;
}

bool Side::draw(bool again, bool measure_passes) {
  if (!problem_.empty() || !(stale_ || again)) return false;
  RenderView& v = run_->view();
  v.timer.clear();
  v.timer.enabled = measure_passes;
  const Timer timer;
  try {
    run_->draw_frame();
    keep_picture();
  } catch (const Error& error) {
    problem_ = error.what();
    return false;
  }
  glFinish();
  frame_ms_ = timer.elapsed_ms();
  v.timer.enabled = false;
  if (measure_passes) timings_.add(frame_times(v.timer.records()));
  pictures_ += stale_;
  stale_ = false;
  return true;
}

void Side::keep_picture() {
  const View& view = run_->view().view;
  if (view.width != width_ || view.height != height_) {
    width_ = view.width;
    height_ = view.height;
    picture_ = make_texture_2d(GL_RGBA32F, width_, height_);
    framebuffer_ = make_framebuffer({picture_.name()}, 0);
  }
  const ShadedImage& image = run_->frame().image;
  if (image.in_cl) {
    image.in_cl->hand_to_gl(size_t(width_) * height_ * 16);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, image.in_cl->gl_buffer());
    glTextureSubImage2D(picture_.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  } else {
    glNamedFramebufferReadBuffer(image.framebuffer, GL_COLOR_ATTACHMENT0);
    glBlitNamedFramebuffer(image.framebuffer, framebuffer_.name(), 0, 0, width_, height_, 0, 0, width_,
                           height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

}  // namespace lightgrid
