#include "passes/shade_tiles.h"

#include "cl/launch.h"
#include "passes/resolve_samples.h"
#include "passes/sample_edges.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "raster/raster_samples.h"
#include "renderer/upload/lights.h"
#include "renderer/upload/scene_surfaces.h"

namespace lightgrid {
namespace {

// True if the image already contains base lighting before the light pass.
bool holds_base_lighting(const GBufferInCl& gbuffer) {
  return gbuffer.base_lighting == BaseLighting::in_image;
}

}  // namespace

// The kernels.
class TileShading : public PassCache {
 public:
  explicit TileShading(PassContext& work) : kernels(work, "resolve") {
    follow(work);
    if (work.plan.surfaces.skin || work.plan.surfaces.minnaert)
      models.put(*work.renderer.cl, "uploading models of materials", model_records(work.scene));
  }

  // Another camera at the same size, or moved lights.
  bool follow(PassContext& work) override {
    kernels.use(defines_of(work));
    work.cl_lights();
    return true;
  }

  size_t memory_bytes() const override { return models.bytes(); }

  PassKernels kernels;
  UploadedBuffer models;  // MaterialModelRecord each

 private:
  std::string defines_of(const ViewState& seen) const {
    const Settings& settings = seen.plan.settings;
    std::string defines = fmt::format("-DBUFFER_BITS={}", settings[setting::buffer_bits]) +
                          light_defines(seen, kernels.lanes, settings[setting::brdf]);
    defines += surface_number_define(seen.plan);
    if (seen.plan.surfaces.clearcoat) defines += " -DCLEARCOAT";
    if (seen.plan.surfaces.specular) defines += " -DSPECULAR";
    for (const char* define : model_defines(seen.plan)) defines += fmt::format(" -D{}", define);
    return defines;
  }
};

namespace {

void copy_attachment(PassContext& work, const GBuffer& gbuffer, int attachment, GLuint texture, GLenum type,
                     SharedBuffer& to) {
  work.renderer.pixel_copies.to_buffer(
      {gbuffer.framebuffer, GL_COLOR_ATTACHMENT0 + GLenum(attachment), texture}, GL_RGBA, type, work.grid(),
      to.gl_buffer());
}

// The image of one value a pixel.
PixelGrid pixels_of(const PassContext& work) { return {work.grid().width, work.grid().height}; }

GLuint image_texture(PassContext& work) {
  return work.grid().samples > 1 ? work.targets.resolved("resolved", GL_RGBA32F)
                                 : work.targets.texture("color", GL_RGBA32F);
}

GBufferInCl gbuffer_to_cl(PassContext& work, const GBuffer& gbuffer) {
  const size_t values = work.grid().values();
  const GBufferInCl in_cl = gbuffer_in_cl_of(work, gbuffer.base_lighting, TargetUse::image);
  const bool base_lighting = holds_base_lighting(in_cl);
  const ShadedImage base = base_lighting ? resolve_samples(work, gbuffer.image) : ShadedImage();
  auto pass = work.timer.pass("gbuffer_to_cl", "gl");
  std::vector<SharedBuffer::Written> copies;
  for (const size_t i : in_cl.images)
    copies.push_back({in_cl.surfaces[i], values * gbuffer.layout->images[i].bytes});
  if (base_lighting) copies.push_back({in_cl.image, work.grid().pixels() * 16});
  std::vector<SharedBuffer*> buffers;
  for (const SharedBuffer::Written& copy : copies) buffers.push_back(copy.buffer);
  SharedBuffer::take_for_gl(buffers);
  for (const size_t i : in_cl.images) {
    copy_attachment(work, gbuffer, gbuffer.attachment(i), gbuffer.textures[i], gbuffer.layout->images[i].type,
                    *in_cl.surfaces[i]);
  }
  if (base_lighting)
    work.renderer.pixel_copies.to_buffer({base.framebuffer, GL_COLOR_ATTACHMENT0, image_texture(work)},
                                         GL_RGBA, GL_FLOAT, pixels_of(work), in_cl.image->gl_buffer());
  SharedBuffer::hand_to_cl(copies);
  const size_t bytes = values * (gbuffer.bytes() - gbuffer.number_bytes + (base_lighting ? 16 : 0));
  pass.moves(bytes, bytes);
  return in_cl;
}

// Each sample gets the light of its pixel.
void image_to_gl(PassContext& work, SharedBuffer& image) {
  const size_t bytes = work.grid().pixels() * 16;
  auto pass = work.timer.pass("image_to_gl", "gl");
  image.hand_to_gl(bytes);
  work.renderer.pixel_copies.to_texture(image.gl_buffer(), GL_RGBA, GL_FLOAT, pixels_of(work),
                                        image_texture(work));
  pass.moves(bytes, work.grid().values() * 16);
  if (work.grid().samples == 1) return;
  const auto [width, height, samples] = work.grid();
  glBlitNamedFramebuffer(work.targets.framebuffer({image_texture(work)}, 0), work.color_framebuffer(), 0, 0,
                         width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void add_light(PassContext& work, Cached<TileShading>& cache, const GBufferInCl& gbuffer,
               const DepthBuffer& depth, const LightSource& lights, const cl::Buffer& edges) {
  TileShading& s = cache.of(work);
  const ClLights& table = work.cl_lights();
  auto pass = work.timer.pass("shade_tiles", "cl");
  const auto [items, group] = over_pixels(work, s.kernels.lanes, 16, 16);
  const bool base_lighting = holds_base_lighting(gbuffer);
  const glm::vec3 background =
      base_lighting ? glm::vec3(0) : work.scene.background;  // in the image already, or not
  s.kernels
      .of("shade_stored", lights.in_cl->defines + " -DSTORED_SURFACES" +
                              (base_lighting ? " -DBASE_LIGHTING" : "") +
                              sample_defines(work.sample_places()))
      .launch(
          *work.renderer.cl, "shade_tiles", items, group,
          ClArguments{{"first", gbuffer.surfaces[0]->cl_buffer()},
                      {"second", gbuffer.surfaces[1]->cl_buffer()},
                      {"coats", gbuffer.in_cl(gbuffer_coat)},
                      {"specular", gbuffer.in_cl(gbuffer_specular)},
                      {"models", s.models.buffer()},
                      {"image", gbuffer.image->cl_buffer()},
                      {"background", cl_float4{{background.r, background.g, background.b, 0}}},
                      {"depth", depth.values}} +
              surface_number_arguments(work.plan, gbuffer.surface_numbers) + work.light_arguments() +
              ClArguments{{"cells", lights.in_cl->cells},
                          {"indices", lights.in_cl->indices},
                          {"light_bins", lights.in_cl->z_bins}} +
              lights.in_cl->more +
              ClArguments{
                  {"bin_edges", table.bin_edges.buffer()}, {"edges", edges}, {"view", table.view.buffer()}});
  const size_t values = work.grid().values();
  const size_t surface_bytes = gbuffer.bytes() + 4 + (base_lighting ? 16 : 0);
  pass.moves(values * surface_bytes + lights.bytes, work.grid().pixels() * 16);
}

}  // namespace

ShadedImage shade_tiles(PassContext& work, PassCaches& caches, const GBuffer& gbuffer,
                        const DepthBuffer& depth, const LightSource& lights, Frame& frame) {
  const GBufferInCl in_cl = gbuffer.in_cl ? *gbuffer.in_cl : gbuffer_to_cl(work, gbuffer);
  StoredSurfaces surfaces{
      .bytes = in_cl.layout->images[0].bytes, .surface_numbers = in_cl.surface_numbers, .edges = in_cl.edges};
  for (const size_t i : in_cl.images) surfaces.images.push_back(in_cl.surfaces[i]);
  const cl::Buffer edges = sample_edges(work, caches.sample_edges, surfaces, depth, in_cl.bytes() + 4, frame);
  add_light(work, caches.tile_shading, in_cl, depth, lights, edges);
  if (gbuffer.in_cl || !work.plan.surfaces.blend) return {gbuffer.image.framebuffer, in_cl.image};
  image_to_gl(work, *in_cl.image);
  return gbuffer.image;
}

}  // namespace lightgrid
