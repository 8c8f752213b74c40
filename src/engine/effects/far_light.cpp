// Far light (docs/far_light.md). Its volume is filled when the scene's box or a light changed, and its place
// in the view follows the camera. Lights that an effect keeps from some surfaces send no far light: the
// volume's light reaches all surfaces.
#include "effects/far_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cl/transfer.h"
#include "plan/light_plan.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "renderer/loop_inputs.h"
#include "scene/light_readers.h"

namespace lightgrid {
namespace {

extern const Setting<int> far_samples;

// Far light gives back what ranges take away.
void mean_ranges_without_end(Settings& s) {
  if (s[far_samples] > 0) {
    s.set(setting::range, LightRange::infinite);
    s.reset(far_samples);
  }
}

const Setting<int> far_samples{
    70,
    "far-light",
    "number of samples in a coarse volume that adds the light beyond the lights' ranges",
    {{"off", 0}, {"512", 512}, {"4096", 4096}, {"32768", 32768}, {"262144", 262144}},
    {.model = true,
     .common = true,
     .shown = [](const Settings& s) { return s[far_samples] > 0; },
     .mean = mean_ranges_without_end}};

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan& plan) {
  if (plan.settings[far_samples] == 0) return {};
  const LightRanges ranges = ranges_of(plan.settings);
  if (ranges.range == LightRange::stochastic)
    return EffectNeed{false, "the mean of random ranges is that of none", false};
  const auto first = std::ranges::find_if(plan.lights.local, [&](int i) {
    return std::isfinite(range_of(scene.lights[size_t(i)], size_t(i), ranges));
  });
  if (first == plan.lights.local.end()) return EffectNeed{false, "no light ends"};
  return EffectNeed{true, light_witness(scene, *first) + " has a range"};
}

LOOP_INPUTS(FarLightInputs, FAR_LIGHT_BASE_INPUTS);

constexpr size_t far_group = 64;    // work-items of the group shape
constexpr double min_box_m = 1e-3;  // of a side

FarGrid grid_of(const WorldBox& box, const glm::dvec3& origin, int samples) {
  const glm::dvec3 size = glm::max(box.max - box.min, min_box_m);
  // Cells are cubes, as far as whole numbers of samples allow; along each axis there are at least two.
  double edge = std::cbrt(size.x * size.y * size.z / samples);
  glm::uvec3 count;
  do {
    count = glm::uvec3(glm::max(glm::ceil(size / edge), 1.0)) + 1u;
    edge *= 1.01;
  } while (size_t(count.x) * count.y * count.z > size_t(samples));
  const glm::vec3 first(box.min - origin), spacing(size / glm::dvec3(count - 1u));
  return {count.x, count.y, count.z, 0, first.x, first.y, first.z, spacing.x, spacing.y, spacing.z};
}

FarLookup lookup_of(const FarGrid& g, const glm::dvec3& origin, const View& view) {
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const glm::dvec3 spacing(g.spacing_x, g.spacing_y, g.spacing_z);
  const glm::dvec3 from_1 = (view.eye - origin - glm::dvec3(g.first_x, g.first_y, g.first_z)) / spacing;
  float rows[3][4], directions[3][3];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      directions[row][column] = float(world_from_view[column][row]);
      rows[row][column] = float(world_from_view[column][row] / spacing[row]);
    }
    rows[row][3] = float(from_1[row]);
  }
  FarLookup lookup;
  static_assert(sizeof lookup == sizeof rows + sizeof directions + 3 * sizeof(float));
  std::memcpy(&lookup, rows, sizeof rows);
  std::memcpy(&lookup.world_x_from_x, directions, sizeof directions);
  lookup.last_x = float(g.size_x - 1);
  lookup.last_y = float(g.size_y - 1);
  lookup.last_z = float(g.size_z - 1);
  return lookup;
}

// Lights relative to `origin`, along the world's axes. Those that do not reach every surface send nothing.
std::vector<ViewLight> lights_from(const glm::dvec3& origin, const ViewState& seen) {
  View along;
  along.view_from_world = glm::dmat4(1);
  along.eye = origin;
  std::vector<ViewLight> lights = lights_in_view(seen.scene, along, ranges_of(seen.plan.settings));
  for (ViewLight& light : lights) {
    light.radiant_intensity = light.share.of_surface ? glm::dvec3(0) : largest_intensity(light);
  }
  return lights;
}

bool sends_alike(const ViewLight& a, const ViewLight& b) {
  return a.type == b.type && a.position == b.position && a.direction == b.direction &&
         a.radiant_intensity == b.radiant_intensity && a.radius_m == b.radius_m &&
         a.cos_inner == b.cos_inner && a.cos_outer == b.cos_outer && a.window == b.window &&
         a.max_falloff == b.max_falloff;
}

// The volume, along the world's axes from its origin.
class FarLightVolume : public EffectState {
 public:
  explicit FarLightVolume(PassContext& work) : kernels_(work, "far_light") { follow(work); }

  bool follow(PassContext& work) override {
    const WorldBox box = world_box(work.scene);
    const glm::dvec3 at = box.empty() ? work.view.eye : 0.5 * (box.min + box.max);
    FarGrid placed = grid_of(box.empty() ? WorldBox{at, at} : box, at, work.plan.settings[far_samples]);
    placed.lights = uint(work.plan.lights.local.size());
    std::vector<ViewLight> found = lights_from(at, work);
    std::string defines;
    for (const char* define : light_table_defines(work.plan)) defines += fmt::format(" -D{}", define);
    if (kernels_.lanes && work.plan.settings[setting::portable]) defines += " -DPORTABLE";
    const bool rebuilt = kernels_.use(defines);
    const bool moved = at != origin_ || std::memcmp(&placed, &grid_, sizeof grid_) != 0 ||
                       !std::ranges::equal(found, lights_, sends_alike);
    if (rebuilt || moved) filled_ = false;
    origin_ = at;
    grid_ = placed;
    lights_ = std::move(found);
    placed_ = false;
    return true;
  }

  void before_lights(PassContext& work) override {
    if (!filled_) fill(work);
    if (!placed_)
      inputs_.far_lookup.put(*work.renderer.cl, work.plan.opengl, "placing far light",
                             lookup_of(grid_, origin_, work.view));
    placed_ = true;
    if (work.plan.opengl && !in_texture_) to_texture(work);
  }

  void bind() const override { inputs_.bind(); }
  ClArguments base_arguments() override { return inputs_.arguments(); }
  EffectFigures figures() const override { return {{"samples", double(samples())}}; }
  size_t memory_bytes() const override { return columns_.memory_bytes() + inputs_.bytes(); }

  ReadFarLight read(PassContext& work) {
    ReadFarLight read{grid_, origin_, std::vector<glm::vec4>(bytes() / sizeof(glm::vec4))};
    read_buffer(*work.renderer.cl, "reading far light", inputs_.far_moments.memory->cl_buffer(),
                read.moments.data(), bytes());
    return read;
  }

 private:
  size_t samples() const { return size_t(grid_.size_x) * grid_.size_y * grid_.size_z; }
  size_t bytes() const { return samples() * FAR_PLANES * sizeof(glm::vec4); }

  void fill(PassContext& work) {
    auto pass = work.timer.pass("fill_far_light", "cl");
    ClDevice& device = *work.renderer.cl;
    columns_.upload(device, work.plan, lights_);
    grid_buffer_.put(device, "placing far light", std::vector<FarGrid>{grid_});
    ArrayInput& moments = inputs_.far_moments;
    if (!moments.memory || moments.memory->size() != bytes()) {
      moments.memory.emplace(device, work.plan.opengl ? work.renderer.bridge : BridgeKind::none, bytes());
      moments.texture = {};
      moments.texture_bytes = 0;
    }
    const size_t a_item = kernels_.lanes ? 16 : 1, a_group = kernels_.lanes ? 1 : far_group;
    const size_t items = (samples() + a_item * a_group - 1) / (a_item * a_group) * a_group;
    kernels_.of("fill_far_light")
        .launch(device, "fill_far_light", cl::NDRange(items), cl::NDRange(a_group),
                columns_.columns() +
                    ClArguments{{"grid", grid_buffer_.buffer()}, {"moments", moments.memory->cl_buffer()}});
    pass.moves(columns_.memory_bytes(), bytes());
    filled_ = true;
    in_texture_ = false;
  }

  void to_texture(PassContext& work) {
    auto pass = work.timer.pass("far_light_to_gl", "gl");
    ArrayInput& moments = inputs_.far_moments;
    const PixelGrid slice{int(grid_.size_x), int(grid_.size_y)};
    const GLsizei depth = GLsizei(FAR_PLANES * grid_.size_z);
    if (!moments.texture) {
      moments.texture = make_texture_3d(GL_RGBA32F, slice.width, slice.height, depth);
      moments.texture_bytes = bytes();
    }
    moments.memory->hand_to_gl(bytes());
    work.renderer.pixel_copies.to_texture(moments.memory->gl_buffer(), GL_RGBA, GL_FLOAT, slice,
                                          moments.texture.name(), depth);
    pass.moves(bytes(), bytes());
    in_texture_ = true;
  }

  PassKernels kernels_;
  FarLightInputs inputs_;
  glm::dvec3 origin_{0};  // in the world
  FarGrid grid_{};
  std::vector<ViewLight> lights_;
  ClLightColumns columns_;
  UploadedBuffer grid_buffer_;
  bool filled_ = false, placed_ = false, in_texture_ = false;
};

std::unique_ptr<EffectState> make(PassContext& work) { return std::make_unique<FarLightVolume>(work); }

constexpr LightReader reader{
    .name = "far light",
    .files = "src/engine/effects/far_light.cpp src/engine/shared/effects/far_light.h",
    .position = reads,
    .color = reads,
    .cone = reads,
    .max_falloff = reads,
    .masks = reads,  // a light that does not reach every surface has no far light
    .shadows = "far light is not hidden: docs/far_light.md#errors",
    .effects = reads};

}  // namespace

extern constexpr Effect far_light{.name = "far_light",
                                  .decide = decide,
                                  .make = make,
                                  .base = BaseOracle{.meant_by = "far-light"},
                                  .reader = &reader};

ReadFarLight read_far_light(PassContext& work) {
  return static_cast<FarLightVolume&>(*work.effects.find(far_light)).read(work);
}

}  // namespace lightgrid
