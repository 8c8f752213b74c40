// How forward shading of opaque surfaces begins, whatever its lights come from.
#pragma once

#include "passes/passes.h"

namespace lightgrid {

// The image, cleared to the background and ready for surfaces at the depth that the prepass left.
inline ShadedImage begin_shading(Frame& f) {
  const ShadedImage image{f.color_framebuffer()};
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  const float background[4] = {f.scene.background.r, f.scene.background.g, f.scene.background.b, 1};
  glClearNamedFramebufferfv(image.framebuffer, GL_COLOR, 0, background);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  return image;
}

}  // namespace lightgrid
