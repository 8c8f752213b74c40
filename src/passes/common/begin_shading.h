// The start of forward shading of opaque surfaces, for every light source.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// The image, cleared to the background and ready for surfaces at the prepass' depth.
inline ShadedImage begin_shading(Work& work, const Seen& seen) {
  const ShadedImage image{work.color_framebuffer()};
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  const float background[4] = {seen.scene.background.r, seen.scene.background.g, seen.scene.background.b, 1};
  glClearNamedFramebufferfv(image.framebuffer, GL_COLOR, 0, background);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  return image;
}

}  // namespace lightgrid
