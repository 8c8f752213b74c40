// From triangle numbers to radiance: the resolve pass, and blended surfaces by the same kernels' code.
#include "passes/resolve.h"

#include <fmt/format.h>

#include "cl/launch.h"
#include "renderer/cl_lights.h"

namespace lightgrid {
namespace {

constexpr size_t group_width = 8, group_height = 16;  // pixels; the 32 items that run together are then 8 x 4

constexpr size_t cached_texture_bytes = 16 << 20;  // about what a CPU's caches keep from frame to frame

cl::NDRange whole_groups(const View& view) {
  const auto whole = [](int pixels, size_t group) { return (size_t(pixels) + group - 1) / group * group; };
  return {whole(view.width, group_width), whole(view.height, group_height)};
}

// The lists of a source of lights, as RESOLVE_ARGUMENTS has them.
ClArguments source_arguments(const ClLightLoop& loop) {
  return ClArguments{{"cells", loop.cells}, {"light_indices", loop.indices}, {"light_bins", loop.z_bins}} +
         loop.more;
}

}  // namespace

// The image and the kernels.
class Resolver : public PassCache {
 public:
  explicit Resolver(Work& work, const Seen& seen)
      : lanes(shades_in_lanes(work, seen)), image(work.shared_pixels("image", 16)) {
    upload(work, seen);
  }

  bool follow(Work&, const Seen&) override { return uploaded_ = false, true; }

  void upload(Work& work, const Seen& seen) override {
    if (uploaded_) return;
    std::string defines = resolve_defines(work, seen);
    if (defines != defines_) {
      defines_ = std::move(defines);
      kernels_.clear();
    }
    work.cl_lights();
    uploaded_ = true;
  }

  size_t memory_bytes() const override { return scene_bytes_; }

  // "resolve", "resolve_gbuffer", "resolve_normals", "resolve_materials" or "blend", built at first use.
  NamedKernel& kernel(Work& work, const char* stem, const std::string& more_defines = "") {
    NamedKernel& kernel = kernels_[stem + more_defines];
    if (!kernel) {
      kernel =
          NamedKernel(*work.renderer.kernels, (lanes ? "resolve/cpu/" : "resolve/gpu/") + std::string(stem),
                      defines_ + more_defines + register_limit(work));
    }
    return kernel;
  }

  // NVIDIA's compiler gives these kernels 80 registers and more. Then too few groups run side by side to hide
  // the memory's latency.
  static const char* register_limit(Work& work) {
    return work.renderer.cl->info().platform == "NVIDIA CUDA" ? " -cl-nv-maxrregcount=64" : "";
  }

  const ClScene& scene(Work& work, const Seen& seen) {
    const ClScene& scene = work.gpu.in_cl(seen.plan.settings.texels);
    scene_bytes_ = scene.memory_bytes();
    return scene;
  }

  // RESOLVE_ARGUMENTS of kernels/resolve/resolve_light.h.
  ClArguments arguments(Work& work, const Seen& seen, const RasterBuffers& raster, const cl::Buffer& surfaces,
                        const ClLightLoop& loop = {}) {
    const ClScene& s = scene(work, seen);
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
           lights.columns() + ClArguments{{"directional", lights.directional.buffer()}} +
           source_arguments(loop) +
           ClArguments{{"bin_edges", lights.bin_edges.buffer()},
                       {"slice_edges", lights.slice_edges.buffer()},
                       {"view", lights.view.buffer()}};
  }

  // Of kernels over all pixels: a work-item takes a tile, or a pixel.
  cl::NDRange items(const Seen& seen) const {
    return lanes ? cl::NDRange(seen.params.tiles_x, seen.params.tiles_y) : whole_groups(seen.view);
  }
  cl::NDRange group() const { return lanes ? cl::NDRange(1, 1) : cl::NDRange(group_width, group_height); }

  const bool lanes;
  SharedBuffer& image;  // of the view's targets

 private:
  // Material code by what the scene has, not the view: a camera that turns compiles nothing.
  std::string resolve_defines(Work& work, const Seen& seen) {
    std::string defines = light_defines(seen, lanes, seen.plan.settings.brdf);
    if (seen.plan.directional) defines += " -DDIRECTIONAL";
    if (seen.plan.light_grid && seen.plan.slices > 1) defines += " -DSLICES";
    const uint32_t of_scene = seen.plan.settings.everything_on ? feature_all : scene(work, seen).features();
    if (seen.plan.settings.texels == TexelLayout::packed_8) defines += " -DSMALL_TEXELS";
    const uint32_t features = features_read(of_scene, seen.plan.settings.brdf);
    const bool large =
        scene(work, seen).texture_bytes() > cached_texture_bytes || seen.plan.settings.everything_on;
    if (lanes && large && features & feature_textured) defines += " -DFETCH_AHEAD";
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

  std::string defines_;
  std::map<std::string, NamedKernel> kernels_;  // by stem and what more defines it has
  size_t scene_bytes_ = 0;
  bool uploaded_ = false;  // for this view
};

namespace {

Resolver& resolving(Work& work, const Seen& seen, Cached<Resolver>& cache) {
  Resolver& r = cache.of(work, seen);
  r.upload(work, seen);
  return r;
}

std::string specular_define(const Settings& settings) {
  const char* define = prepass_define(settings);
  return define ? fmt::format(" -D{}", define) : "";
}

ClArguments visible_arguments(const VisibilityBuffer& visible) {
  return {{"triangles", visible.image.triangle}, {"depths", visible.image.depth}};
}

cl_float4 background(const Seen& seen) {
  const glm::vec3& background = seen.scene.background;
  return {{background.r, background.g, background.b, 1}};
}

}  // namespace

ShadedImage resolve(Work& work, const Seen& seen, Cached<Resolver>& cache, const VisibilityBuffer& visible,
                    const LightSource& lights) {
  Resolver& r = resolving(work, seen, cache);
  NamedKernel& kernel = r.kernel(work, "resolve", lights.in_cl->defines);
  auto pass = work.timer.pass("resolve", "cl");
  kernel.launch(*work.renderer.cl, "resolve", r.items(seen), r.group(),
                visible_arguments(visible) +
                    r.arguments(work, seen, visible.raster, visible.surfaces, *lights.in_cl) +
                    ClArguments{{"background", background(seen)}, {"image", r.image.cl_buffer()}});
  pass.moves(seen.grid().values() * 8 + lights.bytes + r.scene(work, seen).memory_bytes(),
             seen.grid().pixels() * 16);
  return {0, &r.image};
}

GBufferInCl resolve_gbuffer(Work& work, const Seen& seen, Cached<Resolver>& cache,
                            const VisibilityBuffer& visible, BaseLighting base_lighting) {
  Resolver& r = resolving(work, seen, cache);
  const GBufferInCl g = gbuffer_in_cl_of(work, seen, base_lighting, TargetUse::gbuffer);
  const bool image = base_lighting == BaseLighting::in_image;
  NamedKernel& kernel = r.kernel(work, "resolve_gbuffer", fmt::format(" -DBUFFER_BITS={}", g.layout->bits));
  auto pass = work.timer.pass("resolve_gbuffer", "cl");
  kernel.launch(*work.renderer.cl, "resolve_gbuffer", r.items(seen), r.group(),
                visible_arguments(visible) + r.arguments(work, seen, visible.raster, visible.surfaces) +
                    ClArguments{{"background", background(seen)},
                                {"first", g.surfaces[0]->cl_buffer()},
                                {"second", g.surfaces[1]->cl_buffer()},
                                {"coats", g.in_cl(gbuffer_coat)},
                                {"specular", g.in_cl(gbuffer_specular)},
                                {"image", image ? g.image->cl_buffer() : cl::Buffer()}});
  pass.moves(seen.grid().values() * (image ? 8 : 4) + r.scene(work, seen).memory_bytes(),
             seen.grid().values() * (g.bytes() + (image ? 16 : 0)));
  return g;
}

NormalsInCl resolve_normals(Work& work, const Seen& seen, Cached<Resolver>& cache,
                            const VisibilityBuffer& visible) {
  Resolver& r = resolving(work, seen, cache);
  const NormalsInCl normals = normals_in_cl_of(work, seen, TargetUse::gbuffer);
  const char* define = normals.layout->define;
  NamedKernel& kernel = r.kernel(work, "resolve_normals", define ? fmt::format(" -D{}", define) : "");
  auto pass = work.timer.pass("resolve_normals", "cl");
  kernel.launch(*work.renderer.cl, "resolve_normals", r.items(seen), r.group(),
                ClArguments{{"triangles", visible.image.triangle}} +
                    r.arguments(work, seen, visible.raster, visible.surfaces) +
                    ClArguments{{"normals", normals.image->cl_buffer()}});
  pass.moves(seen.grid().values() * 4 + r.scene(work, seen).memory_bytes(),
             seen.grid().values() * normals.layout->image.bytes);
  return normals;
}

ShadedImage resolve_materials(Work& work, const Seen& seen, Cached<Resolver>& cache,
                              const VisibilityBuffer& visible, const LightBufferInCl& sums) {
  Resolver& r = resolving(work, seen, cache);
  const Settings& s = seen.plan.settings;
  NamedKernel& kernel = r.kernel(work, "resolve_materials",
                                 fmt::format(" -DBUFFER_BITS={}{}", s.buffer_bits, specular_define(s)));
  auto pass = work.timer.pass("resolve_materials", "cl");
  kernel.launch(*work.renderer.cl, "resolve_materials", r.items(seen), r.group(),
                visible_arguments(visible) + r.arguments(work, seen, visible.raster, visible.surfaces) +
                    ClArguments{{"background", background(seen)},
                                {"first", sums.first->cl_buffer()},
                                {"second", sums.second ? sums.second->cl_buffer() : cl::Buffer()},
                                {"scale", cl_float(stored_scale(seen))},
                                {"exponent", cl_float(s.prepass_shininess)},
                                {"reference", cl_float(reference_light(seen.scene, seen.plan))},
                                {"image", r.image.cl_buffer()}});
  pass.moves(seen.grid().values() * (8 + sums.bytes()) + r.scene(work, seen).memory_bytes(),
             seen.grid().pixels() * 16);
  return {0, &r.image};
}

void blend_resolved(Work& work, const Seen& seen, Cached<Resolver>& cache, const BlendedTriangles& blended,
                    const DepthBuffer& depth, const LightSource& lights) {
  Resolver& r = resolving(work, seen, cache);
  NamedKernel& kernel = r.kernel(work, "blend", lights.in_cl->defines);
  auto pass = work.timer.pass("blend_resolved", "cl");
  kernel.launch(
      *work.renderer.cl, "blend_resolved",
      r.lanes ? cl::NDRange(blended.lists.tiles_x * blended.lists.tiles_y) : whole_groups(seen.view),
      r.lanes ? cl::NDRange(1) : cl::NDRange(group_width, group_height),
      ClArguments{{"records", blended.lists.records},
                  {"tile_begin", blended.lists.tile_begin},
                  {"lists", blended.lists.lists},
                  {"tiles_x", cl_uint(blended.lists.tiles_x)},
                  {"depths", depth.values}} +
          r.arguments(work, seen, blended.raster, blended.surfaces, *lights.in_cl) +
          ClArguments{{"image", r.image.cl_buffer()}});
  pass.moves(seen.grid().values() * 20 + lights.bytes, seen.grid().pixels() * 16);
}

}  // namespace lightgrid
