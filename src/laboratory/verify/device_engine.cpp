#include <algorithm>
#include <map>
#include <tuple>

#include "cl/transfer.h"
#include "culling/cull_pipeline.h"
#include "culling/light_culler.h"
#include "plan/settings/grid.h"
#include "run/frames.h"
#include "scene/light_groups.h"
#include "verify/engine.h"

namespace lightgrid::lab::verify {
namespace {

// The device's name, with its number if another device has the same name.
std::string name_of_device(const std::string& substring) {
  const std::vector<ClDeviceInfo> devices = list_cl_devices();
  const size_t chosen = choose_cl_device(devices, substring);
  const auto name = [&](size_t i) { return devices[i].platform + " " + devices[i].name; };
  for (size_t i = 0; i < devices.size(); ++i) {
    if (i != chosen && name(i) == name(chosen)) return name(chosen) + " #" + std::to_string(chosen);
  }
  return name(chosen);
}

// A frame's shadows, and its surfaces if OpenCL's rasteriser drew them.
ShadowImage shadow_image(RenderView& v, const Frame& frame) {
  ShadowImage image{.lights = v.plan.lights.local};
  if (frame.shadows) image.shadows = frame.shadows();
  if (!frame.triangles) return image;
  image.depths = read_depth(v, frame);
  for (const MeshTriangle& triangle : read_mesh_triangles(v, frame))
    image.triangles.push_back({triangle.instance, triangle.number});
  return image;
}

class DeviceSequence : public FrameSequence {
 public:
  DeviceSequence(Renderer& renderer, const Scene& scene, const Technique& technique, const View& view,
                 const Settings& settings)
      : gpu_(renderer, scene), run_(renderer, gpu_, view, settings, technique) {}

  SequenceFrame draw(const View& view, const SceneChanges& changes) override {
    if (!changes.empty()) gpu_.update(changes);
    run_.look(view, changes);
    run_.run_frame();
    return {.shadows = shadow_image(run_.view(), run_.frame()), .pixels = run_.image().pixels};
  }

 private:
  GpuScene gpu_;
  TechniqueRun run_;
};

class DeviceEngine : public CullEngine {
 public:
  DeviceEngine(const std::string& substring, ProgramCache::Alter alter, bool both_shapes)
      : substring_(substring),
        alter_(std::move(alter)),
        both_shapes_(both_shapes),
        device_(substring),
        programs_(device_),
        storage_(device_),
        name_(name_of_device(substring)) {}

  std::string name() const override { return name_; }
  bool is_the_library() const override { return true; }
  bool has_both_shapes() const override { return both_shapes_; }

  HostGrid cull(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                std::span<const DepthInterval> bounds) override {
    LightCuller& culler = culler_of(options, view);
    culler.set_lights(lights);
    return grid_of(culler, culler.bounds_of(bounds));
  }

  std::vector<DepthInterval> depth_bounds(const CullerOptions& options, const CullView& view,
                                          const DepthImage& depth, bool blend) override {
    LightCuller& culler = culler_of(options, view, depth.samples);
    return culler.read_bounds(bounds_from(culler, depth, blend));
  }

  HostGrid cull_depth(const CullerOptions& options, const CullView& view, std::span<const CullLight> lights,
                      const DepthImage& depth, bool blend) override {
    LightCuller& culler = culler_of(options, view, depth.samples);
    culler.set_lights(lights);
    return grid_of(culler, bounds_from(culler, depth, blend));
  }

  std::optional<KernelRun> kernel_run(const CullerOptions& options, const CullView& view,
                                      std::span<const CullLight> lights, const DepthImage& depth,
                                      bool blend) override {
    LightCuller& culler = culler_of(options, view, depth.samples);
    culler.set_lights(lights);
    const TileBounds bounds = bounds_from(culler, depth, blend);
    HostGrid grid = grid_of(culler, bounds);
    return KernelRun{culler.read_inputs(bounds), std::move(grid)};
  }

  std::optional<RasterImage> rasterize(const RasterOptions& options, const RasterInput& input) override {
    auto& [scene, raster] = raster_of(options);
    std::vector<RasterMesh> meshes;
    for (const RasterInputMesh& mesh : input.meshes) meshes.push_back({mesh.positions, mesh.indices});
    scene.set_meshes(meshes);
    raster.set_instances(input.instances);
    raster.set_camera(input.camera);
    const Visibility visibility = raster.draw();
    RasterImage image;
    image.triangles.resize(visibility.grid.values());
    image.depths.resize(image.triangles.size());
    read_buffer(device_, "triangles", visibility.triangle, image.triangles.data(),
                image.triangles.size() * sizeof(uint32_t));
    read_buffer(device_, "depths", visibility.depth, image.depths.data(),
                image.depths.size() * sizeof(float));
    std::vector<RasterInstanceRecord> records(input.instances.size());
    read_buffer(device_, "instances", raster.buffers().instances, records.data(),
                records.size() * sizeof records[0]);
    for (const RasterInstanceRecord& record : records) {
      std::vector<glm::vec4>& clip = image.clip.emplace_back(record.vertex_count);
      read_buffer(device_, "positions in clip space", raster.buffers().clip, clip.data(),
                  clip.size() * sizeof clip[0], record.first_clip_vertex * sizeof clip[0]);
    }
    image.invalid_triangles = raster.counts().invalid_triangles;
    return image;
  }

  std::vector<ShadowImage> shadows(const Scene& scene, std::span<const View> views,
                                   const Settings& settings) override {
    if (!renderer_) {
      renderer_ = std::make_unique<Renderer>(substring_, GlBackend::none);
      renderer_->kernels->alter(alter_);
    }
    GpuScene gpu(*renderer_, scene);
    RenderView v(*renderer_, gpu, views.front(), settings, {.surfaces = {.opengl = false}});
    std::vector<ShadowImage> images;
    for (const View& view : views) {
      if (!images.empty()) v.look(view);
      images.push_back(shadow_image(v, draw_shadows(v)));
    }
    return images;
  }

  std::shared_ptr<TechniqueRun> run_of(const Scene& scene, const std::string& name, const View& view,
                                       const Settings& settings) override {
    const Technique& technique = find_technique(name);
    Renderer* renderer = renderer_for(technique, settings);
    if (!renderer) return nullptr;
    return std::make_shared<TechniqueRun>(*renderer, scene, view, settings, technique);
  }

  std::unique_ptr<FrameSequence> sequence(const Scene& scene, const std::string& name, const View& view,
                                          const Settings& settings) override {
    const Technique& technique = find_technique(name);
    Renderer* renderer = renderer_for(technique, settings);
    if (!renderer) return nullptr;
    return std::make_unique<DeviceSequence>(*renderer, scene, technique, view, settings);
  }

  std::vector<ListImage> lists(const Scene& scene, const std::string& name, std::span<const View> views,
                               const Settings& settings) override {
    const Technique& technique = find_technique(name);
    Renderer* renderer = renderer_for(technique, settings);
    if (!renderer) return {};
    TechniqueRun run(*renderer, scene, views.front(), settings, technique);
    std::vector<ListImage> images;
    for (const View& view : views) {
      if (!images.empty()) run.look(view);
      run.draw_frame();
      ListImage& image = images.emplace_back();
      image.depths = read_depth(run);
      image.lists = run.frame().listed(image.depths);
      if (run.frame().depth && run.view().grid().samples > 1) image.of_samples = draw_depth(run.view());
    }
    return images;
  }

  std::vector<GroupImage> group_images(const Scene& scene, const std::string& name,
                                       std::span<const View> views, const Settings& settings) override {
    const Technique& technique = find_technique(name);
    Renderer* renderer = renderer_for(technique, settings);
    if (!renderer) return {};
    TechniqueRun run(*renderer, scene, views.front(), settings, technique);
    const FramePlan& plan = run.view().plan;
    std::vector<GroupImage> images;
    for (const View& view : views) {
      if (!images.empty()) run.look(view);
      run.run_frame();
      GroupImage& image = images.emplace_back();
      image.lights = plan.lights.local;
      image.tile = plan.settings[setting::tile];
      image.pixels = run.image().pixels;
      image.depths = read_depth(run);
      image.lists = run.frame().listed ? run.frame().listed(image.depths)
                                       : list_every_light(uint32_t(image.lights.size()));
      if (image.lists.cell_of_pixel.empty()) image.lists.cell_of_pixel.resize(image.depths.size());
      for (const SceneTriangle& triangle : shown_triangles(run))
        image.groups.push_back(triangle.instance < 0 ? 0
                                                     : groups_of(scene.instances[size_t(triangle.instance)]));
    }
    return images;
  }

 private:
  // With OpenGL, where the machine has it; null where it has not and the technique draws with it.
  Renderer* renderer_for(const Technique& technique, const Settings& settings) {
    if (!with_opengl_) {
      with_opengl_ = std::make_unique<Renderer>(substring_, GlBackend::automatic);
      with_opengl_->kernels->alter(alter_);
    }
    if (!with_opengl_->gl && draws_with_opengl(technique.needs, settings)) return nullptr;
    if (with_opengl_->gl) with_opengl_->gl->make_current();
    return with_opengl_.get();
  }

  HostGrid grid_of(LightCuller& culler, const TileBounds& bounds) {
    return read_grid(device_, culler.cull(bounds, storage_), storage_);
  }

  using Key = std::tuple<CullTest, DepthBoundsMode, KernelShape, int, DepthFormat, int, bool, int, bool, bool,
                         int, GridLists>;
  static constexpr size_t max_cullers = 64;  // each has its own buffers

  LightCuller& culler_of(CullerOptions o, const CullView& view, int samples = 1) {
    o.samples = samples;
    const Key key(o.cull_test, o.depth_bounds, o.shape, o.tile, o.depth_format, o.samples, o.blend,
                  o.index_bits, o.portable, o.pixel_centres, o.group_size, o.lists);
    if (cullers_.size() >= max_cullers && !cullers_.contains(key)) cullers_.clear();
    auto& culler = cullers_[key];
    if (!culler) culler = std::make_unique<LightCuller>(device_, programs_, o);
    culler->set_view(view);
    return *culler;
  }

  struct Raster {
    RasterScene scene;
    RasterView view;
  };
  Raster& raster_of(const RasterOptions& o) {
    auto& made = rasters_[{o.shape, o.portable, o.cluster_cones, o.wide_atomics}];
    if (!made) {
      RasterScene scene(device_);
      RasterView view(scene, programs_, o);
      made = std::make_unique<Raster>(std::move(scene), std::move(view));
    }
    return *made;
  }

  TileBounds bounds_from(LightCuller& culler, const DepthImage& depth, bool blend) {
    DepthInput input{.row_pixels = depth.row_pixels, .x = depth.x, .y = depth.y};
    const size_t bytes = depth.values.size() * sizeof(float);
    input.values = device_buffer(device_, bytes);
    write_buffer(device_, "depth", input.values, depth.values.data(), bytes);
    const DepthBounds bounds = culler.depth_bounds(input);
    return blend ? bounds.blend : bounds.opaque;
  }

  const std::string substring_;
  const ProgramCache::Alter alter_;
  const bool both_shapes_;
  std::unique_ptr<Renderer> renderer_;     // for shadows: made at first use
  std::unique_ptr<Renderer> with_opengl_;  // for light indices and groups: likewise
  ClDevice device_;
  ProgramCache programs_;
  ClGridStorage storage_;
  std::string name_;
  std::map<Key, std::unique_ptr<LightCuller>> cullers_;
  std::map<std::tuple<KernelShape, bool, bool, bool>, std::unique_ptr<Raster>> rasters_;
};

}  // namespace

std::unique_ptr<CullEngine> device_engine(const std::string& substring, ProgramCache::Alter alter,
                                          bool both_shapes) {
  return std::make_unique<DeviceEngine>(substring, std::move(alter), both_shapes);
}

}  // namespace lightgrid::lab::verify
