#include "passes/read_back.h"

#include <cstring>

#include "renderer/device_clock.h"

namespace lightgrid {

template <typename Pixel>
HostPixels<Pixel>::HostPixels(PassContext& work, SharedBuffer* in_cl, GLuint framebuffer, GLenum type,
                              std::vector<Pixel>& copy)
    : copy_(copy) {
  auto pass = work.timer.pass(read_back_pass, in_cl ? "cl" : "gl");
  copy.resize(work.grid().pixels());
  const size_t bytes = copy.size() * sizeof(Pixel);
  if (in_cl && work.renderer.cl->info().cpu) {
    mapped_.emplace(*work.renderer.cl, read_back_copy, in_cl->cl_buffer(), bytes, CL_MAP_READ | CL_MAP_WRITE);
    return;
  }
  if (in_cl) {
    read_buffer(*work.renderer.cl, read_back_copy, in_cl->cl_buffer(), copy.data(), bytes);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, work.view.width, work.view.height, GL_RGBA, type, copy.data());
  }
  pass.moves(bytes, bytes);
}

template <typename Pixel>
void HostPixels<Pixel>::keep() {
  if (!mapped_) return;
  std::memcpy(copy_.data(), pixels(), copy_.size() * sizeof(Pixel));
  mapped_.reset();
}

template class HostPixels<glm::vec4>;
template class HostPixels<glm::u8vec4>;

static std::vector<glm::vec4>& sized(Image& image, const View& view) {
  image.width = view.width;
  image.height = view.height;
  return image.pixels;
}

HostImage::HostImage(PassContext& work, const ShadedImage& shaded, Image& copy)
    : HostPixels(work, shaded.in_cl, shaded.framebuffer, GL_FLOAT, sized(copy, work.view)) {}

HostPicture::HostPicture(PassContext& work, const DisplayedImage& displayed, std::vector<glm::u8vec4>& copy)
    : HostPixels(work, displayed.in_cl, displayed.framebuffer, GL_UNSIGNED_BYTE, copy) {}

void read_back(PassContext& work, const ShadedImage& shaded, Image& image) {
  HostImage(work, shaded, image).keep();
}

}  // namespace lightgrid
