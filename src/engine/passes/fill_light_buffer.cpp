#include "passes/fill_light_buffer.h"

#include <fmt/format.h>

#include "base/error.h"
#include "cl/launch.h"
#include "passes/common/prepass_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "raster/raster_samples.h"
#include "renderer/upload/lights.h"

namespace lightgrid {
namespace {

std::string defines_of_light_buffer(const ViewState& seen, bool lanes) {
  const Settings& s = seen.plan.settings;
  // The same kernel for both BRDFs with a specular lobe.
  std::string defines =
      light_defines(seen, lanes, s[setting::brdf] == Brdf::lambert ? Brdf::lambert : Brdf::ggx);
  defines += fmt::format(" -DBUFFER_BITS={}", s[setting::buffer_bits]);
  if (normal_layout(s).define) defines += fmt::format(" -D{}", normal_layout(s).define);
  if (has_fifth_term(s)) defines += " -DPREPASS_FIFTH_TERM";
  if (stores_roughness(s)) defines += " -DPREPASS_STORED";
  if (stores_luv(s)) defines += " -DLIGHT_LUV";
  defines += surface_number_define(seen.plan);
  return defines;
}

}  // namespace

// The kernel.
class LightBufferSums : public PassCache {
 public:
  explicit LightBufferSums(PassContext& work) : kernels(work, "resolve") { follow(work); }

  bool follow(PassContext& work) override {
    kernels.use(defines_of_light_buffer(work, kernels.lanes));
    work.cl_lights();
    return true;
  }

  PassKernels kernels;
};

namespace {

void sums_to_gl(PassContext& work, const PrepassImage& image, SharedBuffer& from, GLuint to) {
  const auto [width, height, samples] = work.grid();
  work.renderer.pixel_copies.to_texture(from.gl_buffer(), image.pixel, image.type, {width * samples, height},
                                        to);
}

}  // namespace

NormalsInCl normals_to_cl(PassContext& work, const NormalImage& normals) {
  const PrepassImage& image = normals.layout->image;
  const size_t bytes = work.grid().values() * image.bytes;
  const NormalsInCl in_cl = normals_in_cl_of(work, TargetUse::image);
  auto pass = work.timer.pass("normals_to_cl", "gl");
  work.renderer.pixel_copies.to_buffer({normals.framebuffer, GL_COLOR_ATTACHMENT0, normals.texture},
                                       image.pixel, image.type, work.grid(), in_cl.image->gl_buffer());
  in_cl.image->hand_to_cl(bytes);
  pass.moves(bytes, bytes);
  return in_cl;
}

LightBufferInCl fill_light_buffer(PassContext& work, Cached<LightBufferSums>& cache,
                                  const NormalsInCl& normals, const DepthBuffer& depth,
                                  const LightSource& lights, TargetUse use, const cl::Buffer& edges) {
  LightBufferSums& s = cache.of(work);
  NamedKernel& kernel =
      s.kernels.of("shade_stored", " -DSTORED_NORMALS" + sample_defines(work.sample_places()));
  LightBufferInCl buffer{&light_buffer_layout(work.plan.settings), nullptr, nullptr};
  buffer.first = &work.shared_samples("light buffer", buffer.layout->first.bytes, use);
  if (has_fifth_term(work.plan.settings))
    buffer.second = &work.shared_samples("light buffer 2", buffer.layout->second.bytes, use);
  const ClLights& table = work.cl_lights();
  auto pass = work.timer.pass("fill_light_buffer", "cl");
  const auto [items, group] = over_pixels(work, s.kernels.lanes, 16, 16);
  kernel.launch(*work.renderer.cl, "fill_light_buffer", items, group,
                ClArguments{{"normals", normals.image->cl_buffer()},
                            {"sums", buffer.first->cl_buffer()},
                            {"other_sums", buffer.second ? buffer.second->cl_buffer() : cl::Buffer()},
                            {"exponent", cl_float(work.plan.settings[setting::prepass_shininess])},
                            {"inverse_scale", cl_float(1 / stored_scale(work))},
                            {"depth", depth.values}} +
                    surface_number_arguments(work.plan, normals.surface_numbers) + work.light_arguments() +
                    ClArguments{{"cells", lights.in_cl->cells},
                                {"indices", lights.in_cl->indices},
                                {"light_bins", lights.in_cl->z_bins},
                                {"bin_edges", table.bin_edges.buffer()},
                                {"edges", edges},
                                {"view", table.view.buffer()}});
  pass.moves(work.grid().values() * (4 + normals.layout->image.bytes) + lights.bytes,
             work.grid().values() * buffer.bytes());
  return buffer;
}

LightBuffer light_buffer_to_gl(PassContext& work, const LightBufferInCl& buffer) {
  const int row = work.grid().width * work.grid().samples;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (row > most)
    throw machine_error(
        "OpenGL's images have at most {} texels in a row, and light_prepass needs one for "
        "each sample, {}; choose fewer samples or prepass-lights=volumes",
        most, row);
  const LightBuffer in_gl = light_buffer_of(work, true);
  const size_t bytes = work.grid().values() * buffer.bytes();
  auto pass = work.timer.pass("light_buffer_to_gl", "gl");
  std::vector<SharedBuffer::Written> written = {
      {buffer.first, work.grid().values() * buffer.layout->first.bytes}};
  if (buffer.second) written.push_back({buffer.second, work.grid().values() * buffer.layout->second.bytes});
  SharedBuffer::hand_to_gl(written);
  sums_to_gl(work, buffer.layout->first, *buffer.first, in_gl.first);
  if (buffer.second) sums_to_gl(work, buffer.layout->second, *buffer.second, in_gl.second);
  pass.moves(bytes, bytes);
  return in_gl;
}

}  // namespace lightgrid
