#include "passes/read_back.h"

#include <cstring>

namespace lightgrid {

HostImage::HostImage(RenderView& v, const ShadedImage& shaded, Image& copy) : copy_(copy) {
  auto pass = v.timer.pass("read_back", shaded.in_cl ? "cl" : "gl");
  if (copy.width != v.view.width || copy.height != v.view.height || copy.pixels.size() != v.grid().pixels()) {
    copy = Image(v.view.width, v.view.height);
  }
  const char* what = "reading the image back";
  const size_t bytes = copy.pixels.size() * 16;
  if (shaded.in_cl && v.renderer.cl->info().cpu) {
    mapped_.emplace(*v.renderer.cl, what, shaded.in_cl->cl_buffer(), bytes);
    return;
  }
  if (shaded.in_cl) {
    read_buffer(*v.renderer.cl, what, shaded.in_cl->cl_buffer(), copy.pixels.data(), bytes);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, copy.width, copy.height, GL_RGBA, GL_FLOAT, copy.pixels.data());
  }
  pass.moves(bytes, bytes);
}

void HostImage::keep() {
  if (!mapped_) return;
  std::memcpy(copy_.pixels.data(), mapped_->data(), copy_.pixels.size() * 16);
  mapped_.reset();
}

void read_back(RenderView& v, const ShadedImage& shaded, Image& image) { HostImage(v, shaded, image).keep(); }

}  // namespace lightgrid
