#include "renderer/cl_scene.h"

#include <memory>
#include <utility>

#include "cl/buffers.h"
#include "cl/error.h"
#include "cl/transfer.h"
#include "plan/frame_plan.h"
#include "plan/settings/surfaces.h"
#include "renderer/upload/scene_surfaces.h"

namespace lightgrid {
namespace {

SurfaceVertex surface_vertex(const Mesh& mesh, size_t i) {
  SurfaceVertex v{};
  v.normal_x = mesh.normals[i].x;
  v.normal_y = mesh.normals[i].y;
  v.normal_z = mesh.normals[i].z;
  if (!mesh.tangents.empty()) {
    const glm::vec4& t = mesh.tangents[i];
    v.tangent_x = t.x;
    v.tangent_y = t.y;
    v.tangent_z = t.z;
    v.handedness = t.w;
  }
  if (!mesh.uv0.empty()) {
    v.u0 = mesh.uv0[i].x;
    v.v0 = mesh.uv0[i].y;
  }
  if (!mesh.uv1.empty()) {
    v.u1 = mesh.uv1[i].x;
    v.v1 = mesh.uv1[i].y;
  }
  const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1) : mesh.colors[i];
  v.red = color.r;
  v.green = color.g;
  v.blue = color.b;
  v.alpha = color.a;
  return v;
}

template <typename Values>
cl::Buffer filled_buffer(ClDevice& device, const char* what, const Values& values) {
  return filled_buffer(device, what, values.data(), values.size() * sizeof values[0]);
}

// The same, on a CPU without a copy: the buffer keeps the values, whose texels may take gigabytes.
template <typename T>
cl::Buffer keeping_buffer(ClDevice& device, const char* what, BufferVector<T> values) {
  if (!device.info().cpu || values.size() * sizeof(T) < 4096) return filled_buffer(device, what, values);
  auto kept = std::make_unique<BufferVector<T>>(std::move(values));
  const auto free_values = [](cl_mem, void* owned) { delete static_cast<BufferVector<T>*>(owned); };
  try {
    cl::Buffer buffer(device.context(), CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, kept->size() * sizeof(T),
                      kept->data());
    if (clSetMemObjectDestructorCallback(buffer(), free_values, kept.get()) != CL_SUCCESS)
      return filled_buffer(device, what, *kept);
    (void)kept.release();
    return buffer;
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("{}: a buffer of {} bytes", what, kept->size() * sizeof(T)));
  }
}

}  // namespace

ClScene::ClScene(ClDevice& device, const Scene& scene, TexelLayout layout)
    : device_(device), scene_(scene), shown_(shown_meshes(scene)) {
  std::vector<bool> used_materials(scene.materials.size(), false);
  size_t vertices = 0;
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    first_vertex_.push_back(vertices);
    if (!shown_[i]) continue;
    vertices += scene.meshes[i].positions.size();
    used_materials[scene.meshes[i].material] = true;
    features_ |= material_features(scene, scene.meshes[i]);
  }
  first_vertex_.push_back(vertices);
  std::vector<SurfaceVertex> attributes(vertices);
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    write_attributes(int(i), attributes.data() + first_vertex_[i]);
  vertices_ = filled_buffer(device, "uploading vertices", attributes);
  vertex_bytes_ = vertices * sizeof(SurfaceVertex);

  SurfaceTexels texels = surface_texels(scene, used_materials, layout);
  materials_ = filled_buffer(device, "uploading materials", texels.materials);
  material_bytes_ = texels.materials.size() * sizeof(SurfaceMaterial);
  texture_bytes_ = (texels.texels_4.size() + texels.texels_8.size()) * 2 + texels.small_texels_8.size() +
                   texels.alphas.size() * 4;
  texels_4_ = keeping_buffer(device, "uploading textures", std::move(texels.texels_4));
  texels_8_ = layout == TexelLayout::packed_8
                  ? keeping_buffer(device, "uploading packed textures", std::move(texels.small_texels_8))
                  : keeping_buffer(device, "uploading packed textures", std::move(texels.texels_8));
  alphas_ = keeping_buffer(device, "uploading alphas", std::move(texels.alphas));
}

void ClScene::write_attributes(int mesh, SurfaceVertex* to) const {
  if (!shown_[mesh]) return;
  for (size_t i = 0; i < scene_.meshes[mesh].positions.size(); ++i)
    to[i] = surface_vertex(scene_.meshes[mesh], i);
}

void ClScene::update(const SceneChanges& changes) {
  for (const int mesh : changes.meshes) {
    if (!shown_[mesh]) continue;
    std::vector<SurfaceVertex> attributes(scene_.meshes[mesh].positions.size());
    write_attributes(mesh, attributes.data());
    write_buffer(device_, "uploading vertices", vertices_, attributes.data(),
                 attributes.size() * sizeof(SurfaceVertex), first_vertex_[mesh] * sizeof(SurfaceVertex));
  }
}

}  // namespace lightgrid
