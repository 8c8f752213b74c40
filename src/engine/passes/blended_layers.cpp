// Fragments into layers, by a kernel or by OpenGL. How many layers there are is known afterwards: with too
// little room they are counted, and found once more.
#include "passes/blended_layers.h"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "base/error.h"
#include "cl/transfer.h"
#include "plan/settings/kernels.h"
#include "raster/raster_samples.h"
#include "renderer/drawing/draw.h"
#include "scene/host_shadows.h"
#include "shared/shadow_bits.h"

namespace lightgrid {
namespace {

size_t stride_of(const PassContext& work) { return LAYER_STRIDE(work.grid().pixels()); }

// Values: numbers, then depths, a layer each, then how many fragments each pixel has, and the most of any.
size_t bytes_of_layers(const PassContext& work, size_t layers) {
  return (2 * layers + 1) * stride_of(work) * 4;
}

cl::Buffer& room_for(PassContext& work, size_t layers) {
  const size_t bytes = bytes_of_layers(work, layers);
  if (work.plan.opengl && bytes > max_texture_bytes(GL_R32UI)) {
    throw machine_error(
        "shadows: {} bytes of {} blended surfaces one behind the other are more than the {} that a buffer "
        "texture "
        "may have in this OpenGL; use raster=opencl or a smaller picture",
        bytes, layers, max_texture_bytes(GL_R32UI));
  }
  return work.shadows.layers.at_least(work.renderer, bytes, GL_R32UI, work.plan.opengl);
}

uint32_t triangles_of(const Scene& scene, int instance) {
  return uint32_t(scene.meshes[size_t(scene.instances[size_t(instance)].mesh)].indices.size() / 3);
}

cl::Buffer part_of(const cl::Buffer& buffer, size_t begin, size_t bytes) {
  const cl_buffer_region region{begin, bytes};
  cl_int failed = CL_SUCCESS;
  const cl_mem part =
      clCreateSubBuffer(buffer(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &failed);
  if (failed != CL_SUCCESS) throw machine_error("shadows: a part of a buffer: OpenCL error {}", failed);
  return cl::Buffer(part);
}

}  // namespace

class FragmentLayers : public PassCache {
 public:
  explicit FragmentLayers(PassContext& work) : kernels_(work, "resolve") {}
  bool follow(PassContext&) override { return true; }
  size_t memory_bytes() const override { return most_.bytes(); }

  BlendedLayers find(PassContext& work, const BlendedTriangles* blended, const DepthBuffer& depth) {
    size_t layers = blended ? list(work, *blended, depth) : draw(work);
    if (layers > capacity_) {
      capacity_ = layers;
      layers = blended ? list(work, *blended, depth) : draw(work);
      assert(layers <= capacity_);
    }
    work.shadows.layer_count = uint32_t(layers);
    BlendedLayers found = parts(work, layers);
    uint32_t first = 0;
    for (const int i : work.plan.surfaces.blended) {
      found.first_numbers.emplace_back(blended ? first : work.shadows.first_triangles[size_t(i)], i);
      first += triangles_of(work.scene, i);
    }
    return found;
  }

 private:
  // All of OpenCL's. Returns the most fragments of a pixel.
  size_t list(PassContext& work, const BlendedTriangles& blended, const DepthBuffer& depth) {
    ClDevice& device = *work.renderer.cl;
    const size_t bytes = capacity_ * stride_of(work) * 4,
                 tiles = blended.lists.tiles_x * blended.lists.tiles_y;
    const cl::Buffer& room = room_for(work, capacity_);
    const cl::Buffer& most = most_.at_least(device, tiles * sizeof(cl_uint));
    const Layout layout{work.grid().width, work.grid().height, capacity_};
    const bool cleared = std::exchange(layout_, std::nullopt) == layout;
    if (!cleared) {
      // All through the buffer itself. NVIDIA's driver loses what is written through a part of a buffer that
      // was not in use before: in a view's first frame.
      fill_buffer(device, "clearing layers", room, 0, 2 * bytes);
      fill_buffer(device, "clearing layers", room, SHADOW_NO_TRIANGLE, bytes);
    }
    if (!cleared || !kernels_.lanes) fill_buffer(device, "clearing layers", most, 0, tiles * sizeof(cl_uint));
    kernels_.use(sample_defines(work.grid().samples) +
                 (kernels_.lanes && work.plan.settings[setting::portable] ? " -DPORTABLE" : ""));
    const PixelRange pixels = over_pixels(work, kernels_.lanes, 8, 16);
    kernels_.of("blended_layers")
        .launch(device, "blended_layers", kernels_.lanes ? cl::NDRange(tiles) : pixels.items,
                kernels_.lanes ? cl::NDRange(1) : pixels.group,
                {{"records", blended.lists.records},
                 {"tile_begin", blended.lists.tile_begin},
                 {"lists", blended.lists.lists},
                 {"tiles_x", cl_uint(blended.lists.tiles_x)},
                 {"depths", depth.values},
                 {"capacity", cl_uint(capacity_)},
                 {"view", work.cl_lights().view.buffer()},
                 {"layers", room},
                 {"most", most}});
    std::vector<cl_uint> found(tiles);
    read_buffer(device, "counting layers", most, found.data(), found.size() * sizeof found[0]);
    layout_ = layout;
    return std::ranges::max(found);
  }

  // The same by OpenGL, over its depth image.
  size_t draw(PassContext& work) {
    const size_t stride = stride_of(work), bytes = bytes_of_layers(work, capacity_);
    layout_.reset();
    room_for(work, capacity_);
    SharedTexture& layers = work.shadows.layers;
    const GLuint buffer = layers.buffer->gl_buffer(), none = SHADOW_NO_TRIANGLE, zero = 0;
    const auto clear = [&](size_t first, size_t values, GLuint value) {
      glClearNamedBufferSubData(buffer, GL_R32UI, GLintptr(first * 4), GLsizeiptr(values * 4), GL_RED_INTEGER,
                                GL_UNSIGNED_INT, &value);
    };
    clear(0, capacity_ * stride, none);
    clear(capacity_ * stride, (capacity_ + 1) * stride, zero);
    work.lights.bind();
    glBindFramebuffer(GL_FRAMEBUFFER, work.depth_framebuffer());
    glViewport(0, 0, work.grid().width, work.grid().height);
    glDepthMask(GL_FALSE);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glBindImageTexture(only_image, layers.texture.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_R32UI);
    const SceneProgram& program = work.programs({"shaders/scene.vert",
                                                 "shaders/blended_layers.frag",
                                                 {},
                                                 true,
                                                 [](uint32_t) -> uint32_t { return 0; }})
                                      .of(0);
    const GLint capacity = glGetUniformLocation(program.name, "capacity");
    InstanceDrawer drawer(work, DrawStreams::all);
    for (const DrawItem& item : work.blended) {
      assert(item.ranges.counts.size() == 1);  // gl_PrimitiveID is the triangle's number in its mesh
      drawer.bind(item.instance, program);
      glUniform1ui(program.object, work.shadows.first_triangles[size_t(item.instance)]);
      glUniform1ui(capacity, GLuint(capacity_));
      drawer.draw(item.ranges);
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    GLuint most = 0;
    glGetNamedBufferSubData(buffer, GLintptr((2 * capacity_ * stride + work.grid().pixels()) * 4),
                            sizeof most, &most);
    if (most <= capacity_) layers.buffer->hand_to_cl(bytes);
    return most;
  }

  BlendedLayers parts(PassContext& work, size_t layers) {
    BlendedLayers found;
    const cl::Buffer& room = work.shadows.layers.buffer->cl_buffer();
    const size_t bytes = stride_of(work) * 4;
    for (size_t i = 0; i < layers; ++i) {
      found.numbers.push_back(part_of(room, i * bytes, bytes));
      found.depths.push_back(part_of(room, (capacity_ + i) * bytes, bytes));
    }
    found.bytes = 2 * layers * bytes;
    return found;
  }

  // The kernel's last frame, which holds no fragments where `most_` counts none. A buffer that grew has
  // another.
  struct Layout {
    int width, height;
    size_t layers;
    bool operator==(const Layout&) const = default;
  };

  PassKernels kernels_;
  GrowingBuffer most_;
  std::optional<Layout> layout_;
  size_t capacity_ = 1;  // layers
};

BlendedLayers find_layers(PassContext& work, Cached<FragmentLayers>& cache, const BlendedTriangles* blended,
                          const DepthBuffer& depth) {
  work.shadows.layer_count = 0;
  if (work.plan.surfaces.blended.empty()) return {};
  auto pass = work.timer.pass("blended_layers", blended ? "cl" : "gl");
  const BlendedLayers layers = cache.of(work).find(work, blended, depth);
  pass.moves(work.grid().values() * 4, layers.bytes);
  return layers;
}

std::vector<HostShadowLayer> read_fragments(PassContext& work, const BlendedLayers& layers) {
  std::vector<HostShadowLayer> read(layers.numbers.size());
  std::vector<uint32_t> numbers(work.grid().pixels());
  for (size_t i = 0; i < read.size(); ++i) {
    read[i].depth.resize(numbers.size());
    read_buffer(*work.renderer.cl, "reading layers", layers.numbers[i], numbers.data(), numbers.size() * 4);
    read_buffer(*work.renderer.cl, "reading layers", layers.depths[i], read[i].depth.data(),
                numbers.size() * 4);
    for (const uint32_t number : numbers) {
      glm::ivec2 triangle(-1, 0);
      for (const auto& [first, instance] : layers.first_numbers) {
        if (number != SHADOW_NO_TRIANGLE && number - first < triangles_of(work.scene, instance))
          triangle = {instance, int(number - first)};
      }
      read[i].triangles.push_back(triangle);
    }
  }
  return read;
}

}  // namespace lightgrid
