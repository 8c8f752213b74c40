#include "raster/raster_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/facing.h"
#include "cl/buffers.h"
#include "cl/launch.h"
#include "cl/transfer.h"
#include "raster/raster_arrays.h"
#include "shared/surface_records.h"

namespace lightgrid {
namespace {

constexpr const char* uploading = "rasterizer: scene";
constexpr uint32_t first_entries_a_tile = 64;
constexpr uint64_t max_numbers = 0xffffffffu;  // numbers of records or entries

bool mirrors(const glm::dmat4& m) { return is_mirroring(glm::dmat3(m)); }

// Triangle numbers stay if these stay the same.
bool same_layout(const RasterInstance& a, const RasterInstance& b) {
  return a.mesh == b.mesh && a.two_sided == b.two_sided && a.alpha_material == b.alpha_material &&
         (a.world_from_object == b.world_from_object ||
          mirrors(a.world_from_object) == mirrors(b.world_from_object));
}

constexpr int max_pixels = 16384;
constexpr float guard_units =
    16368 * 256;  // from the view's centre: coordinates then differ by less than 2^23

bool is_perspective(const glm::dmat4& clip_from_view) { return clip_from_view[2][3] != 0; }

void require_finite(const glm::dmat4& m, const char* name) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) throw input_error("rasterizer: {} holds {}", name, m[column][row]);
    }
  }
}

// Throws Error(input) as RasterView::set_camera says.
void check_raster_camera(const RasterCamera& camera) {
  for (const int size : {camera.grid.width, camera.grid.height}) {
    if (size < 1 || size > max_pixels)
      throw input_error("rasterizer: a view of {} pixels; 1 to {} will do", size, max_pixels);
  }
  if (raster_samples(camera.grid.samples).empty())
    throw input_error("rasterizer: {} samples a pixel; 1, 2, 4 and 8 are possible", camera.grid.samples);
  require_finite(camera.clip_from_view, "clip_from_view");
  require_finite(camera.view_from_world, "view_from_world");
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(camera.eye[i])) throw input_error("rasterizer: the eye is at {}", camera.eye[i]);
  }
  const glm::dmat3 turn(camera.view_from_world);
  const glm::dmat3 unit = turn * glm::transpose(turn);
  double error = 0;
  for (int i = 0; i < 9; ++i)
    error = std::max(error, std::abs(unit[i / 3][i % 3] - (i / 3 == i % 3 ? 1 : 0)));
  if (error > 1e-6 || glm::determinant(turn) < 0)
    throw input_error("rasterizer: view_from_world is not rigid");

  const glm::dmat4& m = camera.clip_from_view;
  if (m[0][3] != 0 || m[1][3] != 0 || m[0][2] != 0 || m[1][2] != 0) {
    throw input_error("rasterizer: clip_from_view does not project along -z");
  }
  if (!(m[0][0] * m[1][1] - m[1][0] * m[0][1] > 0))
    throw input_error("rasterizer: clip_from_view mirrors or flattens the image");
  // depth = z / w: 1 at the near plane, falling with the distance d = -z.
  const bool perspective = is_perspective(m);
  const double w = perspective ? -m[2][3] : m[3][3];
  const bool reversed = perspective ? m[3][3] == 0 && m[3][2] > 0 && m[2][2] >= 0 : m[2][2] > 0;
  if (!(w > 0) || !reversed) {
    throw input_error(
        "rasterizer: clip_from_view is neither perspective nor orthographic, or its depth is not reversed");
  }
}

// All but what depends on the scene and on room.
RasterParams raster_params(const RasterCamera& camera) {
  RasterParams p{};
  p.half_x = float(128 * camera.grid.width);
  p.half_y = float(128 * camera.grid.height);
  p.guard_x = guard_units / p.half_x;
  p.guard_y = guard_units / p.half_y;
  p.width = uint32_t(camera.grid.width);
  p.height = uint32_t(camera.grid.height);
  p.tiles_x = (p.width + RASTER_TILE - 1) / RASTER_TILE;
  p.tiles_y = (p.height + RASTER_TILE - 1) / RASTER_TILE;
  return p;
}

RasterFrameInstance raster_frame_instance(const RasterCamera& camera, const glm::dmat4& world_from_object,
                                          bool two_sided) {
  // Relative to the eye before anything is rounded: see docs/conventions.md, "Camera-relative".
  glm::dmat4 eye_from_object = world_from_object;
  eye_from_object[3] -= glm::dvec4(camera.eye, 0);
  const glm::dmat3 turn(camera.view_from_world);
  const glm::dmat4 clip_from_object = camera.clip_from_view * (glm::dmat4(turn) * eye_from_object);
  RasterFrameInstance instance{};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      instance.clip_from_object[4 * row + column] = float(clip_from_object[column][row]);
  }
  const glm::dmat3 linear(world_from_object);
  const glm::dmat3 object_from_eye = glm::inverse(linear);
  const bool perspective = is_perspective(camera.clip_from_view);
  const glm::dvec3 forward = -glm::dvec3(turn[0][2], turn[1][2], turn[2][2]);
  const glm::vec3 eye(perspective ? -(object_from_eye * glm::dvec3(eye_from_object[3]))
                                  : glm::normalize(object_from_eye * forward));
  const bool usable =
      !is_singular(linear) && std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z);
  instance.eye_x = eye.x;
  instance.eye_y = eye.y;
  instance.eye_z = eye.z;
  instance.eye_is_point = two_sided || !usable ? RASTER_NONE : perspective ? 1 : 0;
  return instance;
}

}  // namespace

struct RasterView::State {
  State(const RasterScene::State& scene, ProgramCache& programs, const RasterOptions& options)
      : scene(scene), device(scene.device), programs(programs), options(options) {
    const bool cpu =
        options.shape == KernelShape::automatic ? device.info().cpu : options.shape == KernelShape::lanes;
    // Only the CPU form's lists are in an order.
    pipeline = cpu || options.drawing_order
                   ? make_raster_cpu_pipeline(device, programs, options.portable, options.masks)
                   : make_raster_gpu_pipeline(device, programs, options.wide_atomics, options.masks);
    counters = device_buffer(device, RASTER_COUNTERS * sizeof(cl_uint));
  }

  void check_masks() const;
  void upload_instances();
  void enqueue();
  void read_counters(uint32_t (&counted)[RASTER_COUNTERS]);
  // Returns whether room was short; then there is more.
  bool grow_room(const uint32_t (&counted)[RASTER_COUNTERS]);

  const RasterScene::State& scene;
  ClDevice& device;
  ProgramCache& programs;
  const RasterOptions options;
  std::unique_ptr<RasterPipeline> pipeline;
  int version = 0;  // version of the scene when the instances were set
  std::vector<RasterInstance> instances;
  int last_alpha_material = -1;
  std::optional<RasterCamera> camera;
  RasterParams params{};
  uint32_t vertex_runs = 0, pairs = 0;
  RasterCounts counts;
  RasterBuffers shown;

  GrowingBuffer clip;
  GrowingBuffer image_triangles, image_depths;
  UploadedBuffer records, triangle_instance, runs, pair_list, frame, params_upload;
  cl::Buffer counters;
  bool masked = false;  // an instance that is drawn needs masks
  bool image = true;    // true if the last run drew an image
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
  s.vertex_runs = uint32_t(made.vertex_runs.size());
  s.pairs = uint32_t(made.pairs.size());
  s.records.put(s.device, uploading, made.records);
  s.triangle_instance.put(s.device, uploading, made.triangle_instance);
  s.runs.put(s.device, uploading, made.vertex_runs);
  s.pair_list.put(s.device, uploading, made.pairs);
  s.clip.at_least(s.device, made.clip_vertices * sizeof(cl_float4));
  s.shown.indices = s.scene.indices.get();
  s.shown.instances = s.records.buffer();
  s.shown.triangle_instance = s.triangle_instance.buffer();
  s.shown.clip = s.clip.get();
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
  const int samples = image ? camera->grid.samples : 1;
  pipeline->prepare(params, samples);
  pipeline->enqueue({params, samples, params_upload.buffer(), scene.positions.get(), scene.indices.get(),
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
    grow(blocks, RASTER_BLOCK * sizeof(RasterRecord), max_numbers / RASTER_BLOCK,
         "blocks of 256 triangles in view", params.record_blocks);
    return true;
  }
  if (entries > params.entry_capacity) {
    grow(entries, sizeof(cl_uint2), max_numbers, "pairs of a triangle and a tile or window",
         params.entry_capacity);
    return true;
  }
  return false;
}

Visibility RasterView::draw(const std::function<void()>& meanwhile) {
  run(true, meanwhile);
  State& s = *state_;
  return {s.image_triangles.get(), s.image_depths.get(), s.camera->grid};
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
  s.params.pairs = s.pairs;
  s.params.vertex_runs = s.vertex_runs;
  s.params.cones = s.options.cluster_cones;
  s.params.drawing_order = s.options.drawing_order;
  s.params.chunks = s.pipeline->chunks(s.params);
  // Room starts as the last frame had it, or from a guess.
  s.params.record_blocks = std::max(blocks, s.params.chunks);
  s.params.entry_capacity = std::max(entries, s.params.tiles_x * s.params.tiles_y * first_entries_a_tile);
  s.image = image;
  if (image) {
    s.image_triangles.at_least(s.device, grid.values() * sizeof(cl_uint));
    s.image_depths.at_least(s.device, (grid.values() + Visibility::spare_pixels) * sizeof(cl_float));
  }
  s.upload_instances();

  s.counts = {};
  uint32_t counted[RASTER_COUNTERS];
  s.enqueue();
  if (meanwhile) meanwhile();
  for (s.read_counters(counted); s.grow_room(counted); s.read_counters(counted)) {
    ++s.counts.redone;
    s.enqueue();
  }
  for (const RasterInstance& i : s.instances) {
    if (i.drawn) s.counts.triangles += s.scene.places[i.mesh].triangles;
  }
  s.counts.clusters = counted[RASTER_VISIBLE];
  s.counts.records = counted[RASTER_RECORDS];
  s.counts.tile_entries = counted[RASTER_ENTRIES];
  s.counts.invalid_triangles = counted[RASTER_INVALID];
}

const RasterBuffers& RasterView::buffers() const { return state_->shown; }
const RasterCounts& RasterView::counts() const { return state_->counts; }

size_t RasterView::memory_bytes() const {
  const State& s = *state_;
  size_t bytes = s.pipeline->memory_bytes() + RASTER_COUNTERS * sizeof(cl_uint);
  for (const GrowingBuffer* b : {&s.clip, &s.image_triangles, &s.image_depths}) bytes += b->bytes();
  for (const UploadedBuffer* b :
       {&s.records, &s.triangle_instance, &s.runs, &s.pair_list, &s.frame, &s.params_upload})
    bytes += b->bytes();
  return bytes;
}

}  // namespace lightgrid
