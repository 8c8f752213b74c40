#include "passes/fill_far_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cl/transfer.h"

namespace lightgrid {
namespace {

constexpr size_t far_group = 64;      // work-items of the group shape
constexpr double least_box_m = 1e-3;  // of a side

FarGrid grid_of(const WorldBox& box, const glm::dvec3& origin, int samples) {
  const glm::dvec3 size = glm::max(box.max - box.min, least_box_m);
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
  lookup.last_x = float(g.size_x - 1), lookup.last_y = float(g.size_y - 1),
  lookup.last_z = float(g.size_z - 1);
  return lookup;
}

bool sends_alike(const ViewLight& a, const ViewLight& b) {
  return a.type == b.type && a.position == b.position && a.direction == b.direction &&
         a.radiant_intensity == b.radiant_intensity && a.radius_m == b.radius_m &&
         a.cos_inner == b.cos_inner && a.cos_outer == b.cos_outer && a.window == b.window &&
         a.most_falloff == b.most_falloff;
}

}  // namespace

class FarLightVolume : public PassCache {
 public:
  explicit FarLightVolume(Work& work) : kernels(work, "far_light") { follow(work); }

  bool follow(Work& work) override {
    if (!work.plan.far_light) return false;
    const WorldBox box = world_box(work.scene);
    const glm::dvec3 at = box.empty() ? work.view.eye : 0.5 * (box.min + box.max);
    FarGrid placed = grid_of(box.empty() ? WorldBox{at, at} : box, at, work.plan.settings.far_light);
    placed.lights = uint(work.plan.local.size());
    View along;
    along.view_from_world = glm::dmat4(1);
    along.eye = at;
    std::vector<ViewLight> found = lights_in_view(work.scene, along, work.plan.settings.ranges);
    for (ViewLight& light : found) {
      if (light.groups != all_groups) light.radiant_intensity = glm::dvec3(0);
    }
    std::string defines;
    for (const char* define : light_table_defines(work.plan)) defines += fmt::format(" -D{}", define);
    if (kernels.lanes && work.plan.settings.portable) defines += " -DPORTABLE";
    const bool rebuilt = kernels.use(defines);
    const bool moved = at != origin || std::memcmp(&placed, &grid, sizeof grid) != 0 ||
                       !std::ranges::equal(found, lights, sends_alike);
    if (rebuilt || moved) filled = false;
    origin = at, grid = placed, lights = std::move(found);
    looked_up = false;
    return true;
  }

  size_t samples() const { return size_t(grid.size_x) * grid.size_y * grid.size_z; }
  size_t bytes() const { return samples() * FAR_PLANES * sizeof(glm::vec4); }
  size_t memory_bytes() const override {
    return columns.memory_bytes() + bytes() * (texture_bytes > 0 ? 2 : 1);
  }

  PassKernels kernels;
  glm::dvec3 origin{0};  // of the volume, in the world
  FarGrid grid{};
  std::vector<ViewLight> lights;  // along the world's axes from there
  ClLightColumns columns;
  UploadedBuffer grid_buffer;
  bool filled = false, looked_up = false, in_texture = false;
  size_t texture_bytes = 0;
};

namespace {

void fill(Work& work, FarLightVolume& s) {
  auto pass = work.timer.pass("fill_far_light", "cl");
  ClDevice& device = *work.renderer.cl;
  s.columns.upload(device, work.plan, s.lights);
  s.grid_buffer.put(device, "placing far light", std::vector<FarGrid>{s.grid});
  FarLightMemory& memory = *work.far_light;
  if (!memory.moments || memory.moments->size() != s.bytes()) {
    memory.moments.emplace(device, work.plan.opengl ? work.renderer.bridge : BridgeKind::none, s.bytes());
    memory.texture = {}, s.texture_bytes = 0;
  }
  const size_t a_item = s.kernels.lanes ? 16 : 1, a_group = s.kernels.lanes ? 1 : far_group;
  const size_t items = (s.samples() + a_item * a_group - 1) / (a_item * a_group) * a_group;
  s.kernels.of("fill_far_light")
      .launch(device, "fill_far_light", cl::NDRange(items), cl::NDRange(a_group),
              s.columns.columns() +
                  ClArguments{{"grid", s.grid_buffer.buffer()}, {"moments", memory.moments->cl_buffer()}});
  pass.moves(s.columns.memory_bytes(), s.bytes());
  s.filled = true, s.in_texture = false;
}

void to_texture(Work& work, FarLightVolume& s) {
  auto pass = work.timer.pass("far_light_to_gl", "gl");
  FarLightMemory& memory = *work.far_light;
  const PixelGrid slice{int(s.grid.size_x), int(s.grid.size_y)};
  const GLsizei depth = GLsizei(FAR_PLANES * s.grid.size_z);
  if (!memory.texture) {
    memory.texture = make_texture_3d(GL_RGBA32F, slice.width, slice.height, depth);
    s.texture_bytes = s.bytes();
  }
  memory.moments->hand_to_gl(s.bytes());
  work.renderer.pixel_copies.to_texture(memory.moments->gl_buffer(), GL_RGBA, GL_FLOAT, slice,
                                        memory.texture.name(), depth);
  pass.moves(s.bytes(), s.bytes());
  s.in_texture = true;
}

}  // namespace

void fill_far_light(Work& work, Cached<FarLightVolume>& cache) {
  if (!work.plan.far_light) return;
  FarLightVolume& s = cache.of(work);
  if (!work.far_light) work.far_light.emplace(), s.filled = s.looked_up = false;
  if (!s.filled) fill(work, s);
  if (!s.looked_up) {
    const FarLookup lookup = lookup_of(s.grid, s.origin, work.view);
    work.far_light->lookup.put(*work.renderer.cl, "placing far light", std::vector<FarLookup>{lookup});
    if (work.plan.opengl) {
      GlBuffer& block = work.far_light->block;
      if (!block) block = make_buffer(sizeof lookup, nullptr, GL_DYNAMIC_STORAGE_BIT);
      glNamedBufferSubData(block.name(), 0, sizeof lookup, &lookup);
    }
    s.looked_up = true;
  }
  if (work.plan.opengl && !s.in_texture) to_texture(work, s);
}

ReadFarLight read_far_light(Work& work, Cached<FarLightVolume>& cache) {
  FarLightVolume& s = cache.of(work);
  ReadFarLight read{s.grid, s.origin, std::vector<glm::vec4>(s.samples() * FAR_PLANES)};
  read_buffer(*work.renderer.cl, "reading far light", work.far_light->moments->cl_buffer(),
              read.moments.data(), s.bytes());
  return read;
}

}  // namespace lightgrid
