#include "passes/shade_tiles.h"

#include "cl/avx512.h"
#include "cl/launch.h"
#include "passes/frame/light_texels.h"

namespace lightgrid {
namespace {

template <typename T>
cl::Buffer buffer_of(ClDevice& device, const std::vector<T>& values) {
  const std::vector<T>& some = values.empty() ? std::vector<T>(1) : values;  // OpenCL makes no empty buffer
  try {
    return cl::Buffer(device.context(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, some.size() * sizeof(T),
                      const_cast<T*>(some.data()));
  } catch (const cl::Error& error) {
    throw cl_machine_error(error, fmt::format("a buffer of {} bytes", some.size() * sizeof(T)));
  }
}

// Whether the image holds what surfaces show of themselves before the light pass.
bool holds_own_light(const GBuffer& gbuffer) { return gbuffer.own_light == OwnLight::in_image; }

// The geometry buffer and the image as OpenCL reads them, the lights, and the kernels.
class TileShading : public Kept {
 public:
  explicit TileShading(Frame& f)
      : lanes(takes_lanes(f)),
        surfaces{image_buffer(f, layout(f).images[0].bytes), image_buffer(f, layout(f).images[1].bytes)},
        image(image_buffer(f, 16)) {
    const LightTexels texels = light_texels(f.scene, f.view, f.plan);
    ClDevice& device = *f.devices.cl;
    places = buffer_of(device, texels.places), colors = buffer_of(device, texels.colors);
    cones = buffer_of(device, texels.cones), view = buffer_of(device, std::vector<ViewParams>{f.params});
    if (f.plan.z_bins > 1) {
      const auto keys = z_bin_keys(cull_view(f.view, f.plan));
      bin_edges = buffer_of(device, std::vector<float>(keys.begin(), keys.end()));
      edge_bytes_ = sizeof keys;
    }
    light_bytes_ = (texels.places.size() + texels.colors.size() + texels.cones.size()) * sizeof(glm::vec4);
  }

  size_t memory_bytes() const override {
    return surfaces[0].size() + surfaces[1].size() + image.size() + light_bytes_ + edge_bytes_ + sizeof(ViewParams);
  }

  // Built at first use.
  cl::Kernel& kernel(Frame& f, const GBuffer& gbuffer) {
    cl::Kernel& kernel = kernels_[holds_own_light(gbuffer)];
    if (kernel()) return kernel;
    kernel = f.devices.programs->kernel(lanes ? "shade_tiles_lanes" : "shade_tiles_group", defines(f, gbuffer));
    return kernel;
  }

  const bool lanes;
  SharedBuffer surfaces[2], image;
  cl::Buffer places, colors, cones, view, bin_edges;

 private:
  static bool takes_lanes(const Frame& f) {
    const KernelShape shape = f.plan.settings.kernel_shape;
    return shape == KernelShape::lanes || (shape == KernelShape::automatic && f.devices.cl->info().cpu);
  }

  static const GBufferLayout& layout(Frame& f) { return *gbuffer_of(f).layout; }

  static SharedBuffer image_buffer(Frame& f, size_t pixel_bytes) {
    return {*f.devices.cl, f.devices.bridge, (size_t(f.view.width) * f.view.height + Frame::spare_pixels) * pixel_bytes};
  }

  std::string defines(Frame& f, const GBuffer& gbuffer) const {
    std::string defines = fmt::format("-DBUFFER_BITS={}", gbuffer.layout->bits);
    if (lanes) defines += fmt::format(" -DTILE={}", f.plan.settings.tile);
    if (lanes && !f.plan.settings.portable && builds_avx512(*f.devices.cl, *f.devices.programs)) defines += " -DAVX512";
    if (f.plan.index_bits == 32) defines += " -DINDEX_32";
    if (f.plan.z_bins > 1) defines += " -DZ_BINS";
    if (holds_own_light(gbuffer)) defines += " -DOWN_LIGHT";
    if (f.plan.spots) defines += " -DSPOTS";
    if (f.plan.settings.brdf == Brdf::blinn) defines += " -DBLINN";
    if (f.view.orthographic) defines += " -DORTHOGRAPHIC";
    return defines;
  }

  cl::Kernel kernels_[2];  // by holds_own_light
  size_t light_bytes_ = 0, edge_bytes_ = 0;
};

void copy_attachment(Frame& f, int attachment, GLenum type, SharedBuffer& to) {
  glReadBuffer(GL_COLOR_ATTACHMENT0 + GLenum(attachment));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, to.gl_buffer());
  glReadPixels(0, 0, f.view.width, f.view.height, GL_RGBA, type, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

void gbuffer_to_cl(Frame& f, const GBuffer& gbuffer, TileShading& shading) {
  const size_t pixels = size_t(f.view.width) * f.view.height;
  const bool own_light = holds_own_light(gbuffer);
  auto pass = f.timer.pass("gbuffer_to_cl", "gl");
  glBindFramebuffer(GL_READ_FRAMEBUFFER, gbuffer.framebuffer);
  for (int i = 0; i < 2; ++i) copy_attachment(f, i, gbuffer.layout->images[i].type, shading.surfaces[i]);
  if (own_light) copy_attachment(f, 2, GL_FLOAT, shading.image);
  for (int i = 0; i < 2; ++i) shading.surfaces[i].hand_to_cl(pixels * gbuffer.layout->images[i].bytes);
  if (own_light) shading.image.hand_to_cl(pixels * 16);
  const size_t bytes = pixels * (gbuffer.layout->bytes() + (own_light ? 16 : 0));
  pass.moves(bytes, bytes);
}

void image_to_gl(Frame& f, SharedBuffer& image) {
  const size_t bytes = size_t(f.view.width) * f.view.height * 16;
  auto pass = f.timer.pass("image_to_gl", "gl");
  image.hand_to_gl(bytes);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, image.gl_buffer());
  glTextureSubImage2D(f.targets.texture("color", GL_RGBA32F), 0, 0, 0, f.view.width, f.view.height, GL_RGBA, GL_FLOAT,
                      nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  pass.moves(bytes, bytes);
}

void add_light(Frame& f, TileShading& s, const LightGrid& grid, const GBuffer& gbuffer) {
  auto pass = f.timer.pass("shade_tiles", "cl");
  constexpr size_t side = 16;  // of the pixels that a group takes
  const auto whole = [](int pixels) { return (size_t(pixels) + side - 1) / side * side; };
  const cl::NDRange items = s.lanes ? cl::NDRange(f.params.tiles_x, f.params.tiles_y)
                                    : cl::NDRange(whole(f.view.width), whole(f.view.height));
  const bool own_light = holds_own_light(gbuffer);
  const glm::vec3 background = own_light ? glm::vec3(0) : f.scene.background;  // in the image already, or not
  const cl::Buffer light_bins = grid.z_bin_bytes ? f.opaque_grid().z_bins(grid.z_bin_bytes) : cl::Buffer();
  launch(*f.devices.cl, "shade_tiles", s.kernel(f, gbuffer), items,
         s.lanes ? cl::NDRange(1, 1) : cl::NDRange(side, side), s.surfaces[0].cl_buffer(), s.surfaces[1].cl_buffer(), f.depth_copy().cl_buffer(), s.places, s.colors, s.cones,
         f.opaque_grid().cells(grid.cell_bytes), f.opaque_grid().indices(grid.index_bytes), light_bins, s.bin_edges,
         s.image.cl_buffer(), cl_float4{{background.r, background.g, background.b, 0}}, s.view);
  const size_t pixels = size_t(f.view.width) * f.view.height;
  const size_t surface_bytes = gbuffer.layout->bytes() + 4 + (own_light ? 16 : 0);
  pass.moves(pixels * surface_bytes + grid.cell_bytes + grid.index_bytes + grid.z_bin_bytes, pixels * 16);
}

}  // namespace

ShadedImage shade_tiles(Frame& f, const GBuffer& gbuffer, const LightGrid& grid) {
  TileShading& shading = f.kept<TileShading>();
  gbuffer_to_cl(f, gbuffer, shading);
  if (f.plan.settings.depth_bounds == DepthBoundsMode::none) depth_to_cl(f, gbuffer.depth_image);  // no bounds read it
  add_light(f, shading, grid, gbuffer);
  if (!f.plan.blend) return {gbuffer.image.framebuffer, &shading.image};
  image_to_gl(f, shading.image);
  return gbuffer.image;
}

}  // namespace lightgrid
