#include "renderer/drawing/draw.h"

#include <glm/gtc/type_ptr.hpp>
#include <numeric>
#include <utility>

namespace lightgrid {

// A software rasteriser starts only at a flush. Flushing a part at a time lets it rasterise while the
// vertices of the next part are shaded.
static constexpr GLsizei indices_per_flush = 3 * 25'000;

void InstanceDrawer::bind(int index, const SceneProgram& program) {
  if (&program == program_ && index == instance_) return;
  const int material = work_.scene.meshes[work_.scene.instances[index].mesh].material;
  const uint32_t features = work_.plan.surfaces.features_of_instance[index];
  const bool positions_only = streams_ == DrawStreams::positions_where_possible && !(features & feature_mask);
  if (&program != program_) {
    glUseProgram(program.name);
    glBindVertexArray(positions_only ? work_.gpu.in_gl().positions_only() : work_.gpu.in_gl().all_streams());
    material_ = -1;
  }
  if (material != material_ && !positions_only) {
    work_.gpu.in_gl().bind_material(material, features);
    material_ = material;
  }
  const InstanceTransform& t = work_.transforms[index];
  glUniformMatrix4fv(program.clip_from_object, 1, GL_FALSE, glm::value_ptr(t.clip_from_object));
  if (program.view_from_object >= 0)
    glUniformMatrix3fv(program.view_from_object, 1, GL_FALSE, glm::value_ptr(t.directions));
  if (program.bitangent_sign >= 0) glUniform1f(program.bitangent_sign, t.mirrored ? -1.0f : 1.0f);
  if (program.normal_from_object >= 0)
    glUniformMatrix3fv(program.normal_from_object, 1, GL_FALSE, glm::value_ptr(t.normals));
  if (program.layers_of_draw >= 0) {
    const ShadowMemory& shadows = work_.shadows;
    const uint32_t first = shadows.layer_count == 0 ? 0 : shadows.first_triangles[size_t(index)];
    glUniform2ui(program.layers_of_draw, first, shadows.layer_count);
  }
  if (program.surface_number_of_draw >= 0)
    glUniform1ui(program.surface_number_of_draw, work_.plan.masks.of_instance[size_t(index)]);
  work_.scene.materials[material].double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  glFrontFace(t.mirrored ? GL_CW : GL_CCW);
  program_ = &program;
  instance_ = index;
}

void InstanceDrawer::draw(const IndexRanges& ranges) {
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, ranges.counts.data(), GL_UNSIGNED_INT, ranges.offsets.data(),
                                GLsizei(ranges.counts.size()), ranges.base_vertices.data());
  unflushed_indices_ += std::accumulate(ranges.counts.begin(), ranges.counts.end(), GLsizei(0));
  if (work_.renderer.gl->software && unflushed_indices_ > indices_per_flush) {
    glFlush();
    unflushed_indices_ = 0;
  }
}

void draw_list(PassContext& work, const DrawList& list, DrawStreams streams, ScenePrograms& programs) {
  InstanceDrawer drawer(work, streams);
  for (const DrawItem& item : list) {
    drawer.bind(item.instance, programs.of(work.plan.surfaces.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
  }
}

void draw_triangles(PassContext& work, const DrawList& list, const std::vector<std::string>& defines,
                    const std::function<uint32_t(int instance)>& first) {
  const SceneProgram& program =
      work.programs({"shaders/scene.vert", "shaders/triangles.frag", defines}).of(0);
  const GLint first_triangle = glGetUniformLocation(program.name, "first_triangle");
  InstanceDrawer drawer(work, DrawStreams::all);
  for (const DrawItem& item : list) {
    drawer.bind(item.instance, program);
    glUniform1ui(program.object, first(item.instance));
    // gl_PrimitiveID counts from 0 in each range.
    for (size_t i = 0; i < item.ranges.counts.size(); ++i) {
      const void* offset = item.ranges.offsets[i];
      glUniform1ui(first_triangle, GLuint(reinterpret_cast<size_t>(offset) / (3 * sizeof(uint32_t))));
      glDrawElementsBaseVertex(GL_TRIANGLES, item.ranges.counts[i], GL_UNSIGNED_INT, offset,
                               item.ranges.base_vertices[i]);
    }
  }
}

void draw_screen(const GlProgram& program) {
  const GlVertexArray nothing = make_vertex_array();
  glBindVertexArray(nothing.name());
  glDisable(GL_CULL_FACE);
  glUseProgram(program.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

// One portion is rasterised while the next is drawn, so that at most two wait. Fewer waits of more draws are
// faster: docs/techniques/forward_multipass.md.
constexpr size_t portion_indices = size_t(5) << 16;

PendingDraws::~PendingDraws() {
  if (drawn_) glDeleteSync(drawn_);
}

void PendingDraws::add(size_t indices) {
  indices_ += indices;
  if (indices_ < portion_indices) return;
  indices_ = 0;
  const GLsync before = std::exchange(drawn_, glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
  glFlush();
  if (!before) return;
  constexpr GLuint64 second = 1'000'000'000;
  while (glClientWaitSync(before, 0, second) == GL_TIMEOUT_EXPIRED) {
  }
  glDeleteSync(before);
}

}  // namespace lightgrid
