#include "passes/fill_light_buffer.h"

#include <fmt/format.h>

#include "cl/launch.h"
#include "renderer/cl_lights.h"

namespace lightgrid {
namespace {

std::string defines_of_light_buffer(const Seen& seen, bool lanes) {
  const Settings& s = seen.plan.settings;
  // The same kernel for both BRDFs with a specular lobe.
  std::string defines = light_defines(seen, lanes, s.brdf == Brdf::lambert ? Brdf::lambert : Brdf::ggx);
  defines += fmt::format(" -DBUFFER_BITS={}", s.buffer_bits);
  if (normal_layout(s).define) defines += fmt::format(" -D{}", normal_layout(s).define);
  if (has_fifth_term(s)) defines += " -DPREPASS_FIFTH_TERM";
  return defines;
}

}  // namespace

// The kernel.
class LightSums : public PassCache {
 public:
  explicit LightSums(Work& work, const Seen& seen) : lanes(shades_in_lanes(work, seen)) {
    follow(work, seen);
  }

  // Kernels are rebuilt only if the plan changed.
  bool follow(Work& work, const Seen& seen) override {
    std::string defines = defines_of_light_buffer(seen, lanes);
    if (defines != defines_) {
      defines_ = std::move(defines);
      kernel_ = {};
    }
    work.cl_lights();
    return true;
  }

  // Built at first use.
  NamedKernel& kernel(Work& work) {
    if (!kernel_)
      kernel_ = NamedKernel(*work.renderer.kernels,
                            lanes ? "resolve/cpu/light_buffer" : "resolve/gpu/light_buffer", defines_);
    return kernel_;
  }

  const bool lanes;

 private:
  std::string defines_;
  NamedKernel kernel_;
};

namespace {

void sums_to_gl(Work& work, const Seen& seen, const PrepassImage& image, SharedBuffer& from, GLuint to) {
  work.renderer.pixel_copies.to_texture(from.gl_buffer(), image.pixel, image.type, seen.grid(), to);
}

}  // namespace

NormalsInCl normals_to_cl(Work& work, const Seen& seen, const NormalImage& normals) {
  const PrepassImage& image = normals.layout->image;
  const size_t bytes = seen.grid().values() * image.bytes;
  const NormalsInCl in_cl = normals_in_cl_of(work, seen, TargetUse::image);
  auto pass = work.timer.pass("normals_to_cl", "gl");
  work.renderer.pixel_copies.to_buffer({normals.framebuffer, GL_COLOR_ATTACHMENT0, normals.texture},
                                       image.pixel, image.type, seen.grid(), in_cl.image->gl_buffer());
  in_cl.image->hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return in_cl;
}

LightBufferInCl fill_light_buffer(Work& work, const Seen& seen, Cached<LightSums>& cache,
                                  const NormalsInCl& normals, const DepthBuffer& depth,
                                  const LightSource& lights, TargetUse use) {
  LightSums& s = cache.of(work, seen);
  NamedKernel& kernel = s.kernel(work);
  LightBufferInCl buffer{&light_buffer_layout(seen.plan.settings), nullptr, nullptr};
  buffer.first = &work.shared_pixels("light buffer", buffer.layout->first.bytes, use);
  if (has_fifth_term(seen.plan.settings))
    buffer.second = &work.shared_pixels("light buffer 2", buffer.layout->second.bytes, use);
  const ClLights& table = work.cl_lights();
  auto pass = work.timer.pass("fill_light_buffer", "cl");
  constexpr size_t side = 16;  // pixels a side of a work-group's tile
  const auto whole = [](int pixels) { return (size_t(pixels) + side - 1) / side * side; };
  const cl::NDRange items = s.lanes ? cl::NDRange(seen.params.tiles_x, seen.params.tiles_y)
                                    : cl::NDRange(whole(seen.view.width), whole(seen.view.height));
  kernel.launch(
      *work.renderer.cl, "fill_light_buffer", items, s.lanes ? cl::NDRange(1, 1) : cl::NDRange(side, side),
      ClArguments{{"normals", normals.image->cl_buffer()}, {"depth", depth.values}} + table.columns() +
          ClArguments{{"cells", lights.in_cl->cells},
                      {"indices", lights.in_cl->indices},
                      {"light_bins", lights.in_cl->z_bins},
                      {"bin_edges", table.bin_edges.buffer()},
                      {"first", buffer.first->cl_buffer()},
                      {"second", buffer.second ? buffer.second->cl_buffer() : cl::Buffer()},
                      {"exponent", cl_float(seen.plan.settings.prepass_shininess)},
                      {"inverse_scale", cl_float(1 / stored_scale(seen))},
                      {"view", table.view.buffer()}});
  pass.moves(seen.grid().values() * (4 + normals.layout->image.bytes) + lights.bytes,
             seen.grid().values() * buffer.bytes());
  return buffer;
}

LightBuffer light_buffer_to_gl(Work& work, const Seen& seen, const LightBufferInCl& buffer) {
  const LightBuffer in_gl = light_buffer_of(work, seen);
  const size_t bytes = seen.grid().values() * buffer.bytes();
  auto pass = work.timer.pass("light_buffer_to_gl", "gl");
  std::vector<SharedBuffer::Written> written = {
      {buffer.first, seen.grid().values() * buffer.layout->first.bytes}};
  if (buffer.second) written.push_back({buffer.second, seen.grid().values() * buffer.layout->second.bytes});
  SharedBuffer::hand_to_gl(written);
  sums_to_gl(work, seen, buffer.layout->first, *buffer.first, in_gl.first);
  if (buffer.second) sums_to_gl(work, seen, buffer.layout->second, *buffer.second, in_gl.second);
  pass.moves(bytes, bytes);
  return in_gl;
}

}  // namespace lightgrid
