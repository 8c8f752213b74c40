#include "passes/shade_tiles.h"

#include "cl/launch.h"
#include "renderer/cl_lights.h"
#include "renderer/model_records.h"

namespace lightgrid {
namespace {

// Whether the image already contains base lighting before the light pass.
bool holds_base_lighting(const GBufferInCl& gbuffer) {
  return gbuffer.base_lighting == BaseLighting::in_image;
}

// The lights and the kernels.
class TileShading : public PassState {
 public:
  explicit TileShading(RenderView& v) : lanes(shades_in_lanes(v)), defines_(defines_of_view(v)) {
    lights.upload(v);
    if (v.plan.skin || v.plan.minnaert)
      models.put(*v.renderer.cl, "uploading models of materials", model_records(v.scene));
  }

  // Another camera at the same size, or moved lights; kernels are rebuilt only if the plan changed.
  bool follow(RenderView& v) override {
    std::string defines = defines_of_view(v);
    if (defines != defines_) {
      defines_ = std::move(defines);
      for (cl::Kernel& kernel : kernels_) kernel = cl::Kernel();
    }
    lights.upload(v);
    return true;
  }

  size_t memory_bytes() const override { return lights.memory_bytes() + models.bytes(); }

  // Built at first use.
  cl::Kernel& kernel(RenderView& v, const GBufferInCl& gbuffer) {
    cl::Kernel& kernel = kernels_[holds_base_lighting(gbuffer)];
    if (kernel()) return kernel;
    const std::string defines = fmt::format("-DBUFFER_BITS={}{}{}", gbuffer.layout->bits, defines_,
                                            holds_base_lighting(gbuffer) ? " -DBASE_LIGHTING" : "");
    kernel =
        v.renderer.kernels->kernel(lanes ? "resolve/cpu/shade_tiles" : "resolve/gpu/shade_tiles", defines);
    return kernel;
  }

  const bool lanes;
  ClLights lights;
  UploadedBuffer models;  // MaterialModelRecord each

 private:
  std::string defines_of_view(RenderView& v) const {
    std::string defines = light_defines(v, lanes, v.plan.settings.brdf);
    if (v.plan.clearcoat) defines += " -DCLEARCOAT";
    if (v.plan.specular) defines += " -DSPECULAR";
    for (const char* define : model_defines(v.plan)) defines += fmt::format(" -D{}", define);
    return defines;
  }

  std::string defines_;    // of the view and its plan
  cl::Kernel kernels_[2];  // by holds_base_lighting
};

void copy_attachment(RenderView& v, const GBuffer& gbuffer, int attachment, GLuint texture, GLenum type,
                     SharedBuffer& to) {
  v.renderer.pixel_copies.to_buffer({gbuffer.framebuffer, GL_COLOR_ATTACHMENT0 + GLenum(attachment), texture},
                                    GL_RGBA, type, v.view.width, v.view.height, to.gl_buffer());
}

GBufferInCl gbuffer_to_cl(RenderView& v, const GBuffer& gbuffer) {
  const size_t pixels = v.pixels();
  const GBufferInCl in_cl = gbuffer_in_cl_of(v, gbuffer.base_lighting, TargetUse::image);
  const bool base_lighting = holds_base_lighting(in_cl);
  auto pass = v.timer.pass("gbuffer_to_cl", "gl");
  std::vector<SharedBuffer::Written> copies;
  for (const size_t i : in_cl.images)
    copies.push_back({in_cl.surfaces[i], pixels * gbuffer.layout->images[i].bytes});
  if (base_lighting) copies.push_back({in_cl.image, pixels * 16});
  std::vector<SharedBuffer*> buffers;
  for (const SharedBuffer::Written& copy : copies) buffers.push_back(copy.buffer);
  SharedBuffer::take_for_gl(buffers);
  for (const size_t i : in_cl.images) {
    copy_attachment(v, gbuffer, gbuffer.attachment(i), gbuffer.textures[i], gbuffer.layout->images[i].type,
                    *in_cl.surfaces[i]);
  }
  if (base_lighting)
    copy_attachment(v, gbuffer, 2, v.targets.texture("color", GL_RGBA32F), GL_FLOAT, *in_cl.image);
  SharedBuffer::hand_to_cl(copies);
  const size_t bytes = pixels * (gbuffer.bytes() + (base_lighting ? 16 : 0));
  pass.moves(bytes, bytes);
  return in_cl;
}

void image_to_gl(RenderView& v, SharedBuffer& image) {
  const size_t bytes = v.pixels() * 16;
  auto pass = v.timer.pass("image_to_gl", "gl");
  image.hand_to_gl(bytes);
  v.renderer.pixel_copies.to_texture(image.gl_buffer(), GL_RGBA, GL_FLOAT, v.view.width, v.view.height,
                                     v.targets.texture("color", GL_RGBA32F));
  pass.moves(bytes, bytes);
}

void add_light(RenderView& v, const GBufferInCl& gbuffer, const DepthBuffer& depth, const LightGrid& grid) {
  TileShading& s = v.state<TileShading>();
  auto pass = v.timer.pass("shade_tiles", "cl");
  constexpr size_t side = 16;  // pixels a side of a work-group's tile
  const auto whole = [](int pixels) { return (size_t(pixels) + side - 1) / side * side; };
  const cl::NDRange items = s.lanes ? cl::NDRange(v.params.tiles_x, v.params.tiles_y)
                                    : cl::NDRange(whole(v.view.width), whole(v.view.height));
  const bool base_lighting = holds_base_lighting(gbuffer);
  const glm::vec3 background =
      base_lighting ? glm::vec3(0) : v.scene.background;  // in the image already, or not
  const cl::Buffer light_bins = grid.z_bin_bytes ? v.opaque_grid().z_bins(grid.z_bin_bytes) : cl::Buffer();
  launch(*v.renderer.cl, "shade_tiles", s.kernel(v, gbuffer), items,
         s.lanes ? cl::NDRange(1, 1) : cl::NDRange(side, side), gbuffer.surfaces[0]->cl_buffer(),
         gbuffer.surfaces[1]->cl_buffer(), gbuffer.in_cl(gbuffer_coat), gbuffer.in_cl(gbuffer_specular),
         s.models.buffer(), depth.values, s.lights.positions.buffer(), s.lights.colors.buffer(),
         s.lights.cones.buffer(), v.opaque_grid().cells(grid.cell_bytes),
         v.opaque_grid().indices(grid.index_bytes), light_bins, s.lights.bin_edges.buffer(),
         gbuffer.image->cl_buffer(), cl_float4{{background.r, background.g, background.b, 0}},
         s.lights.view.buffer());
  const size_t pixels = v.pixels();
  const size_t surface_bytes = gbuffer.bytes() + 4 + (base_lighting ? 16 : 0);
  pass.moves(pixels * surface_bytes + grid.cell_bytes + grid.index_bytes + grid.z_bin_bytes, pixels * 16);
}

}  // namespace

ShadedImage shade_tiles(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth,
                        const LightGrid& grid) {
  const GBufferInCl in_cl = gbuffer_to_cl(v, gbuffer);
  add_light(v, in_cl, depth, grid);
  if (!v.plan.blend) return {gbuffer.image.framebuffer, in_cl.image};
  image_to_gl(v, *in_cl.image);
  return gbuffer.image;
}

ShadedImage shade_tiles(RenderView& v, const GBufferInCl& gbuffer, const DepthBuffer& depth,
                        const LightGrid& grid) {
  add_light(v, gbuffer, depth, grid);
  return {0, gbuffer.image};
}

}  // namespace lightgrid
