// Meshes and instances as the kernels read them, plain arrays made on the host; and the kernels that draw a
// frame.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "cl/buffers.h"
#include "cl/program_cache.h"
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
      clusters{};  // clusters of RasterMeshes
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

struct RasterJob {
  const RasterParams& params;
  int samples;  // a pixel
  cl::Buffer params_buffer;
  // The scene, as RasterMeshes and RasterInstances have it.
  cl::Buffer positions, indices, cluster_indices, cluster_triangles, clusters, instances, vertex_runs, pairs;
  cl::Buffer frame;                              // RasterFrameInstance an instance
  cl::Buffer clip, triangles, depths, counters;  // triangles and depths null: no image is drawn
  const RasterMasks& masks;
};

// One of two shapes with one contract.
class RasterPipeline {
 public:
  virtual ~RasterPipeline() = default;
  // The number of parts that the clusters in view are taken in.
  virtual uint32_t chunks(const RasterParams& params) const = 0;
  // Makes or grows its buffers for the numbers and the room of the params.
  virtual void prepare(const RasterParams& params, int samples) = 0;
  // Enqueues all, waits for nothing. Counters (raster_params.h) are cleared first. Where they show that room
  // was short, the image was not written.
  virtual void enqueue(const RasterJob& job) = 0;
  // The lists that enqueue made.
  virtual RasterLists lists(const RasterParams& params) const = 0;
  virtual size_t memory_bytes() const = 0;
};

std::unique_ptr<RasterPipeline> make_raster_cpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool portable, SampleMasks masks);
// Without `wide_atomics`, or where the device has none of 64 bits, in two passes.
std::unique_ptr<RasterPipeline> make_raster_gpu_pipeline(ClDevice& device, ProgramCache& programs,
                                                         bool wide_atomics, SampleMasks masks);

}  // namespace lightgrid
