#include "run/frames.h"

#include <algorithm>

#include "passes/depth_prepass.h"
#include "passes/frame_stages.h"

namespace lightgrid {
namespace {

template <typename T>
std::vector<T> values_of(const RenderView& v, const char* what, const cl::Buffer& buffer, size_t count) {
  std::vector<T> values(count);
  read_buffer(*v.renderer.cl, what, buffer, values.data(), count * sizeof(T));
  return values;
}

// While it exists, only surfaces at `pixels` pass shading's depth test: elsewhere depth is 1, nearer than
// everything.
class DepthOfPixels {
 public:
  DepthOfPixels(RenderView& v, std::span<const uint32_t> pixels) : v_(v), all_(read_depth(v)) {
    std::vector<float> masked(all_.size(), 1.0f);
    for (const uint32_t pixel : pixels) masked[pixel] = all_[pixel];
    write(masked);
  }
  ~DepthOfPixels() { write(all_); }
  DepthOfPixels(const DepthOfPixels&) = delete;
  DepthOfPixels& operator=(const DepthOfPixels&) = delete;

 private:
  void write(const std::vector<float>& depth) {
    glTextureSubImage2D(v_.targets.depth(), 0, 0, 0, v_.view.width, v_.view.height, GL_DEPTH_COMPONENT,
                        GL_FLOAT, depth.data());
  }

  RenderView& v_;
  const std::vector<float> all_;
};

}  // namespace

std::vector<float> draw_depth(RenderView& v) {
  if (!v.plan.opengl)
    return values_of<float>(v, "reading depth", rasterize(v, v.caches).depth().values, v.grid().values());
  reset_gl_state();
  depth_prepass(v);
  return read_depth(v);
}

Frame draw_shadows(RenderView& v) {
  Frame frame = frame_of(v, find_surfaces(v));
  end_stages(v, v.caches, frame);
  return frame;
}

void draw_forward_at(RenderView& v, std::span<const uint32_t> pixels, Image& image) {
  const Surfaces surfaces = find_surfaces(v);
  const DepthOfPixels masked(v, pixels);
  const LightSource lights = every_light(v);
  const ShadedImage shaded = shade(v, surfaces, lights);
  blend(v, surfaces, lights, shaded);
  read_back(v, shaded, image);
}

std::vector<float> read_depth(RenderView& v, const Frame& frame) {
  if (!frame.depth) return read_depth(v);
  return values_of<float>(v, "reading depth", frame.depth->values, v.grid().pixels());
}

std::vector<float> read_depth(TechniqueRun& run) { return read_depth(run.view(), run.frame()); }

std::vector<MeshTriangle> read_mesh_triangles(const RenderView& v, const Frame& frame) {
  const std::span<const int> instances = frame.triangles->instances;
  std::vector<uint32_t> first;  // by place in `instances`
  uint32_t count = 0;
  for (const int i : instances) {
    first.push_back(count);
    count += uint32_t(v.scene.meshes[size_t(v.scene.instances[size_t(i)].mesh)].indices.size() / 3);
  }
  std::vector<MeshTriangle> triangles;
  for (const uint32_t number :
       values_of<uint32_t>(v, "reading triangles", frame.triangles->numbers, v.grid().pixels())) {
    if (number >= count) {
      triangles.emplace_back();
      continue;
    }
    const size_t place = size_t(std::ranges::upper_bound(first, number) - first.begin()) - 1;
    triangles.push_back({instances[place], number - first[place]});
  }
  return triangles;
}

std::vector<SceneTriangle> own_triangles(TechniqueRun& run) {
  const Scene& scene = run.view().scene;
  std::vector<SceneTriangle> triangles;
  for (const MeshTriangle& shown : read_mesh_triangles(run.view(), run.frame())) {
    if (shown.instance < 0) {
      triangles.emplace_back();
      continue;
    }
    const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(shown.instance)].mesh)];
    triangles.push_back(scene_triangle(shown.instance, &mesh.indices[3 * size_t(shown.number)]));
  }
  return triangles;
}

std::vector<SceneTriangle> shown_triangles(TechniqueRun& run) {
  return run.frame().triangles ? own_triangles(run) : read_triangles(run.view()).opaque;
}

}  // namespace lightgrid
