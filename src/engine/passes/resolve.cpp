// From triangle numbers to radiance: the resolve pass, and blended surfaces by the same kernels' code.
#include "passes/resolve.h"

#include <fmt/format.h>

#include "cl/launch.h"
#include "passes/common/prepass_settings.h"
#include "passes/resolve_samples.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"
#include "plan/settings/surfaces.h"
#include "raster/raster_samples.h"
#include "renderer/upload/lights.h"

namespace lightgrid {
namespace {

constexpr size_t group_width = 8, group_height = 16;  // pixels; the 32 items that run together are then 8 x 4

constexpr size_t cached_texture_bytes = 16 << 20;  // about what a CPU's caches keep from frame to frame

// A light source's lists, in the order of RESOLVE_ARGUMENTS.
ClArguments source_arguments(const ClLightLoop& loop) {
  return ClArguments{{"cells", loop.cells}, {"light_indices", loop.indices}, {"light_bins", loop.z_bins}} +
         loop.more;
}

}  // namespace

// The image and the kernels.
class Resolver : public PassCache {
 public:
  explicit Resolver(PassContext& work) : image(work.shared_pixels("image", 16)), kernels_(work, "resolve") {
    upload(work);
  }

  bool follow(PassContext&) override {
    uploaded_ = false;
    return true;
  }

  void upload(PassContext& work) override {
    if (uploaded_) return;
    kernels_.use(resolve_defines(work));
    work.cl_lights();
    uploaded_ = true;
  }

  size_t memory_bytes() const override { return scene_bytes_; }

  // NVIDIA's compiler gives these kernels 80 registers and more. Then too few groups run side by side to hide
  // the memory's latency.
  NamedKernel& kernel(PassContext& work, const char* stem, const std::string& more_defines = "") {
    const bool limit = work.renderer.cl->info().platform == "NVIDIA CUDA";
    return kernels_.of(stem, more_defines + (limit ? " -cl-nv-maxrregcount=64" : ""));
  }

  const ClScene& scene(PassContext& work) {
    const ClScene& scene = work.gpu.in_cl(work.plan.settings[setting::texels]);
    scene_bytes_ = scene.memory_bytes();
    return scene;
  }

  // RESOLVE_ARGUMENTS of kernels/resolve/resolve_light.h.
  ClArguments arguments(PassContext& work, const RasterBuffers& raster, const cl::Buffer& surfaces,
                        const ClLightLoop& loop = {}) {
    const ClScene& s = scene(work);
    const ClLights& lights = work.cl_lights();
    return ClArguments{{"triangle_instance", raster.triangle_instance},
                       {"instances", raster.instances},
                       {"indices", raster.indices},
                       {"clip", raster.clip},
                       {"surfaces", surfaces},
                       {"vertices", s.vertices()},
                       {"materials", s.materials()},
                       {"texels_4", s.texels_4()},
                       {"texels_8", s.texels_8()}} +
           work.light_arguments() + ClArguments{{"directional", lights.directional.buffer()}} +
           work.effects.base_arguments() + source_arguments(loop) +
           ClArguments{{"bin_edges", lights.bin_edges.buffer()},
                       {"slice_edges", lights.slice_edges.buffer()},
                       {"view", lights.view.buffer()}};
  }

  bool lanes() const { return kernels_.lanes; }
  PixelRange pixels(const ViewState& seen) const {
    return over_pixels(seen, lanes(), group_width, group_height);
  }
  void launch(PassContext& work, NamedKernel& kernel, const char* label, const ClArguments& arguments) const {
    const auto [items, group] = pixels(work);
    kernel.launch(*work.renderer.cl, label, items, group, arguments);
  }

  SharedBuffer& image;  // one of the view's targets

 private:
  // Material code by what the scene has, not the view: a camera that turns compiles nothing.
  std::string resolve_defines(PassContext& work) {
    std::string defines = light_defines(work, lanes(), work.plan.settings[setting::brdf]);
    if (work.plan.lights.any_directional) defines += " -DDIRECTIONAL";
    for (const Effect* effect : work.plan.effects) {
      if (!effect->reach && !effect->lit) defines += " -D" + define_of(*effect);
    }
    if (work.plan.lists.light_grid && work.plan.lists.slices > 1) defines += " -DSLICES";
    const uint32_t of_scene =
        work.plan.settings[setting::everything_on] ? feature_all : scene(work).features();
    if (work.plan.settings[setting::texels] == TexelLayout::packed_8) defines += " -DSMALL_TEXELS";
    const uint32_t features = features_read(of_scene, work.plan.settings[setting::brdf]);
    const bool large =
        scene(work).texture_bytes() > cached_texture_bytes || work.plan.settings[setting::everything_on];
    if (lanes() && large && features & feature_textured) defines += " -DFETCH_AHEAD";
    for (const auto& [bit, define] : {std::pair<uint32_t, const char*>(feature_textured, " -DTEXTURED"),
                                      {feature_uv1, " -DUV1"},
                                      {feature_vertex_color, " -DVERTEX_COLOR"},
                                      {feature_normal_map | feature_clearcoat_normal_map, " -DNORMAL_MAP"},
                                      {feature_clearcoat, " -DCLEARCOAT"},
                                      {feature_specular, " -DSPECULAR"},
                                      {feature_skin, " -DSKIN"},
                                      {feature_minnaert, " -DMINNAERT"}}) {
      if (features & bit) defines += define;
    }
    return defines;
  }

  PassKernels kernels_;
  size_t scene_bytes_ = 0;
  bool uploaded_ = false;  // for this view
};

namespace {

// The options of kernels that write the surfaces' numbers.
std::string surface_numbers_out(const FramePlan& plan) {
  return has_surface_numbers(plan) ? " -DSURFACE_NUMBERS" + surface_number_define(plan) : "";
}

ClArguments surface_numbers_out(SharedBuffer* numbers) {
  return numbers ? ClArguments{{"surface_numbers", numbers->cl_buffer()}} : ClArguments();
}

Resolver& resolving(PassContext& work, Cached<Resolver>& cache) {
  Resolver& r = cache.of(work);
  r.upload(work);
  return r;
}

std::string specular_define(const Settings& settings) {
  const char* define = prepass_define(settings);
  return define ? fmt::format(" -D{}", define) : "";
}

cl_float4 background(const ViewState& seen) {
  const glm::vec3& background = seen.scene.background;
  return {{background.r, background.g, background.b, 1}};
}

}  // namespace

// An output of the kernels (kernels/resolve/output.h), and what it reads and writes besides the scene.
struct ResolveOutput {
  const char* label;      // label of the pass
  std::string defines;    // its OUTPUT_…, and what it takes
  ClArguments arguments;  // OUTPUT_LIST
  cl::Buffer image;       // that shows light; null: none
  size_t bytes_read = 0, bytes_written = 0;
  const LightSource* lights = nullptr;  // null: it reads no lists
};

static ClArguments common_arguments(PassContext& work, Resolver& r, const VisibilityBuffer& visible,
                                    const ResolveOutput& output) {
  return ClArguments{{"background", background(work)}, {"image", output.image}} + output.arguments +
         r.arguments(work, visible.raster, visible.surfaces,
                     output.lights ? *output.lights->in_cl : ClLightLoop());
}

static void over_image(PassContext& work, Resolver& r, const VisibilityBuffer& visible,
                       const ResolveOutput& output) {
  NamedKernel& kernel = r.kernel(work, "resolve", output.defines);
  auto pass = work.timer.pass(output.label, "cl");
  r.launch(work, kernel, output.label,
           ClArguments{{"triangles", visible.triangles().numbers}, {"depths", visible.pixel_depth().values}} +
               common_arguments(work, r, visible, output));
  pass.moves(output.bytes_read + (output.lights ? output.lights->bytes : 0) + r.scene(work).memory_bytes(),
             output.bytes_written);
}

// Pixels whose samples see several surfaces; others keep what over_image() wrote. traced: arguments that come
// first.
static void over_edges(PassContext& work, Resolver& r, const VisibilityBuffer& visible,
                       const ResolveOutput& output, const std::string& more_defines = "",
                       const ClArguments& traced = {}) {
  if (!visible.pixels) return;
  const std::string label = std::string(output.label) + "_edges";
  NamedKernel& kernel = r.kernel(work, "resolve_edges", output.defines + more_defines);
  auto pass = work.timer.pass(label.c_str(), "cl");
  r.launch(work, kernel, label.c_str(),
           traced +
               ClArguments{{"triangles", visible.image.triangle},
                           {"depths", visible.image.depth},
                           {"edges", visible.pixels->edges}} +
               common_arguments(work, r, visible, output));
  pass.moves(
      work.grid().pixels() / 8 + (output.lights ? output.lights->bytes : 0) + r.scene(work).memory_bytes(),
      0);
}

static std::string averages(const Settings& settings) {
  const char* define = average_define(settings);
  return define ? fmt::format(" -D{}", define) : "";
}

ShadedImage resolve(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                    const LightSource& lights) {
  Resolver& r = resolving(work, cache);
  const ResolveOutput output{"resolve",
                             lights.in_cl->defines + " -DOUTPUT_RADIANCE",
                             {},
                             r.image.cl_buffer(),
                             work.grid().pixels() * 8,
                             work.grid().pixels() * 16,
                             &lights};
  over_image(work, r, visible, output);
  const ClArguments& traced = work.shadows.traced;
  over_edges(work, r, visible, output,
             sample_defines(work.grid().samples) + averages(work.plan.settings) +
                 (traced.empty() ? "" : work.shadows.traced_defines),
             traced);
  return {0, &r.image};
}

// The images that the kernels write.
static ClArguments images_out(const GBufferInCl& g) {
  return ClArguments{{"first", g.surfaces[0]->cl_buffer()},
                     {"second", g.surfaces[1]->cl_buffer()},
                     {"coats", g.in_cl(gbuffer_coat)},
                     {"specular", g.in_cl(gbuffer_specular)}} +
         surface_numbers_out(g.surface_numbers);
}

GBufferInCl resolve_gbuffer(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                            BaseLighting base_lighting) {
  Resolver& r = resolving(work, cache);
  GBufferInCl g = gbuffer_in_cl_of(work, base_lighting, TargetUse::gbuffer);
  const bool shows = base_lighting == BaseLighting::in_image;
  const size_t pixels = work.grid().pixels(), image_bytes = shows ? 16 : 0;
  const ResolveOutput output{"resolve_gbuffer",
                             fmt::format(" -DOUTPUT_GBUFFER -DBUFFER_BITS={}{}{}", g.layout->bits,
                                         surface_numbers_out(work.plan), sample_defines(work.grid().samples)),
                             images_out(g),
                             shows ? g.image->cl_buffer() : cl::Buffer(),
                             pixels * (image_bytes > 0 ? 8 : 4),
                             work.grid().values() * g.bytes() + pixels * image_bytes};
  over_image(work, r, visible, output);
  over_edges(work, r, visible, output);
  if (visible.pixels) g.edges = visible.pixels->edges;
  return g;
}

NormalsInCl resolve_normals(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible) {
  Resolver& r = resolving(work, cache);
  NormalsInCl normals = normals_in_cl_of(work, TargetUse::gbuffer);
  const char* define = normals.layout->define;
  const ResolveOutput output{
      "resolve_normals",
      " -DOUTPUT_NORMALS" + (define ? fmt::format(" -D{}", define) : "") +
          (stores_roughness(work.plan.settings) ? " -DPREPASS_STORED" : "") + surface_numbers_out(work.plan) +
          sample_defines(work.grid().samples),
      ClArguments{{"normals", normals.image->cl_buffer()}} + surface_numbers_out(normals.surface_numbers),
      cl::Buffer(),
      work.grid().pixels() * 4,
      work.grid().values() * normals.layout->image.bytes};
  over_image(work, r, visible, output);
  over_edges(work, r, visible, output);
  if (visible.pixels) normals.edges = visible.pixels->edges;
  return normals;
}

ShadedImage resolve_materials(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                              const LightBufferInCl& sums) {
  Resolver& r = resolving(work, cache);
  const Settings& s = work.plan.settings;
  const bool apart = visible.pixels && s[setting::samples_shading] == SamplesShading::all;
  const ResolveOutput output{
      "resolve_materials",
      fmt::format(" -DOUTPUT_SUMS -DBUFFER_BITS={}{}{}{}{}", s[setting::buffer_bits], specular_define(s),
                  stores_luv(s) ? " -DLIGHT_LUV" : "", sample_defines(work.grid().samples),
                  apart ? " -DSAMPLES_APART" : ""),
      {{"first", sums.first->cl_buffer()},
       {"second", sums.second ? sums.second->cl_buffer() : cl::Buffer()},
       {"scale", cl_float(stored_scale(work))},
       {"exponent", cl_float(s[setting::prepass_shininess])},
       {"reference", cl_float(reference_light(work.scene, work.plan))}},
      r.image.cl_buffer(),
      work.grid().pixels() * 8 + work.grid().values() * sums.bytes(),
      work.grid().pixels() * 16};
  over_image(work, r, visible, output);
  over_edges(work, r, visible, output, averages(s));
  return {0, &r.image};
}

ReflectedLight resolve_reflected(PassContext& work, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                                 uint32_t light) {
  Resolver& r = resolving(work, cache);
  const ReflectedLight reflected{&work.shared_pixels("reflected flux", 16),
                                 &work.shared_pixels("reflecting places", 16)};
  over_image(work, r, visible,
             {"resolve_reflected",
              " -DOUTPUT_REFLECTED",
              {{"light", cl_uint(light)},
               {"flux", reflected.flux->cl_buffer()},
               {"places", reflected.places->cl_buffer()}},
              cl::Buffer(),
              work.grid().pixels() * 8,
              work.grid().pixels() * 32});
  return reflected;
}

void blend_resolved(PassContext& work, Cached<Resolver>& cache, const BlendedTriangles& blended,
                    const DepthBuffer& depth, const LightSource& lights) {
  Resolver& r = resolving(work, cache);
  NamedKernel& kernel = r.kernel(work, "blend", lights.in_cl->defines + sample_defines(work.grid().samples));
  const PixelRange pixels = r.pixels(work);
  auto pass = work.timer.pass("blend_resolved", "cl");
  kernel.launch(
      *work.renderer.cl, "blend_resolved",
      r.lanes() ? cl::NDRange(blended.lists.tiles_x * blended.lists.tiles_y) : pixels.items,
      r.lanes() ? cl::NDRange(1) : pixels.group,
      ClArguments{{"records", blended.lists.records},
                  {"tile_begin", blended.lists.tile_begin},
                  {"lists", blended.lists.lists},
                  {"tiles_x", cl_uint(blended.lists.tiles_x)},
                  {"depths", depth.values}} +
          (work.plan.shadows.light_reaches ? ClArguments{{"shadow_layers", cl_uint(work.shadows.layer_count)}}
                                           : ClArguments()) +
          r.arguments(work, blended.raster, blended.surfaces, *lights.in_cl) +
          ClArguments{{"image", r.image.cl_buffer()}});
  pass.moves(work.grid().values() * 20 + lights.bytes, work.grid().pixels() * 16);
}

}  // namespace lightgrid
