#include "raster/raster_view.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "cl/buffers.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "raster/raster_arrays.h"
#include "raster/raster_pipeline.h"
#include "shared/surface_records.h"

namespace lightgrid {
namespace {

constexpr const char* uploading = "rasterizer: scene";
constexpr uint32_t first_entries_a_tile = 64;
constexpr size_t sample_group = 64;
constexpr uint64_t most_numbers = 0xffffffffu;  // of records or entries

bool mirrors(const glm::dmat4& m) { return glm::determinant(glm::dmat3(m)) < 0; }

// What must stay the same for triangle numbers to stay.
bool same_layout(const RasterInstance& a, const RasterInstance& b) {
  return a.mesh == b.mesh && a.two_sided == b.two_sided && a.alpha_material == b.alpha_material &&
         (a.world_from_object == b.world_from_object ||
          mirrors(a.world_from_object) == mirrors(b.world_from_object));
}

}  // namespace

struct RasterView::State {
  State(const RasterScene::State& scene, ProgramCache& programs, const RasterOptions& options)
      : scene(scene), device(scene.device), programs(programs), options(options) {
    const bool cpu =
        options.shape == KernelShape::automatic ? device.info().cpu : options.shape == KernelShape::lanes;
    // Only the CPU form's lists are in an order.
    pipeline = cpu || options.drawing_order
                   ? make_raster_cpu_pipeline(device, programs, options.portable)
                   : make_raster_gpu_pipeline(device, programs, options.wide_atomics);
    counters = device_buffer(device, RASTER_COUNTERS * sizeof(cl_uint));
  }

  void check_masks() const;
  void upload_instances();
  void enqueue();
  // Draws one sample of each pixel, again where room was short.
  void draw_sample(const std::function<void()>& meanwhile, uint32_t (&counted)[RASTER_COUNTERS]);
  // Puts that sample's image beside those of the others.
  void keep_sample(int sample);
  void read_counters(uint32_t (&counted)[RASTER_COUNTERS]);
  // Whether it was short, after which there is more.
  bool grow_room(const uint32_t (&counted)[RASTER_COUNTERS]);

  const RasterScene::State& scene;
  ClDevice& device;
  ProgramCache& programs;
  const RasterOptions options;
  std::unique_ptr<RasterPipeline> pipeline;
  int version = 0;  // of the scene, when the instances were set
  std::vector<RasterInstance> instances;
  int last_alpha_material = -1;
  std::optional<RasterCamera> camera;
  RasterParams params{};
  uint32_t vertex_runs = 0, pairs = 0;
  RasterCounts counts;
  RasterBuffers shown;

  GrowingBuffer clip;
  GrowingBuffer image_triangles, image_depths;    // of a sample
  GrowingBuffer sample_triangles, sample_depths;  // of all, where there are several
  cl::Kernel sample_kernel;                       // built at first use
  UploadedBuffer records, triangle_instance, runs, pair_list, frame, params_upload;
  cl::Buffer counters;
  bool masked = false;  // an instance that is drawn needs masks
  bool image = true;    // what the last run was for
};

RasterView::RasterView(const RasterScene& scene, ProgramCache& programs, const RasterOptions& options)
    : state_(std::make_unique<State>(*scene.state_, programs, options)) {}
RasterView::~RasterView() = default;
RasterView::RasterView(RasterView&&) noexcept = default;

void RasterView::set_instances(std::span<const RasterInstance> instances) {
  State& s = *state_;
  check_raster_instances(instances, s.scene.places, s.options.drawing_order);
  const bool same = s.version == s.scene.version && !instances.empty() &&
                    instances.size() == s.instances.size() &&
                    std::equal(instances.begin(), instances.end(), s.instances.begin(), same_layout);
  if (same) {
    s.instances.assign(instances.begin(), instances.end());
    return;
  }
  const RasterInstances made = raster_instances(instances, s.scene.places);
  s.version = s.scene.version;
  s.instances.assign(instances.begin(), instances.end());
  s.last_alpha_material = -1;
  for (const RasterInstance& i : instances)
    s.last_alpha_material = std::max(s.last_alpha_material, i.alpha_material);
  s.vertex_runs = uint32_t(made.vertex_runs.size()), s.pairs = uint32_t(made.pairs.size());
  s.records.put(s.device, uploading, made.records);
  s.triangle_instance.put(s.device, uploading, made.triangle_instance);
  s.runs.put(s.device, uploading, made.vertex_runs);
  s.pair_list.put(s.device, uploading, made.pairs);
  s.clip.at_least(s.device, made.clip_vertices * sizeof(cl_float4));
  s.shown.indices = s.scene.indices.get(), s.shown.instances = s.records.buffer(),
  s.shown.triangle_instance = s.triangle_instance.buffer(), s.shown.clip = s.clip.get();
}

void RasterView::set_drawn(size_t instance, bool drawn) {
  std::vector<RasterInstance>& instances = state_->instances;
  if (instance >= instances.size())
    throw input_error("rasterizer: instance {} of {}", instance, instances.size());
  instances[instance].drawn = drawn;
}

void RasterView::set_camera(const RasterCamera& camera) {
  check_raster_camera(camera);
  state_->camera = camera;
}

// Kernels read vertices and materials by number.
void RasterView::State::check_masks() const {
  const RasterMasks& masks = scene.masks;
  if (!masks.alphas() || last_alpha_material < 0) return;
  const RasterMeshPlace& last = scene.places.back();
  const size_t vertices = size_t(last.first_vertex) + last.vertices,
               given_vertices = bytes_of(masks.vertices) / sizeof(SurfaceVertex),
               given_materials = bytes_of(masks.materials) / sizeof(SurfaceMaterial);
  if (given_vertices < vertices)
    throw input_error("rasterizer: masks have {} vertices, fewer than the meshes' {}", given_vertices,
                      vertices);
  if (given_materials <= size_t(last_alpha_material))
    throw input_error("rasterizer: an instance's alpha_material is {}, and masks have {} materials",
                      last_alpha_material, given_materials);
}

void RasterView::State::upload_instances() {
  std::vector<RasterFrameInstance> values;
  values.reserve(instances.size());
  masked = false;
  for (const RasterInstance& i : instances) {
    masked |= i.drawn && i.alpha_material >= 0;
    values.push_back(i.drawn ? raster_frame_instance(*camera, i.world_from_object, i.two_sided)
                             : RasterFrameInstance{.eye_is_point = RASTER_NOT_DRAWN});
  }
  frame.put(device, uploading, values);
}

void RasterView::State::enqueue() {
  params_upload.put(device, "rasterizer: params", std::vector<RasterParams>{params});
  pipeline->prepare(params);
  pipeline->enqueue({params, params_upload.buffer(), scene.positions.get(), scene.indices.get(),
                     scene.cluster_indices.get(), scene.cluster_triangles.get(), scene.clusters.get(),
                     records.buffer(), runs.buffer(), pair_list.buffer(), frame.buffer(), clip.get(),
                     image ? image_triangles.get() : cl::Buffer(), image ? image_depths.get() : cl::Buffer(),
                     counters, masked ? scene.masks : RasterMasks()});
}

void RasterView::State::read_counters(uint32_t (&counted)[RASTER_COUNTERS]) {
  read_buffer(device, "rasterizer: counters", counters, counted, sizeof counted);
}

bool RasterView::State::grow_room(const uint32_t (&counted)[RASTER_COUNTERS]) {
  const uint64_t entries = counted[RASTER_ENTRIES] | uint64_t(counted[RASTER_ENTRIES + 1]) << 32,
                 blocks = counted[RASTER_BLOCKS];
  const size_t largest = device.info().max_allocation_bytes;
  // A quarter more than was asked for, since views move.
  const auto grow = [&](uint64_t wanted, size_t bytes_each, uint64_t most, const char* what, uint32_t& room) {
    most = std::min<uint64_t>(most, largest / bytes_each);
    if (wanted > most)
      throw machine_error("rasterizer: {} {} need more memory than {} allows", wanted, what,
                          device.info().name);
    room = uint32_t(std::min(most, wanted + wanted / 4));
  };
  if (blocks > params.record_blocks) {
    grow(blocks, RASTER_BLOCK * sizeof(RasterRecord), most_numbers / RASTER_BLOCK,
         "blocks of 256 triangles in view", params.record_blocks);
    return true;
  }
  if (entries > params.entry_capacity) {
    grow(entries, sizeof(cl_uint2), most_numbers, "pairs of a triangle and a tile or window",
         params.entry_capacity);
    return true;
  }
  return false;
}

void RasterView::State::draw_sample(const std::function<void()>& meanwhile,
                                    uint32_t (&counted)[RASTER_COUNTERS]) {
  enqueue();
  if (meanwhile) meanwhile();
  for (read_counters(counted); grow_room(counted); read_counters(counted)) {
    ++counts.redone;
    enqueue();
  }
}

void RasterView::State::keep_sample(int sample) {
  const size_t pixels = camera->grid.pixels(), values = camera->grid.values();
  sample_triangles.at_least(device, values * sizeof(cl_uint));
  sample_depths.at_least(device, (values + Visibility::spare_pixels) * sizeof(cl_float));
  if (!sample_kernel()) sample_kernel = programs.kernel("raster/raster_sample", "");
  launch(device, "raster_sample", sample_kernel,
         cl::NDRange((pixels + sample_group - 1) / sample_group * sample_group), cl::NDRange(sample_group),
         image_triangles.get(), image_depths.get(), cl_uint(pixels), cl_uint(sample),
         cl_uint(camera->grid.samples), sample_triangles.get(), sample_depths.get());
}

Visibility RasterView::draw(const std::function<void()>& meanwhile) {
  run(true, meanwhile);
  State& s = *state_;
  const PixelGrid& grid = s.camera->grid;
  const bool one = grid.samples == 1;
  return {(one ? s.image_triangles : s.sample_triangles).get(),
          (one ? s.image_depths : s.sample_depths).get(), grid};
}

RasterLists RasterView::list() {
  if (!state_->options.drawing_order)
    throw input_error("rasterizer: list needs a view with RasterOptions::drawing_order");
  run(false, {});
  return state_->pipeline->lists(state_->params);
}

void RasterView::run(bool image, const std::function<void()>& meanwhile) {
  State& s = *state_;
  if (!s.camera) throw input_error("rasterizer: set_camera has to come before draw");
  if (!s.instances.empty() && s.version != s.scene.version)
    throw input_error("rasterizer: set_instances has to come again after the scene's set_meshes");
  s.check_masks();
  const PixelGrid& grid = s.camera->grid;
  const uint32_t blocks = s.params.record_blocks, entries = s.params.entry_capacity;
  s.params = raster_params(*s.camera);
  s.params.pairs = s.pairs, s.params.vertex_runs = s.vertex_runs;
  s.params.cones = s.options.cluster_cones;
  s.params.drawing_order = s.options.drawing_order;
  s.params.chunks = s.pipeline->chunks(s.params);
  // What the last frame had, or a guess.
  s.params.record_blocks = std::max(blocks, s.params.chunks);
  s.params.entry_capacity = std::max(entries, s.params.tiles_x * s.params.tiles_y * first_entries_a_tile);
  s.image = image;
  if (image) {
    const size_t pixels = grid.pixels();
    s.image_triangles.at_least(s.device, pixels * sizeof(cl_uint));
    s.image_depths.at_least(s.device, (pixels + Visibility::spare_pixels) * sizeof(cl_float));
  }
  s.upload_instances();

  s.counts = {};
  uint32_t counted[RASTER_COUNTERS];
  const bool several = image && grid.samples > 1;
  for (int sample = 0; sample < (several ? grid.samples : 1); ++sample) {
    if (several) {
      s.params.sample_x = raster_samples_of_4[sample].x;
      s.params.sample_y = raster_samples_of_4[sample].y;
    }
    s.draw_sample(sample == 0 ? meanwhile : std::function<void()>(), counted);
    if (several) s.keep_sample(sample);
  }
  for (const RasterInstance& i : s.instances) {
    if (i.drawn) s.counts.triangles += s.scene.places[i.mesh].triangles;
  }
  s.counts.clusters = counted[RASTER_VISIBLE], s.counts.records = counted[RASTER_RECORDS];
  s.counts.tile_entries = counted[RASTER_ENTRIES];
  s.counts.invalid_triangles = counted[RASTER_INVALID];
}

const RasterBuffers& RasterView::buffers() const { return state_->shown; }
const RasterCounts& RasterView::counts() const { return state_->counts; }

size_t RasterView::memory_bytes() const {
  const State& s = *state_;
  size_t bytes = s.pipeline->memory_bytes() + RASTER_COUNTERS * sizeof(cl_uint);
  for (const GrowingBuffer* b :
       {&s.clip, &s.image_triangles, &s.image_depths, &s.sample_triangles, &s.sample_depths}) {
    bytes += b->bytes();
  }
  for (const UploadedBuffer* b :
       {&s.records, &s.triangle_instance, &s.runs, &s.pair_list, &s.frame, &s.params_upload})
    bytes += b->bytes();
  return bytes;
}

}  // namespace lightgrid
