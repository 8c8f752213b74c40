#include "passes/frame/draw.h"

#include <iterator>
#include <numeric>

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace lightgrid {

// A software rasteriser starts on what was drawn only when it is flushed. Handing it a part at a time lets it
// work while the vertices of the next part are shaded.
static constexpr GLsizei indices_per_flush = 3 * 25'000;

namespace {

// What is drawn of an instance at once.
struct Part {
  int instance;
  glm::dmat4 view_from_object;
  IndexRanges ranges;
};

std::vector<Part> visible_parts(Frame& f, const std::vector<int>& instances, DrawOrder order, const TileDistances* distances) {
  const Frustum frustum = frustum_of(f.view);
  std::array<std::vector<Part>, distance_layers> parts;
  for (int index : instances) {
    const glm::dmat4 exact = view_from_object(f.view, f.scene.instances[index].world_from_object);
    auto layers = visible_clusters(f, frustum, distances, index, exact);
    for (int layer = 0; layer < distance_layers; ++layer) {
      if (layers[layer].counts.empty()) continue;
      parts[order == DrawOrder::front_to_back ? layer : 0].push_back({index, exact, std::move(layers[layer])});
    }
  }
  for (int layer = 1; layer < distance_layers; ++layer) {
    std::move(parts[layer].begin(), parts[layer].end(), std::back_inserter(parts[0]));
  }
  return std::move(parts[0]);
}

}  // namespace

void draw_instances(Frame& f, const std::vector<int>& instances, DrawStreams streams,
                    const std::function<const GlProgram&(uint32_t features)>& program_of,
                    const TileDistances* distances, DrawOrder order) {
  const GlProgram* bound_program = nullptr;
  int bound_material = -1;
  GLsizei unflushed_indices = 0;
  for (const auto& [index, exact, ranges] : visible_parts(f, instances, order, distances)) {
    const Mesh& mesh = f.scene.meshes[f.scene.instances[index].mesh];
    const Material& material = f.scene.materials[mesh.material];
    const uint32_t features = f.plan.features_of_instance[index];
    const GlProgram& program = program_of(features);
    const bool positions_only =
        streams == DrawStreams::positions_where_possible && !(features & feature_mask);
    if (&program != bound_program) {
      glUseProgram(program.name());
      glBindVertexArray(positions_only ? f.gpu.positions_only() : f.gpu.all_streams());
      bound_program = &program;
      bound_material = -1;
    }
    if (mesh.material != bound_material && !positions_only) {
      f.gpu.bind_material(mesh.material, features);
      bound_material = mesh.material;
    }
    const glm::mat4 clip_from_object(f.view.clip_from_view * exact);
    glUniformMatrix4fv(program.uniform("clip_from_object"), 1, GL_FALSE, glm::value_ptr(clip_from_object));
    if (const GLint directions = program.uniform("view_from_object"); directions >= 0) {
      const glm::mat3 view_from_object(exact);
      glUniformMatrix3fv(directions, 1, GL_FALSE, glm::value_ptr(view_from_object));
    }
    if (const GLint normals = program.uniform("normal_from_object"); normals >= 0) {
      const glm::mat3 inverse_transpose(glm::inverseTranspose(glm::dmat3(exact)));
      glUniformMatrix3fv(normals, 1, GL_FALSE, glm::value_ptr(inverse_transpose));
    }
    material.double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    glFrontFace(glm::determinant(glm::dmat3(exact)) < 0 ? GL_CW : GL_CCW);
    glMultiDrawElementsBaseVertex(GL_TRIANGLES, ranges.counts.data(), GL_UNSIGNED_INT, ranges.offsets.data(),
                                  GLsizei(ranges.counts.size()), ranges.base_vertices.data());
    unflushed_indices += std::accumulate(ranges.counts.begin(), ranges.counts.end(), GLsizei(0));
    if (f.devices.gl->software && unflushed_indices > indices_per_flush) {
      glFlush();
      unflushed_indices = 0;
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

}  // namespace lightgrid
