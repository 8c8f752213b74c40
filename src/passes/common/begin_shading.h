// The start of forward shading of opaque surfaces, for every light source.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// The image, cleared to the background and ready for surfaces at the prepass' depth.
inline ShadedImage begin_shading(RenderView& v) {
  const ShadedImage image{v.color_framebuffer()};
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  const float background[4] = {v.scene.background.r, v.scene.background.g, v.scene.background.b, 1};
  glClearNamedFramebufferfv(image.framebuffer, GL_COLOR, 0, background);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  return image;
}

}  // namespace lightgrid
