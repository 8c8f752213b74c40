#include "passes/common/background.h"

#include "passes/common/light_source.h"
#include "plan/settings/model.h"
#include "renderer/drawing/draw.h"

namespace lightgrid {

void fill_with_background(PassContext& work, GLuint framebuffer) {
  const Effect* effect = background_effect(work.plan);
  if (!effect) {
    const glm::vec3& color = work.scene.background;
    const float rgba[4] = {color.r, color.g, color.b, 1};
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, rgba);
    return;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, work.grid().width, work.grid().height);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  base_lighting(work).bind(work);
  draw_screen(work.program("shaders/screen.vert", "shaders/background.frag", {define_of(*effect)}));
}

}  // namespace lightgrid
