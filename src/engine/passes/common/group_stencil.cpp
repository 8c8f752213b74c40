#include "passes/common/group_stencil.h"

#include "passes/common/group_numbers.h"

namespace lightgrid {

void draw_grouped(Work& work, const DrawList& list, GLuint framebuffer, ScenePrograms& programs) {
  if (work.plan.groups.stencil_bits == 0) return draw_list(work, list, DrawStreams::all, programs);
  const StencilGroups groups = stencil_groups(work);
  const GLint nothing = 0;
  glStencilMask(0xff);
  glClearNamedFramebufferiv(framebuffer, GL_STENCIL, 0, &nothing);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  InstanceDrawer drawer(work, DrawStreams::all);
  for (const DrawItem& item : list) {
    const uint32_t mask = work.plan.groups.of_instance[size_t(item.instance)];
    glStencilFunc(GL_ALWAYS, groups.of_mask[mask], 0xff);
    drawer.bind(item.instance, programs.of(work.plan.surfaces.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
  glDisable(GL_STENCIL_TEST);
}

}  // namespace lightgrid
