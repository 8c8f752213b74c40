#include "passes/common/mask_stencil.h"

#include "passes/common/surface_numbers.h"

namespace lightgrid {

void draw_masked(PassContext& work, const DrawList& list, GLuint framebuffer, ScenePrograms& programs) {
  if (work.plan.masks.stencil_bits == 0) return draw_list(work, list, DrawStreams::all, programs);
  const StencilMasks masks = stencil_masks(work);
  const GLint nothing = 0;
  glStencilMask(0xff);
  glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &nothing);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  InstanceDrawer drawer(work, DrawStreams::all);
  for (const DrawItem& item : list) {
    const uint32_t number = work.plan.masks.of_instance[size_t(item.instance)];
    glStencilFunc(GL_ALWAYS, masks.of_surface[number], 0xff);
    drawer.bind(item.instance, programs.of(work.plan.surfaces.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
  glDisable(GL_STENCIL_TEST);
}

}  // namespace lightgrid
