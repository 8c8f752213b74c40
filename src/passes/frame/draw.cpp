#include "passes/frame/draw.h"

#include <numeric>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace lightgrid {

// A software rasteriser starts on what was drawn only when it is flushed. Handing it a part at a time lets it
// work while the vertices of the next part are shaded.
static constexpr GLsizei indices_per_flush = 3 * 25'000;

void InstanceDrawer::bind(int index, const GlProgram& program) {
  if (&program == program_ && index == instance_) return;
  const Instance& instance = f_.scene.instances[index];
  const int material = f_.scene.meshes[instance.mesh].material;
  const uint32_t features = f_.plan.features_of_instance[index];
  const bool positions_only = streams_ == DrawStreams::positions_where_possible && !(features & feature_mask);
  if (&program != program_) {
    glUseProgram(program.name());
    glBindVertexArray(positions_only ? f_.gpu.positions_only() : f_.gpu.all_streams());
    material_ = -1;
  }
  if (material != material_ && !positions_only) {
    f_.gpu.bind_material(material, features);
    material_ = material;
  }
  const glm::dmat4 exact = view_from_object(f_.view, instance.world_from_object);
  const glm::mat4 clip_from_object(f_.view.clip_from_view * exact);
  glUniformMatrix4fv(program.uniform("clip_from_object"), 1, GL_FALSE, glm::value_ptr(clip_from_object));
  if (const GLint directions = program.uniform("view_from_object"); directions >= 0) {
    const glm::mat3 view_from_object(exact);
    glUniformMatrix3fv(directions, 1, GL_FALSE, glm::value_ptr(view_from_object));
  }
  if (const GLint normals = program.uniform("normal_from_object"); normals >= 0) {
    const glm::mat3 inverse_transpose(glm::inverseTranspose(glm::dmat3(exact)));
    glUniformMatrix3fv(normals, 1, GL_FALSE, glm::value_ptr(inverse_transpose));
  }
  f_.scene.materials[material].double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  glFrontFace(glm::determinant(glm::dmat3(exact)) < 0 ? GL_CW : GL_CCW);
  program_ = &program, instance_ = index;
}

void InstanceDrawer::draw(const IndexRanges& ranges) {
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, ranges.counts.data(), GL_UNSIGNED_INT, ranges.offsets.data(),
                                GLsizei(ranges.counts.size()), ranges.base_vertices.data());
  unflushed_indices_ += std::accumulate(ranges.counts.begin(), ranges.counts.end(), GLsizei(0));
  if (f_.devices.gl->software && unflushed_indices_ > indices_per_flush) {
    glFlush();
    unflushed_indices_ = 0;
  }
}

void draw_instances(Frame& f, const std::vector<int>& instances, DrawStreams streams,
                    const std::function<const GlProgram&(uint32_t features)>& program_of,
                    const TileDistances* distances, DrawOrder order) {
  InstanceDrawer drawer(f, streams);
  for (const VisiblePart& part : visible_parts(f, instances, order, distances)) {
    drawer.bind(part.instance, program_of(f.plan.features_of_instance[part.instance]));
    drawer.draw(index_ranges(f.gpu.mesh(f.scene.instances[part.instance].mesh), part.clusters));
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
