#include "passes/read_outs/triangles.h"

#include "renderer/draw.h"

namespace lightgrid {
namespace {

// Two numbers a pixel over the frame's depth: the instance, and the triangle's place in the scene's indices.
class TriangleTarget {
 public:
  explicit TriangleTarget(Work& work, const Seen& seen)
      : work_(work),
        seen_(seen),
        texture_(make_texture_2d(GL_RG32UI, seen.grid().width, seen.grid().height)),
        framebuffer_(make_framebuffer({texture_.name()}, work.targets.depth())),
        program_(work.programs({"shaders/scene.vert", "shaders/triangles.frag", {}}).of(0)),
        first_triangle_(glGetUniformLocation(program_.name, "first_triangle")) {}

  std::vector<glm::uvec2> drawn(const DrawList& list, GLenum depth_test) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, seen_.grid().width, seen_.grid().height);
    const GLuint nothing[4] = {none, none, none, none};
    glClearNamedFramebufferuiv(framebuffer_.name(), GL_COLOR, 0, nothing);
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(depth_test);
    for (const DrawItem& item : list) draw(item);
    std::vector<glm::uvec2> found(seen_.grid().values());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, seen_.view.width, seen_.view.height, GL_RG_INTEGER, GL_UNSIGNED_INT, found.data());
    return found;
  }

  static constexpr GLuint none = 0xffffffffu;

 private:
  void draw(const DrawItem& item) {
    InstanceDrawer drawer(work_, seen_, DrawStreams::all);
    drawer.bind(item.instance, program_);
    glUniform1ui(program_.object, GLuint(item.instance));
    // gl_PrimitiveID counts from 0 in each range.
    for (size_t i = 0; i < item.ranges.counts.size(); ++i) {
      const void* offset = item.ranges.offsets[i];
      glUniform1ui(first_triangle_, GLuint(reinterpret_cast<size_t>(offset) / (3 * sizeof(uint32_t))));
      glDrawElementsBaseVertex(GL_TRIANGLES, item.ranges.counts[i], GL_UNSIGNED_INT, offset,
                               item.ranges.base_vertices[i]);
    }
  }

  Work& work_;
  const Seen& seen_;
  GlTexture texture_;
  GlFramebuffer framebuffer_;
  const SceneProgram& program_;
  GLint first_triangle_;
};

}  // namespace

ShownTriangles read_triangles(Work& work, const Seen& seen) {
  TriangleTarget target(work, seen);
  const std::vector<uint32_t> indices = work.gpu.in_gl().read_indices();
  ShownTriangles shown;
  for (const glm::uvec2& found : target.drawn(seen.opaque, GL_EQUAL)) {
    const bool none = found.x == TriangleTarget::none;
    shown.opaque.push_back(none ? SceneTriangle{}
                                : scene_triangle(int(found.x), &indices[3 * size_t(found.y)]));
  }
  shown.blended.assign(seen.grid().values(), false);
  if (seen.blended.empty()) return shown;
  const std::vector<glm::uvec2> over = target.drawn(seen.blended, GL_GEQUAL);
  for (size_t i = 0; i < over.size(); ++i) shown.blended[i] = over[i].x != TriangleTarget::none;
  return shown;
}

}  // namespace lightgrid
