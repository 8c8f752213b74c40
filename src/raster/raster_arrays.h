// Meshes, instances and a camera as the kernels read them: plain arrays and numbers, made on the host.
#pragma once

#include <array>
#include <vector>

#include "cl/buffers.h"
#include "raster/raster_scene.h"
#include "raster/raster_view.h"
#include "shared/raster_params.h"

namespace lightgrid {

// Where a mesh lies in the arrays of all meshes.
struct RasterMeshPlace {
  uint32_t first_index = 0, triangles = 0;
  uint32_t first_vertex = 0, vertices = 0;
  uint32_t first_position = 0;  // multiple of 16
  uint32_t first_cluster = 0, clusters = 0;
  bool drawing_order = false;
};

struct RasterMeshes {
  std::vector<RasterMeshPlace> places;
  std::vector<uint32_t> indices;  // as given, mesh after mesh
  // The same triangles in the order of clusters: corners, and number within the mesh.
  std::vector<uint32_t> cluster_indices, cluster_triangles;
  std::vector<float> positions;  // blocks of 16 vertices: 16 x, 16 y, 16 z; each mesh begins a block
  std::vector<RasterCluster> clusters;
};

// Clusters are of triangles that lie together, or that follow one another in a mesh in drawing order. Throws
// Error(input) that names the mesh.
RasterMeshes raster_meshes(std::span<const RasterMesh> meshes);

// An order of a mesh's triangles in which those that lie together and face the same way follow one another:
// numbers of all of them, each once.
std::vector<uint32_t> cluster_order(const RasterMesh& mesh);

struct RasterScene::State {
  ClDevice& device;
  int version = 0;  // how often the meshes were set
  std::vector<RasterMeshPlace> places{};
  GrowingBuffer positions{}, indices{}, cluster_indices{}, cluster_triangles{},
      clusters{};  // of RasterMeshes
  RasterMasks masks{};
};

struct RasterInstances {
  std::vector<RasterInstanceRecord> records;
  std::vector<uint32_t> triangle_instance;
  std::vector<std::array<uint32_t, 2>> vertex_runs;  // instance, first vertex
  std::vector<std::array<uint32_t, 2>> pairs;        // instance, cluster
  size_t clip_vertices = 0;
};

// Throws Error(input) that names an instance without a mesh or with a matrix that is not finite and affine,
// or that has a mesh without drawing order where `drawing_order` is asked for.
void check_raster_instances(std::span<const RasterInstance> instances,
                            std::span<const RasterMeshPlace> meshes, bool drawing_order);

// Takes instances that passed the check. Throws Error(machine) where numbers do not fit 32 bits.
RasterInstances raster_instances(std::span<const RasterInstance> instances,
                                 std::span<const RasterMeshPlace> meshes);

// Throws Error(input) as RasterView::set_camera says.
void check_raster_camera(const RasterCamera& camera);

// All but what depends on the scene and on room.
RasterParams raster_params(const RasterCamera& camera);

RasterFrameInstance raster_frame_instance(const RasterCamera& camera, const glm::dmat4& world_from_object,
                                          bool two_sided);

}  // namespace lightgrid
