#include "c_api/handles.h"
#include "c_api/images.h"
#include "compare/contestants.h"
#include "frames/frame_culler.h"
#include "plan/settings/grid.h"
#include "plan/settings/surfaces.h"

struct lightgrid_lists {
  lightgrid::lab::FrameGrid grid;
};

namespace lightgrid::app::c {
using namespace lab;
namespace {

View view_of(const lightgrid_projection& in) {
  parse_size(fmt::format("{}x{}", in.width, in.height));
  View view;
  view.width = in.width;
  view.height = in.height;
  view.clip_from_view = matrix_of(in.clip_from_view, "projection.clip_from_view");
  view.view_from_world = matrix_of(in.view_from_world, "projection.view_from_world");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(in.eye[i]))
      throw wrong(fmt::format("projection.eye[{}]", i), "{} is not finite", in.eye[i]);
    view.eye[i] = in.eye[i];
  }
  view.orthographic = view.clip_from_view[3][3] != 0;
  return view;
}

CapturedFrame frame_of(const lightgrid_projection& projection, const lightgrid_image* depth,
                       const lightgrid_light* lights, size_t count) {
  CapturedFrame frame;
  frame.name = "projection";
  frame.view = view_of(projection);
  check_view(cull_view(frame.view), frame.tile);
  frame.view.near_m = near_distance(cull_view(frame.view));
  frame.lights = lights_of(lights, count);
  frame.depth.resize(frame.view.grid().values());
  if (depth)
    read_pixels(checked(depth, "depth", LIGHTGRID_R_F32, frame.view.width, frame.view.height),
                frame.depth.data());
  return frame;
}

template <typename T>
const T* data_or_null(const std::vector<T>& values) {
  return values.empty() ? nullptr : values.data();
}

DeviceScene::Raster& raster_of(OpenDevice& device, DeviceScene& held) {
  const LoadedScene& scene = *held.scene;
  std::shared_ptr<RasterScene> geometry = held.gpu->in_raster(TexelLayout::packed);
  if (!held.raster) {
    RasterView view(*geometry, *device.renderer().kernels);
    held.raster.reset(new DeviceScene::Raster{std::move(geometry), std::move(view)});
  }
  DeviceScene::Raster& raster = *held.raster;
  if (raster.shape == scene.shape() && raster.time == scene.time()) return raster;
  std::vector<RasterInstance> instances;
  for (const Instance& instance : scene.scene.instances) {
    const int number = scene.scene.meshes[size_t(instance.mesh)].material;
    const Material& material = scene.scene.materials[size_t(number)];
    instances.push_back({instance.mesh, instance.world_from_object, material.double_sided,
                         material.alpha_mode == AlphaMode::mask ? number : -1,
                         material.alpha_mode != AlphaMode::blend});
  }
  raster.view.set_instances(instances);
  raster.shape = scene.shape();
  raster.time = scene.time();
  return raster;
}

}  // namespace
}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

lightgrid_status lightgrid_cull(lightgrid_device* device, const lightgrid_projection* projection,
                                const lightgrid_image* depth, const lightgrid_light* lights, size_t count,
                                const char* technique, const char* const* settings, lightgrid_lists** lists) {
  return call([&] {
    lightgrid_lists*& out = needed(lists, "lists");
    OpenDevice& on = *needed(device, "device").device;
    std::string name = technique ? technique : "forward_plus";
    std::vector<std::string> set = words_of(settings);
    take_own_settings(name, set);
    const CapturedFrame frame = frame_of(needed(projection, "projection"), depth, lights, count);
    const Settings chosen = frame_settings(frame, set);
    const TechniqueNeeds needs = grid_needs(name, chosen);
    check_given_settings(chosen, {{&find_technique(name), chosen}}, {.grid = true});
    if (!depth && chosen[setting::depth_bounds] != DepthBoundsMode::none)
      throw wrong("depth", "is null, which needs the setting depth-bounds=none");
    const Turn turn(on);
    FrameCuller culler(*on.renderer().cl, *on.renderer().kernels, frame, chosen, needs);
    culler.run();
    out = new lightgrid_lists{culler.grid()};
  });
}

void lightgrid_lists_free(lightgrid_lists* lists) { delete lists; }

lightgrid_status lightgrid_lists_get(const lightgrid_lists* lists, lightgrid_grid* grid) {
  return call([&] {
    const FrameGrid& from = needed(lists, "lists").grid;
    const HostGrid& g = from.lists;
    lightgrid_grid& out = needed(grid, "grid");
    static_assert(sizeof(glm::uvec2) == 2 * sizeof(uint32_t));
    out = {g.cells_x, g.cells_y, g.slices, from.tile};
    out.cells = reinterpret_cast<const uint32_t*>(data_or_null(g.cells));
    out.cell_count = g.cells.size();
    out.indices = data_or_null(g.indices);
    out.index_count = g.indices.size();
    out.masks = data_or_null(g.masks);
    out.mask_words = g.cells.empty() ? 0 : g.masks.size() / g.cells.size();
    out.z_bins = data_or_null(g.z_bins);
    out.z_bin_count = g.z_bins.size();
    out.slice_edges = data_or_null(from.slice_edges);
  });
}

lightgrid_status lightgrid_rasterize(lightgrid_device* device, lightgrid_scene* scene,
                                     const lightgrid_projection* projection, const lightgrid_image* triangles,
                                     const lightgrid_image* depth) {
  return call([&] {
    OpenDevice& on = *needed(device, "device").device;
    const std::shared_ptr<LoadedScene> of = needed(scene, "scene").loaded;
    const View view = view_of(needed(projection, "projection"));
    if (triangles) checked(triangles, "triangles", LIGHTGRID_R_U32, view.width, view.height);
    if (depth) checked(depth, "depth", LIGHTGRID_R_F32, view.width, view.height);
    const Turn turn(on);
    on.last_rasterized = on.follow(of);
    RasterView& raster = raster_of(on, *on.last_rasterized).view;
    raster.set_camera({view.grid(), view.clip_from_view, view.view_from_world, view.eye});
    const Visibility seen = raster.draw();
    const size_t bytes = view.grid().values() * 4;
    if (triangles)
      write_pixels(*triangles, MappedBuffer(*on.renderer().cl, "triangles", seen.triangle, bytes).data());
    if (depth) write_pixels(*depth, MappedBuffer(*on.renderer().cl, "depth", seen.depth, bytes).data());
  });
}

}  // extern "C"
