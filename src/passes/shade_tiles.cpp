#include "passes/shade_tiles.h"

#include "cl/avx512.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "renderer/light_texels.h"

namespace lightgrid {
namespace {

// A read-only buffer that is rewritten in place while its size stays the same.
class Uploaded {
 public:
  template <typename T>
  void put(ClDevice& device, const std::vector<T>& values) {
    put(device, values.data(), values.size() * sizeof(T));
  }
  const cl::Buffer& buffer() const { return buffer_; }

 private:
  void put(ClDevice& device, const void* data, size_t bytes) {
    if (!buffer_() || bytes != bytes_) {
      const size_t size = std::max<size_t>(bytes, 16);  // OpenCL allows no empty buffer
      buffer_ = cl::Buffer();
      try {
        buffer_ = cl::Buffer(device.context(), CL_MEM_READ_ONLY, size);
      } catch (const cl::Error& error) {
        throw cl_machine_error(error, fmt::format("a buffer of {} bytes", size));
      }
      bytes_ = bytes;
    }
    if (bytes > 0) write_buffer(device, "uploading lights", buffer_, data, bytes);
  }

  cl::Buffer buffer_;
  size_t bytes_ = 0;
};

// Whether the image already contains base lighting before the light pass.
bool holds_base_lighting(const GBuffer& gbuffer) { return gbuffer.base_lighting == BaseLighting::in_image; }

// The geometry buffer and the image as OpenCL reads them, the lights, and the kernels.
class TileShading : public PassState {
 public:
  explicit TileShading(RenderView& v)
      : lanes(takes_lanes(v)),
        surfaces{image_buffer(v, layout(v).images[0].bytes), image_buffer(v, layout(v).images[1].bytes)},
        image(image_buffer(v, 16)),
        defines_(view_defines(v)) {
    upload(v);
  }

  // Another camera at the same size, or moved lights; kernels are rebuilt only if the plan changed.
  bool follow(RenderView& v) override {
    std::string defines = view_defines(v);
    if (defines != defines_) {
      defines_ = std::move(defines);
      for (cl::Kernel& kernel : kernels_) kernel = cl::Kernel();
    }
    upload(v);
    return true;
  }

  size_t memory_bytes() const override {
    return surfaces[0].size() + surfaces[1].size() + image.size() + light_bytes_ + edge_bytes_ + sizeof(ViewParams);
  }

  // Built at first use.
  cl::Kernel& kernel(RenderView& v, const GBuffer& gbuffer) {
    cl::Kernel& kernel = kernels_[holds_base_lighting(gbuffer)];
    if (kernel()) return kernel;
    const std::string defines = fmt::format("-DBUFFER_BITS={}{}{}", gbuffer.layout->bits, defines_,
                                            holds_base_lighting(gbuffer) ? " -DBASE_LIGHTING" : "");
    kernel = v.renderer.kernels->kernel(lanes ? "cpu/shade_tiles" : "gpu/shade_tiles", defines);
    return kernel;
  }

  const bool lanes;
  SharedBuffer surfaces[2], image;
  Uploaded positions, colors, cones, view, bin_edges;

 private:
  static bool takes_lanes(const RenderView& v) {
    const KernelShape shape = v.plan.settings.kernel_shape;
    return shape == KernelShape::lanes || (shape == KernelShape::automatic && v.renderer.cl->info().cpu);
  }

  static const GBufferLayout& layout(RenderView& v) { return *gbuffer_of(v).layout; }

  static SharedBuffer image_buffer(RenderView& v, size_t pixel_bytes) {
    return {*v.renderer.cl, v.renderer.bridge, (v.pixels() + RenderView::spare_pixels) * pixel_bytes};
  }

  std::string view_defines(const RenderView& v) const {
    std::string defines;
    if (lanes) defines += fmt::format(" -DTILE={}", v.plan.settings.tile);
    if (lanes && !v.plan.settings.portable && builds_avx512(*v.renderer.cl, *v.renderer.kernels)) defines += " -DAVX512";
    if (v.plan.index_bits == 32) defines += " -DINDEX_32";
    if (v.plan.z_bins > 1) defines += " -DZ_BINS";
    if (v.plan.spots) defines += " -DSPOTS";
    if (v.plan.settings.brdf == Brdf::blinn) defines += " -DBLINN";
    if (v.view.orthographic) defines += " -DORTHOGRAPHIC";
    return defines;
  }

  void upload(RenderView& v) {
    const LightTexels texels = light_texels(v.scene, v.view, v.plan);
    ClDevice& device = *v.renderer.cl;
    positions.put(device, texels.positions);
    colors.put(device, texels.colors);
    cones.put(device, texels.cones);
    view.put(device, std::vector<ViewParams>{v.params});
    edge_bytes_ = 0;
    if (v.plan.z_bins > 1) {
      const auto keys = z_bin_keys(cull_view(v.view, v.plan));
      bin_edges.put(device, std::vector<float>(keys.begin(), keys.end()));
      edge_bytes_ = sizeof keys;
    }
    light_bytes_ = (texels.positions.size() + texels.colors.size() + texels.cones.size()) * sizeof(glm::vec4);
  }

  std::string defines_;    // of the view and its plan
  cl::Kernel kernels_[2];  // by holds_base_lighting
  size_t light_bytes_ = 0, edge_bytes_ = 0;
};

void copy_attachment(RenderView& v, int attachment, GLenum type, SharedBuffer& to) {
  glReadBuffer(GL_COLOR_ATTACHMENT0 + GLenum(attachment));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, to.gl_buffer());
  glReadPixels(0, 0, v.view.width, v.view.height, GL_RGBA, type, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void gbuffer_to_cl(RenderView& v, const GBuffer& gbuffer, TileShading& shading) {
  const size_t pixels = v.pixels();
  const bool base_lighting = holds_base_lighting(gbuffer);
  auto pass = v.timer.pass("gbuffer_to_cl", "gl");
  glBindFramebuffer(GL_READ_FRAMEBUFFER, gbuffer.framebuffer);
  for (int i = 0; i < 2; ++i) copy_attachment(v, i, gbuffer.layout->images[i].type, shading.surfaces[i]);
  if (base_lighting) copy_attachment(v, 2, GL_FLOAT, shading.image);
  for (int i = 0; i < 2; ++i) shading.surfaces[i].hand_to_cl(pixels * gbuffer.layout->images[i].bytes);
  if (base_lighting) shading.image.hand_to_cl(pixels * 16);
  const size_t bytes = pixels * (gbuffer.layout->bytes() + (base_lighting ? 16 : 0));
  pass.moves(bytes, bytes);
}

void image_to_gl(RenderView& v, SharedBuffer& image) {
  const size_t bytes = v.pixels() * 16;
  auto pass = v.timer.pass("image_to_gl", "gl");
  image.hand_to_gl(bytes);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, image.gl_buffer());
  glTextureSubImage2D(v.targets.texture("color", GL_RGBA32F), 0, 0, 0, v.view.width, v.view.height, GL_RGBA, GL_FLOAT,
                      nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  pass.moves(bytes, bytes);
}

void add_light(RenderView& v, TileShading& s, const GBuffer& gbuffer, const DepthBuffer& depth, const LightGrid& grid) {
  auto pass = v.timer.pass("shade_tiles", "cl");
  constexpr size_t side = 16;  // pixels a side of a work-group's tile
  const auto whole = [](int pixels) { return (size_t(pixels) + side - 1) / side * side; };
  const cl::NDRange items = s.lanes ? cl::NDRange(v.params.tiles_x, v.params.tiles_y)
                                    : cl::NDRange(whole(v.view.width), whole(v.view.height));
  const bool base_lighting = holds_base_lighting(gbuffer);
  const glm::vec3 background = base_lighting ? glm::vec3(0) : v.scene.background;  // in the image already, or not
  const cl::Buffer light_bins = grid.z_bin_bytes ? v.opaque_grid().z_bins(grid.z_bin_bytes) : cl::Buffer();
  launch(*v.renderer.cl, "shade_tiles", s.kernel(v, gbuffer), items,
         s.lanes ? cl::NDRange(1, 1) : cl::NDRange(side, side), s.surfaces[0].cl_buffer(), s.surfaces[1].cl_buffer(),
         depth.values, s.positions.buffer(), s.colors.buffer(), s.cones.buffer(), v.opaque_grid().cells(grid.cell_bytes),
         v.opaque_grid().indices(grid.index_bytes), light_bins, s.bin_edges.buffer(), s.image.cl_buffer(),
         cl_float4{{background.r, background.g, background.b, 0}}, s.view.buffer());
  const size_t pixels = v.pixels();
  const size_t surface_bytes = gbuffer.layout->bytes() + 4 + (base_lighting ? 16 : 0);
  pass.moves(pixels * surface_bytes + grid.cell_bytes + grid.index_bytes + grid.z_bin_bytes, pixels * 16);
}

}  // namespace

ShadedImage shade_tiles(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth, const LightGrid& grid) {
  TileShading& shading = v.state<TileShading>();
  gbuffer_to_cl(v, gbuffer, shading);
  add_light(v, shading, gbuffer, depth, grid);
  if (!v.plan.blend) return {gbuffer.image.framebuffer, &shading.image};
  image_to_gl(v, shading.image);
  return gbuffer.image;
}

}  // namespace lightgrid
