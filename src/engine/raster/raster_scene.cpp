#include "raster/raster_scene.h"

#include "base/error.h"
#include "cl/transfer.h"
#include "raster/raster_arrays.h"

namespace lightgrid {
namespace {

constexpr size_t spare = 48;  // values that kernels may read past the last

template <typename T>
void upload(ClDevice& device, GrowingBuffer& buffer, const std::vector<T>& values, size_t spare = 0) {
  buffer.at_least(device, (values.size() + spare) * sizeof(T));
  if (!values.empty())
    write_buffer(device, "rasterizer: scene", buffer.get(), values.data(), values.size() * sizeof(T));
}

}  // namespace

RasterScene::RasterScene(ClDevice& device) : state_(new State{.device = device}) {}
RasterScene::~RasterScene() = default;
RasterScene::RasterScene(RasterScene&&) noexcept = default;

void RasterScene::set_meshes(std::span<const RasterMesh> meshes) {
  State& s = *state_;
  RasterMeshes made = raster_meshes(meshes);
  ++s.version;
  upload(s.device, s.indices, made.indices);
  upload(s.device, s.cluster_indices, made.cluster_indices, spare);
  upload(s.device, s.cluster_triangles, made.cluster_triangles, spare);
  upload(s.device, s.positions, made.positions);
  upload(s.device, s.clusters, made.clusters);
  s.places = std::move(made.places);
}

void RasterScene::set_masks(const RasterMasks& masks) {
  const bool vertices = masks.vertices() != nullptr, materials = masks.materials() != nullptr,
             alphas = masks.alphas() != nullptr;
  if (vertices != materials || vertices != alphas) {
    throw input_error(
        "rasterizer: masks have {}vertices, {}materials and {}alphas: all three or none will do",
        vertices ? "" : "no ", materials ? "" : "no ", alphas ? "" : "no ");
  }
  state_->masks = masks;
}

size_t RasterScene::geometry_bytes() const {
  size_t bytes = 0;
  for (const RasterMeshPlace& mesh : state_->places)
    bytes += mesh.vertices * sizeof(glm::vec3) + mesh.triangles * 3 * sizeof(uint32_t);
  return bytes;
}

size_t RasterScene::memory_bytes() const {
  const State& s = *state_;
  return s.positions.bytes() + s.indices.bytes() + s.cluster_indices.bytes() + s.cluster_triangles.bytes() +
         s.clusters.bytes();
}

}  // namespace lightgrid
