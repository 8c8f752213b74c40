// The rasteriser's picture, on the host, and the coverage oracle's verdict on it.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "cl/transfer.h"
#include "oracle/coverage.h"
#include "raster/raster_view.h"

namespace lightgrid {
using namespace lab;

inline ClDevice& raster_device() {
  static ClDevice* const device = new ClDevice;
  return *device;
}

inline ProgramCache& raster_programs() {
  static ProgramCache* const programs = new ProgramCache(raster_device());
  return *programs;
}

struct TriangleScene {
  struct MeshData {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
  };
  std::vector<MeshData> meshes;
  std::vector<RasterInstance> instances;
  RasterCamera camera;
};

// A view with its eye at the origin, whose clip space is (x, y, near, -z) of the position: x = y = -z are the
// image's corner.
inline RasterCamera plain_view(int width, int height, double near = 0.1) {
  RasterCamera view{{width, height}, glm::dmat4(0), glm::dmat4(1), glm::dvec3(0)};
  view.clip_from_view[0][0] = view.clip_from_view[1][1] = 1;
  view.clip_from_view[2][3] = -1;
  view.clip_from_view[3][2] = near;
  return view;
}

// Orthographic: clip space is (x, y, z + 1, 1), for z from -1 to 0.
inline RasterCamera flat_view(int width, int height) {
  RasterCamera view{{width, height}, glm::dmat4(1), glm::dmat4(1), glm::dvec3(0)};
  view.clip_from_view[3][2] = 1;
  return view;
}

// Where plain_view has pixel (x, y) at distance w.
inline glm::vec3 at(const RasterCamera& view, double x, double y, double w) {
  return glm::vec3((2 * x / view.grid.width - 1) * w, (2 * y / view.grid.height - 1) * w, -w);
}

struct Drawn {
  PixelGrid grid;
  std::vector<uint32_t> triangles;
  std::vector<float> depths;
  std::vector<glm::vec4> clip;
  std::vector<RasterInstanceRecord> instances;
  RasterCounts counts;

  bool same_image(const Drawn& other) const {
    return triangles == other.triangles &&
           std::memcmp(depths.data(), other.depths.data(), depths.size() * sizeof(float)) == 0;
  }
  size_t covered() const {
    return size_t(
        std::count_if(triangles.begin(), triangles.end(), [](uint32_t t) { return t != no_triangle; }));
  }
};

template <typename T>
std::vector<T> read_all(const cl::Buffer& from, size_t count, ClDevice& device = raster_device()) {
  std::vector<T> values(count);
  if (count != 0) read_buffer(device, "test", from, values.data(), count * sizeof(T));
  return values;
}

// A scene with one view.
struct Rasterizer : RasterScene, RasterView {
  Rasterizer(ClDevice& device, ProgramCache& programs, const RasterOptions& options = {})
      : RasterScene(device), RasterView(*this, programs, options) {}
};

inline std::vector<RasterMesh> meshes_of(const TriangleScene& scene) {
  std::vector<RasterMesh> meshes;
  for (const TriangleScene::MeshData& mesh : scene.meshes) meshes.push_back({mesh.positions, mesh.indices});
  return meshes;
}

inline void set_scene(Rasterizer& rasterizer, const TriangleScene& scene) {
  rasterizer.set_meshes(meshes_of(scene));
  rasterizer.set_instances(scene.instances);
  rasterizer.set_camera(scene.camera);
}

inline Drawn drawn_by(RasterView& rasterizer, const TriangleScene& scene,
                      ClDevice& device = raster_device()) {
  const Visibility visibility = rasterizer.draw();
  Drawn drawn{visibility.grid, {}, {}, {}, {}, rasterizer.counts()};
  const size_t values = drawn.grid.values();
  drawn.triangles = read_all<uint32_t>(visibility.triangle, values, device);
  drawn.depths = read_all<float>(visibility.depth, values, device);
  drawn.instances =
      read_all<RasterInstanceRecord>(rasterizer.buffers().instances, scene.instances.size(), device);
  size_t vertices = 0;
  for (const RasterInstanceRecord& i : drawn.instances)
    vertices = i.first_clip_vertex + size_t(i.vertex_count);
  drawn.clip = read_all<glm::vec4>(rasterizer.buffers().clip, vertices, device);
  return drawn;
}

inline Drawn drawn(const TriangleScene& scene, const RasterOptions& options = {}) {
  Rasterizer rasterizer(raster_device(), raster_programs(), options);
  set_scene(rasterizer, scene);
  return drawn_by(rasterizer, scene);
}

// The oracle on the clip-space positions that the kernels made. sample: as CoverageOracle has it.
inline CoverageOracle oracle_of(const Drawn& drawn, const TriangleScene& scene,
                                const SnappedPoint& sample = {128, 128}) {
  CoverageOracle oracle(drawn.grid, sample);
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const std::vector<uint32_t>& indices = scene.meshes[scene.instances[i].mesh].indices;
    const glm::vec4* const clip = drawn.clip.data() + drawn.instances[i].first_clip_vertex;
    const bool mirrored = glm::determinant(glm::dmat3(scene.instances[i].world_from_object)) < 0;
    for (size_t k = 0; k < indices.size(); k += 3) {
      oracle.add({{clip[indices[k]], clip[indices[k + 1]], clip[indices[k + 2]]},
                  scene.instances[i].two_sided,
                  mirrored});
    }
  }
  return oracle;
}

// Vulkan 1.3, "Multisampling", standard sample locations, from a pixel's lower left corner: x, 1 - y.
inline constexpr SnappedPoint standard_locations[4] = {
    {int64_t(0.375 * 256), int64_t(0.875 * 256)},
    {int64_t(0.875 * 256), int64_t(0.625 * 256)},
    {int64_t(0.125 * 256), int64_t(0.375 * 256)},
    {int64_t(0.625 * 256), int64_t(0.125 * 256)},
};

// One of an image's 4 samples a pixel.
inline Drawn sample_of(const Drawn& all, int sample) {
  Drawn one = all;
  one.grid.samples = 1;
  one.triangles.clear();
  one.depths.clear();
  for (size_t i = size_t(sample); i < all.triangles.size(); i += 4) {
    one.triangles.push_back(all.triangles[i]);
    one.depths.push_back(all.depths[i]);
  }
  return one;
}

// Every pixel against the oracle; says the first few that are wrong.
inline int count_wrong(const Drawn& drawn, const CoverageOracle& oracle) {
  int wrong = 0;
  for (int y = 0; y < drawn.grid.height; ++y) {
    for (int x = 0; x < drawn.grid.width; ++x) {
      const size_t i = drawn.grid.index(x, y);
      const std::string why = wrong_at(oracle.at(x, y), drawn.triangles[i], drawn.depths[i]);
      if (!why.empty() && ++wrong <= 5) ADD_FAILURE() << "pixel " << x << " " << y << ": " << why;
    }
  }
  return wrong;
}

inline void expect_right(const TriangleScene& scene, const RasterOptions& options = {}) {
  const Drawn result = drawn(scene, options);
  EXPECT_EQ(count_wrong(result, oracle_of(result, scene)), 0);
}

// A mesh whose triangles share no vertex.
inline void add_triangle(TriangleScene::MeshData& mesh, const glm::vec3& a, const glm::vec3& b,
                         const glm::vec3& c) {
  for (const glm::vec3& p : {a, b, c}) {
    mesh.indices.push_back(uint32_t(mesh.positions.size()));
    mesh.positions.push_back(p);
  }
}

class RandomNumbers {
 public:
  explicit RandomNumbers(uint32_t seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967295.0); }
  int below(int count) { return int(engine_() % uint32_t(count)); }

 private:
  std::mt19937 engine_;
};

}  // namespace lightgrid
