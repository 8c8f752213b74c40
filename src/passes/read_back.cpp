#include "cl/transfer.h"
#include "passes/passes.h"

namespace lightgrid {

void read_back(Frame& f, const ShadedImage& shaded, Image& image) {
  auto pass = f.timer.pass("read_back", "gl");
  if (image.width != f.view.width || image.height != f.view.height)
    image = Image(f.view.width, f.view.height);
  if (shaded.in_cl) {
    read_buffer(*f.devices.cl, "reading the image back", shaded.in_cl->cl_buffer(), image.pixels.data(), image.pixels.size() * 16);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  }
  pass.moves(image.pixels.size() * 16, image.pixels.size() * 16);
}

}  // namespace lightgrid
