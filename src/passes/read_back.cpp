#include "cl/error.h"
#include "passes/passes.h"

namespace lightgrid {

static void read_from_cl(Frame& f, SharedBuffer& from, Image& image) {
  try {
    f.devices.cl->queue().enqueueReadBuffer(from.cl_buffer(), CL_TRUE, 0, image.pixels.size() * 16, image.pixels.data());
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, "reading the image back");
  }
}

void read_back(Frame& f, const ShadedImage& shaded, Image& image) {
  auto pass = f.timer.pass("read_back", "gl");
  if (image.width != f.view.width || image.height != f.view.height)
    image = Image(f.view.width, f.view.height);
  if (shaded.in_cl) {
    read_from_cl(f, *shaded.in_cl, image);
  } else {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shaded.framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, image.width, image.height, GL_RGBA, GL_FLOAT, image.pixels.data());
  }
  pass.moves(image.pixels.size() * 16, image.pixels.size() * 16);
}

}  // namespace lightgrid
