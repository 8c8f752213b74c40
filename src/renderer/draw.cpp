#include "renderer/draw.h"

#include <numeric>

#include <glm/gtc/type_ptr.hpp>

namespace lightgrid {

// A software rasteriser starts only at a flush. Flushing a part at a time lets it rasterise while the
// vertices of the next part are shaded.
static constexpr GLsizei indices_per_flush = 3 * 25'000;

void InstanceDrawer::bind(int index, const SceneProgram& program) {
  if (&program == program_ && index == instance_) return;
  const int material = seen_.scene.meshes[seen_.scene.instances[index].mesh].material;
  const uint32_t features = seen_.plan.features_of_instance[index];
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
  const InstanceTransform& t = seen_.transforms[index];
  glUniformMatrix4fv(program.clip_from_object, 1, GL_FALSE, glm::value_ptr(t.clip_from_object));
  if (program.view_from_object >= 0)
    glUniformMatrix3fv(program.view_from_object, 1, GL_FALSE, glm::value_ptr(t.directions));
  if (program.normal_from_object >= 0)
    glUniformMatrix3fv(program.normal_from_object, 1, GL_FALSE, glm::value_ptr(t.normals));
  seen_.scene.materials[material].double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
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

void draw_list(Work& work, const Seen& seen, const DrawList& list, DrawStreams streams,
               ScenePrograms& programs) {
  InstanceDrawer drawer(work, seen, streams);
  for (const DrawItem& item : list) {
    drawer.bind(item.instance, programs.of(seen.plan.features_of_instance[item.instance]));
    drawer.draw(item.ranges);
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

}  // namespace lightgrid
