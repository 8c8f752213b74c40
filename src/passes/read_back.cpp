#include "passes/read_back.h"

#include <cstring>

#include "renderer/device_clock.h"

namespace lightgrid {

HostImage::HostImage(Work& work, const ShadedImage& shaded, Image& copy) : copy_(copy) {
  auto pass = work.timer.pass(read_back_pass, shaded.in_cl ? "cl" : "gl");
  if (copy.width != work.view.width || copy.height != work.view.height ||
      copy.pixels.size() != work.grid().pixels()) {
    copy = Image(work.view.width, work.view.height);
  }
  const size_t bytes = copy.pixels.size() * 16;
  if (shaded.in_cl && work.renderer.cl->info().cpu) {
    mapped_.emplace(*work.renderer.cl, read_back_copy, shaded.in_cl->cl_buffer(), bytes,
                    CL_MAP_READ | CL_MAP_WRITE);
    return;
  }
  if (shaded.in_cl) {
    read_buffer(*work.renderer.cl, read_back_copy, shaded.in_cl->cl_buffer(), copy.pixels.data(), bytes);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, copy.width, copy.height, GL_RGBA, GL_FLOAT, copy.pixels.data());
  }
  pass.moves(bytes, bytes);
}

glm::vec4* HostImage::pixels() {
  return mapped_ ? static_cast<glm::vec4*>(mapped_->data()) : copy_.pixels.data();
}

void HostImage::keep() {
  if (!mapped_) return;
  std::memcpy(copy_.pixels.data(), pixels(), copy_.pixels.size() * 16);
  mapped_.reset();
}

void read_back(Work& work, const ShadedImage& shaded, Image& image) { HostImage(work, shaded, image).keep(); }

}  // namespace lightgrid
