#include "view/screen.h"

#include "base/image.h"
#include "base/write_file.h"
#include "gl/bindings.h"
#include "renderer/drawing/draw.h"

namespace lightgrid::app {

Screen::Screen(Renderer& renderer) : renderer_(renderer), sampler_(make_sampler()) {
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glSamplerParameteri(sampler_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void Screen::begin(int width, int height) {
  if (width != width_ || height != height_) {
    width_ = width;
    height_ = height;
    image_ = make_texture_2d(GL_RGBA8, width, height);
    framebuffer_ = make_framebuffer({image_.name()}, 0);
  }
  reset_gl_state();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width, height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void Screen::draw(const ScreenImage& left, const ScreenImage& right, double line, int picture_width,
                  PixelGrid drawn, float map_opacity) {
  const PixelGrid full{picture_width, height_};
  if (drawn != full && drawn != small_size_) {
    small_size_ = drawn;
    small_image_ = make_texture_2d(GL_RGBA8, drawn.width, drawn.height);
    small_ = make_framebuffer({small_image_.name()}, 0);
  }
  if (drawn != full) glBindFramebuffer(GL_FRAMEBUFFER, small_.name());
  const GlProgram& program = renderer_.program("shaders/screen.vert", "shaders/view.frag", {});
  glUseProgram(program.name());
  glUniform2f(program.uniform("size"), float(drawn.width), float(drawn.height));
  glUniform1f(program.uniform("line"), float(line * drawn.width));
  glUniform1f(program.uniform("exposure"), exposure);
  glUniform1i(program.uniform("filmic"), filmic);
  glUniform1f(program.uniform("map_opacity"), map_opacity);
  glUniform1i(program.uniform("mapped_left"), left.is_map);
  glUniform1i(program.uniform("mapped_right"), right.is_map);
  bind_texture(Sampler::left_image, left.texture);
  bind_texture(Sampler::right_image, right.texture);
  for (const Sampler side : {Sampler::left_image, Sampler::right_image})
    bind_sampler_object(side, sampler_.name());
  glViewport(0, 0, drawn.width, drawn.height);
  if (map_opacity < 1) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  }
  draw_screen(program);
  glDisable(GL_BLEND);
  if (drawn != full) {
    glBlitNamedFramebuffer(small_.name(), framebuffer_.name(), 0, 0, drawn.width, drawn.height, 0, 0,
                           full.width, full.height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  }
  glViewport(0, 0, width_, height_);
  unbind_sampler_objects();
}

// Mesa gives framebuffer 0 the window's new size when a bound one is drawn into after glViewport.
void Screen::finish() {
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (width_ == 0) return glClear(GL_COLOR_BUFFER_BIT);  // no frame yet
  glViewport(0, 0, width_, height_);
  glBlitNamedFramebuffer(framebuffer_.name(), 0, 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void Screen::save(const std::filesystem::path& path) {
  std::vector<uint8_t> rgba(size_t(width_) * height_ * 4);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  std::vector<uint8_t> rgb;
  rgb.reserve(size_t(width_) * height_ * 3);
  for (int y = height_ - 1; y >= 0; --y) {
    const uint8_t* pixel = &rgba[size_t(y) * width_ * 4];
    for (int x = 0; x < width_; ++x, pixel += 4) rgb.insert(rgb.end(), pixel, pixel + 3);
  }
  write_file(path, encode_png(width_, height_, 3, rgb));
}

}  // namespace lightgrid::app
