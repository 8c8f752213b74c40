// Forward shading: opaque surfaces, and blended ones over the image of any technique.
#pragma once

#include "passes/common/background.h"
#include "passes/common/frame.h"
#include "passes/common/light_source.h"

namespace lightgrid {

// Shades opaque surfaces with each pixel's lights, at the prepass' depth.
ShadedImage shade_forward(PassContext& work, const DrawList& surfaces, const LightSource& lights);

// The same without a prepass: finds the depth as well. The nearest surface is shown, of equal ones the last.
ShadedImage shade_forward_and_depth(PassContext& work, const DrawList& surfaces, const LightSource& lights);

// Adds these point and spot lights to an image of shade_forward, in another pass over the surfaces. Counts in
// the stencil of the depth image. Requires reversed triangles.
void add_lights_forward(PassContext& work, const DrawList& surfaces, const LightSource& lights,
                        const ShadedImage& image);

// The image, filled with the background and ready for surfaces at the prepass' depth.
inline ShadedImage begin_shading(PassContext& work) {
  const ShadedImage image{work.color_framebuffer()};
  fill_with_background(work, image.framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, image.framebuffer);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  return image;
}

class ObjectLights;

// Blends blended surfaces over the image, back to front.
void shade_blended(PassContext& work, const ShadedImage& image, const LightSource& lights);

// The same with lights by object, each object in one draw with all of its lights: a second draw would blend
// the surface over itself.
void shade_blended(PassContext& work, const ShadedImage& image, const ObjectLights& objects);

}  // namespace lightgrid
