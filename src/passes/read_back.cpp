#include "passes/read_back.h"

#include "cl/transfer.h"

namespace lightgrid {

void read_back(RenderView& v, const ShadedImage& shaded, Image& image) {
  auto pass = v.timer.pass("read_back", shaded.in_cl ? "cl" : "gl");
  if (image.width != v.view.width || image.height != v.view.height || image.pixels.size() != v.pixels()) {
    image = Image(v.view.width, v.view.height);
  }
  if (shaded.in_cl) {
    read_buffer(*v.renderer.cl, "reading the image back", shaded.in_cl->cl_buffer(), image.pixels.data(),
                image.pixels.size() * 16);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  }
  pass.moves(image.pixels.size() * 16, image.pixels.size() * 16);
}

}  // namespace lightgrid
