// From triangle numbers to radiance: the resolve pass, and blended surfaces by the same kernels' code.
#include "passes/resolve.h"

#include <fmt/format.h>

#include <tuple>

#include "cl/launch.h"
#include "passes/build_voxels.h"
#include "passes/build_world_grid.h"
#include "renderer/cl_lights.h"

namespace lightgrid {
namespace {

constexpr size_t group_width = 8, group_height = 16;  // pixels; the 32 items that run together are then 8 x 4

constexpr size_t cached_texture_bytes = 16 << 20;  // about what a CPU's caches keep from frame to frame

cl::NDRange whole_groups(const View& view) {
  const auto whole = [](int pixels, size_t group) { return (size_t(pixels) + group - 1) / group * group; };
  return {whole(view.width, group_width), whole(view.height, group_height)};
}

// The image, the lights and the kernels.
class Resolving : public PassState {
 public:
  explicit Resolving(RenderView& v)
      : lanes(shades_in_lanes(v)), image(v.shared_pixels("image", 16)) {
    upload(v);
  }

  bool follow(RenderView&) override { return uploaded_ = false, true; }

  void upload(RenderView& v) override {
    if (uploaded_) return;
    std::string defines = resolve_defines(v);
    if (defines != defines_) {
      defines_ = std::move(defines);
      kernels_.clear();
    }
    lights.upload(v);
    uploaded_ = true;
  }

  size_t memory_bytes() const override { return lights.memory_bytes() + scene_bytes_; }

  // "resolve", "resolve_gbuffer", "resolve_normals", "resolve_materials" or "blend", built at first use.
  cl::Kernel& kernel(RenderView& v, const char* stem, const std::string& more_defines = "") {
    cl::Kernel& kernel = kernels_[stem + more_defines];
    if (!kernel()) {
      kernel = v.renderer.kernels->kernel((lanes ? "resolve/cpu/" : "resolve/gpu/") + std::string(stem),
                                          defines_ + more_defines + register_limit(v));
    }
    return kernel;
  }

  // NVIDIA's compiler gives these kernels 80 registers and more. Then too few groups run side by side to hide
  // the memory's latency.
  static const char* register_limit(RenderView& v) {
    return v.renderer.cl->info().platform == "NVIDIA CUDA" ? " -cl-nv-maxrregcount=64" : "";
  }

  const ClScene& scene(RenderView& v) {
    const ClScene& scene = v.gpu.in_cl(v.plan.settings.texels);
    scene_bytes_ = scene.memory_bytes();
    return scene;
  }

  // RESOLVE_ARGUMENTS of kernels/resolve/resolve_light.h.
  auto arguments(RenderView& v, const RasterBuffers& raster, const cl::Buffer& surfaces, const GridInCl& in) {
    const ClScene& s = scene(v);
    cl::Buffer cells, indices, light_bins;
    if (in.world) cells = in.world->grid->cells(), indices = in.world->grid->indices();
    if (in.grid) {
      cells = in.storage->cells(in.grid->cell_bytes), indices = in.storage->indices(in.grid->index_bytes);
      if (in.grid->z_bin_bytes) light_bins = in.storage->z_bins(in.grid->z_bin_bytes);
    }
    return std::tuple(raster.triangle_instance, raster.instances, raster.indices, raster.clip, surfaces,
                      s.vertices(), s.materials(), s.texels_4(), s.texels_8(), lights.positions.buffer(),
                      lights.colors.buffer(), lights.cones.buffer(), lights.directional.buffer(), cells,
                      indices, light_bins, lights.bin_edges.buffer(), lights.slice_edges.buffer(),
                      lights.view.buffer());
  }

  // Of kernels over all pixels: a work-item takes a tile, or a pixel.
  cl::NDRange items(const RenderView& v) const {
    return lanes ? cl::NDRange(v.params.tiles_x, v.params.tiles_y) : whole_groups(v.view);
  }
  cl::NDRange group() const { return lanes ? cl::NDRange(1, 1) : cl::NDRange(group_width, group_height); }

  const bool lanes;
  SharedBuffer& image;  // of the view's targets
  ClLights lights;

 private:
  // Material code by what the scene has, not the view: a camera that turns compiles nothing.
  std::string resolve_defines(RenderView& v) {
    std::string defines = light_defines(v, lanes, v.plan.settings.brdf);
    if (v.plan.directional) defines += " -DDIRECTIONAL";
    if (v.plan.light_grid && v.plan.slices > 1) defines += " -DSLICES";
    const uint32_t of_scene = v.plan.settings.everything_on ? feature_all : scene(v).features();
    if (v.plan.settings.texels == TexelLayout::packed_8) defines += " -DSMALL_TEXELS";
    const uint32_t features = features_read(of_scene, v.plan.settings.brdf);
    const bool large = scene(v).texture_bytes() > cached_texture_bytes || v.plan.settings.everything_on;
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
  std::map<std::string, cl::Kernel> kernels_;  // by stem and what more defines it has
  size_t scene_bytes_ = 0;
  bool uploaded_ = false;  // for this view
};

Resolving& resolving(RenderView& v) {
  Resolving& r = v.state<Resolving>();
  r.upload(v);
  return r;
}

std::string specular_define(const Settings& settings) {
  const char* define = prepass_define(settings);
  return define ? fmt::format(" -D{}", define) : "";
}

cl_float4 background(const RenderView& v) {
  const glm::vec3& background = v.scene.background;
  return {{background.r, background.g, background.b, 1}};
}

// Calls `launch` with the arguments of a kernel that adds these lights.
template <typename Arguments, typename Launch>
void with_lights(const GridInCl& in, const Arguments& arguments, const Launch& launch) {
  if (in.voxels) {
    std::apply(launch,
               std::tuple_cat(arguments, std::tuple(in.voxels->irradiance->cl_buffer(),
                                                    in.voxels->directions->cl_buffer(), in.voxels->lookup)));
  } else if (in.world) {
    WorldGrid& grid = *in.world->grid;
    std::apply(launch, std::tuple_cat(arguments, std::tuple(grid.buckets(), grid.keys(), grid.params(),
                                                            in.world->view)));
  } else {
    std::apply(launch, arguments);
  }
}

std::string light_kernel_defines(const RenderView& v, const GridInCl& in) {
  if (in.world) return " -DWORLD_GRID";
  if (!in.voxels) return "";
  const std::string exact =
      in.grid ? fmt::format(" -DVOXEL_EXACT={}", v.plan.settings.voxel_lights_exact) : "";
  return " -DLIGHTS_VOXELS" + in.voxels->kernel_defines + exact;
}

size_t grid_bytes(const GridInCl& in) {
  if (in.world) return in.world->grid->list_bytes();
  return (in.voxels ? in.voxels->bytes : 0) +
         (in.grid ? in.grid->cell_bytes + in.grid->index_bytes + in.grid->z_bin_bytes : 0);
}

}  // namespace

ShadedImage resolve(RenderView& v, const VisibilityBuffer& visible, const GridInCl& lights) {
  Resolving& r = resolving(v);
  cl::Kernel& kernel = r.kernel(v, "resolve", light_kernel_defines(v, lights));
  auto pass = v.timer.pass("resolve", "cl");
  with_lights(lights, r.arguments(v, visible.raster, visible.surfaces, lights), [&](const auto&... shared) {
    launch(*v.renderer.cl, "resolve", kernel, r.items(v), r.group(), visible.image.triangle,
           visible.image.depth, shared..., background(v), r.image.cl_buffer());
  });
  pass.moves(v.pixels() * 8 + grid_bytes(lights) + r.scene(v).memory_bytes(), v.pixels() * 16);
  return {0, &r.image};
}

GBufferInCl resolve_gbuffer(RenderView& v, const VisibilityBuffer& visible, BaseLighting base_lighting) {
  Resolving& r = resolving(v);
  const GBufferInCl g = gbuffer_in_cl_of(v, base_lighting, TargetUse::gbuffer);
  const bool image = base_lighting == BaseLighting::in_image;
  cl::Kernel& kernel = r.kernel(v, "resolve_gbuffer", fmt::format(" -DBUFFER_BITS={}", g.layout->bits));
  auto pass = v.timer.pass("resolve_gbuffer", "cl");
  std::apply(
      [&](const auto&... shared) {
        launch(*v.renderer.cl, "resolve_gbuffer", kernel, r.items(v), r.group(), visible.image.triangle,
               visible.image.depth, shared..., background(v), g.surfaces[0]->cl_buffer(),
               g.surfaces[1]->cl_buffer(), g.in_cl(gbuffer_coat), g.in_cl(gbuffer_specular),
               image ? g.image->cl_buffer() : cl::Buffer());
      },
      r.arguments(v, visible.raster, visible.surfaces, {}));
  pass.moves(v.pixels() * (image ? 8 : 4) + r.scene(v).memory_bytes(),
             v.pixels() * (g.bytes() + (image ? 16 : 0)));
  return g;
}

NormalsInCl resolve_normals(RenderView& v, const VisibilityBuffer& visible) {
  Resolving& r = resolving(v);
  const NormalsInCl normals = normals_in_cl_of(v, TargetUse::gbuffer);
  const char* define = normals.layout->define;
  cl::Kernel& kernel = r.kernel(v, "resolve_normals", define ? fmt::format(" -D{}", define) : "");
  auto pass = v.timer.pass("resolve_normals", "cl");
  std::apply(
      [&](const auto&... shared) {
        launch(*v.renderer.cl, "resolve_normals", kernel, r.items(v), r.group(), visible.image.triangle,
               shared..., normals.image->cl_buffer());
      },
      r.arguments(v, visible.raster, visible.surfaces, {}));
  pass.moves(v.pixels() * 4 + r.scene(v).memory_bytes(), v.pixels() * normals.layout->image.bytes);
  return normals;
}

ShadedImage resolve_materials(RenderView& v, const VisibilityBuffer& visible, const LightBufferInCl& sums) {
  Resolving& r = resolving(v);
  const Settings& s = v.plan.settings;
  cl::Kernel& kernel =
      r.kernel(v, "resolve_materials", fmt::format(" -DBUFFER_BITS={}{}", s.buffer_bits, specular_define(s)));
  auto pass = v.timer.pass("resolve_materials", "cl");
  std::apply(
      [&](const auto&... shared) {
        launch(*v.renderer.cl, "resolve_materials", kernel, r.items(v), r.group(), visible.image.triangle,
               visible.image.depth, shared..., background(v), sums.first->cl_buffer(),
               sums.second ? sums.second->cl_buffer() : cl::Buffer(), cl_float(stored_scale(v)),
               cl_float(s.prepass_shininess), cl_float(reference_light(v.scene, v.plan)),
               r.image.cl_buffer());
      },
      r.arguments(v, visible.raster, visible.surfaces, {}));
  pass.moves(v.pixels() * (8 + sums.bytes()) + r.scene(v).memory_bytes(), v.pixels() * 16);
  return {0, &r.image};
}

void blend_resolved(RenderView& v, const BlendedTriangles& blended, const DepthBuffer& depth,
                    const GridInCl& lights) {
  Resolving& r = resolving(v);
  cl::Kernel& kernel = r.kernel(v, "blend", light_kernel_defines(v, lights));
  auto pass = v.timer.pass("blend_resolved", "cl");
  with_lights(lights, r.arguments(v, blended.raster, blended.surfaces, lights), [&](const auto&... shared) {
    launch(*v.renderer.cl, "blend_resolved", kernel,
           r.lanes ? cl::NDRange(blended.lists.tiles_x * blended.lists.tiles_y) : whole_groups(v.view),
           r.lanes ? cl::NDRange(1) : cl::NDRange(group_width, group_height), blended.lists.records,
           blended.lists.tile_begin, blended.lists.lists, cl_uint(blended.lists.tiles_x), depth.values,
           shared..., r.image.cl_buffer());
  });
  pass.moves(v.pixels() * 20 + grid_bytes(lights), v.pixels() * 16);
}

}  // namespace lightgrid
