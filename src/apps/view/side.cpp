#include "view/side.h"

#include <algorithm>

#include "base/error.h"
#include "base/timer.h"

namespace lightgrid::app {

static constexpr size_t median_frames = 15;

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
    run_ = std::move(run);
  } catch (const Error& error) {
    if (!run_) throw;
    problem_ = error.what();
    return false;
  }
  prepared_ = false;
  fresh_ = true;
  frame_ms_.clear();
  return true;
}

void Side::look(const View& view, const SceneChanges& changes) {
  run_->look(view, changes);
  stale_ = true;
}

bool Side::draw(bool again, bool measure_passes) {
  if (!problem_.empty() || !(stale_ || unmeasured_ || again)) return false;
  RenderView& v = run_->view();
  const RendererCounts before = renderer_.counts();
  double ms = 0;
  try {
    if (!fresh_ && !std::exchange(prepared_, true)) {
      run_->prepare();
      fresh_ = true;
    }
    v.timer.clear();
    v.timer.enabled = measure_passes;
    const Timer timer;
    run_->draw_frame();
    keep_picture();
    glFinish();
    ms = timer.elapsed_ms();
  } catch (const Error& error) {
    v.timer.enabled = false;
    problem_ = error.what();
    if (picture_number_ == 0) throw;
    return false;
  }
  v.timer.enabled = false;
  const RendererCounts after = renderer_.counts();
  const bool compiled = after.gl_programs != before.gl_programs || after.cl_programs != before.cl_programs;
  unmeasured_ = std::exchange(fresh_, false) || compiled || !prepared_;
  if (!unmeasured_) {
    if (measure_passes) timings_.add(frame_times(v.timer.records()));
    frame_ms_.push_back(ms);
    if (frame_ms_.size() > median_frames) frame_ms_.pop_front();
    slowest_ms_ = std::max(slowest_ms_, ms);
    ++figures_;
  }
  static size_t pictures = 0;
  if (stale_) picture_number_ = ++pictures;
  stale_ = false;
  return true;
}

Image Side::read_picture() const {
  Image image(width_, height_);
  glGetTextureImage(picture_.name(), 0, GL_RGBA, GL_FLOAT,
                    GLsizei(image.pixels.size() * sizeof image.pixels[0]), image.pixels.data());
  return image;
}

double Side::frame_ms() const {
  if (frame_ms_.empty()) return 0;
  return spread_of({frame_ms_.begin(), frame_ms_.end()}).median;
}

void Side::keep_picture() {
  const View& view = run_->view().view;
  if (view.width != width_ || view.height != height_) {
    width_ = view.width;
    height_ = view.height;
    frame_ms_.clear();
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

}  // namespace lightgrid::app
