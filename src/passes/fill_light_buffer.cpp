#include "passes/fill_light_buffer.h"

#include <fmt/format.h>

#include "cl/launch.h"
#include "renderer/cl_lights.h"

namespace lightgrid {
namespace {

std::string defines_of_light_buffer(RenderView& v, bool lanes) {
  const Settings& s = v.plan.settings;
  // The same kernel for both BRDFs with a specular lobe.
  std::string defines = light_defines(v, lanes, s.brdf == Brdf::lambert ? Brdf::lambert : Brdf::ggx);
  defines += fmt::format(" -DBUFFER_BITS={}", s.buffer_bits);
  if (normal_layout(s).define) defines += fmt::format(" -D{}", normal_layout(s).define);
  if (has_fifth_term(s)) defines += " -DPREPASS_FIFTH_TERM";
  return defines;
}

// The lights and the kernel.
class LightSums : public PassState {
 public:
  explicit LightSums(RenderView& v) : lanes(shades_in_lanes(v)) { follow(v); }

  // Kernels are rebuilt only if the plan changed.
  bool follow(RenderView& v) override {
    std::string defines = defines_of_light_buffer(v, lanes);
    if (defines != defines_) {
      defines_ = std::move(defines);
      kernel_ = cl::Kernel();
    }
    lights.upload(v);
    return true;
  }

  size_t memory_bytes() const override { return lights.memory_bytes(); }

  // Built at first use.
  cl::Kernel& kernel(RenderView& v) {
    if (!kernel_())
      kernel_ = v.renderer.kernels->kernel(lanes ? "resolve/cpu/light_buffer" : "resolve/gpu/light_buffer",
                                           defines_);
    return kernel_;
  }

  const bool lanes;
  ClLights lights;

 private:
  std::string defines_;
  cl::Kernel kernel_;
};

void sums_to_gl(RenderView& v, const PrepassImage& image, SharedBuffer& from, GLuint to) {
  v.renderer.pixel_copies.to_texture(from.gl_buffer(), image.pixel, image.type, v.view.width, v.view.height,
                                     to);
}

}  // namespace

NormalsInCl normals_to_cl(RenderView& v, const NormalImage& normals) {
  const PrepassImage& image = normals.layout->image;
  const size_t bytes = v.pixels() * image.bytes;
  const NormalsInCl in_cl = normals_in_cl_of(v, TargetUse::image);
  auto pass = v.timer.pass("normals_to_cl", "gl");
  v.renderer.pixel_copies.to_buffer({normals.framebuffer, GL_COLOR_ATTACHMENT0, normals.texture}, image.pixel,
                                    image.type, v.view.width, v.view.height, in_cl.image->gl_buffer());
  in_cl.image->hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return in_cl;
}

LightBufferInCl fill_light_buffer(RenderView& v, const NormalsInCl& normals, const DepthBuffer& depth,
                                  const LightGrid& grid, TargetUse use) {
  LightSums& s = v.state<LightSums>();
  cl::Kernel& kernel = s.kernel(v);
  LightBufferInCl buffer{&light_buffer_layout(v.plan.settings), nullptr, nullptr};
  buffer.first = &v.shared_pixels("light buffer", buffer.layout->first.bytes, use);
  if (has_fifth_term(v.plan.settings))
    buffer.second = &v.shared_pixels("light buffer 2", buffer.layout->second.bytes, use);
  auto pass = v.timer.pass("fill_light_buffer", "cl");
  constexpr size_t side = 16;  // pixels a side of a work-group's tile
  const auto whole = [](int pixels) { return (size_t(pixels) + side - 1) / side * side; };
  const cl::NDRange items = s.lanes ? cl::NDRange(v.params.tiles_x, v.params.tiles_y)
                                    : cl::NDRange(whole(v.view.width), whole(v.view.height));
  const cl::Buffer light_bins = grid.z_bin_bytes ? v.opaque_grid().z_bins(grid.z_bin_bytes) : cl::Buffer();
  launch(*v.renderer.cl, "fill_light_buffer", kernel, items,
         s.lanes ? cl::NDRange(1, 1) : cl::NDRange(side, side), normals.image->cl_buffer(), depth.values,
         s.lights.positions.buffer(), s.lights.colors.buffer(), s.lights.cones.buffer(),
         v.opaque_grid().cells(grid.cell_bytes), v.opaque_grid().indices(grid.index_bytes), light_bins,
         s.lights.bin_edges.buffer(), buffer.first->cl_buffer(),
         buffer.second ? buffer.second->cl_buffer() : cl::Buffer(),
         cl_float(v.plan.settings.prepass_shininess), cl_float(1 / stored_scale(v)), s.lights.view.buffer());
  pass.moves(
      v.pixels() * (4 + normals.layout->image.bytes) + grid.cell_bytes + grid.index_bytes + grid.z_bin_bytes,
      v.pixels() * buffer.bytes());
  return buffer;
}

LightBuffer light_buffer_to_gl(RenderView& v, const LightBufferInCl& buffer) {
  const LightBuffer in_gl = light_buffer_of(v);
  const size_t bytes = v.pixels() * buffer.bytes();
  auto pass = v.timer.pass("light_buffer_to_gl", "gl");
  std::vector<SharedBuffer::Written> written = {{buffer.first, v.pixels() * buffer.layout->first.bytes}};
  if (buffer.second) written.push_back({buffer.second, v.pixels() * buffer.layout->second.bytes});
  SharedBuffer::hand_to_gl(written);
  sums_to_gl(v, buffer.layout->first, *buffer.first, in_gl.first);
  if (buffer.second) sums_to_gl(v, buffer.layout->second, *buffer.second, in_gl.second);
  pass.moves(bytes, bytes);
  return in_gl;
}

}  // namespace lightgrid
