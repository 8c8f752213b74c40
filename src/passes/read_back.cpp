#include "passes/passes.h"

namespace lightgrid {

Image read_back(Frame& f, const ShadedImage& shaded) {
  auto pass = f.timer.pass("read_back", "gl");
  Image image(f.view.width, f.view.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  pass.moves(image.pixels.size() * 16, image.pixels.size() * 16);
  return image;
}

}  // namespace lightgrid
