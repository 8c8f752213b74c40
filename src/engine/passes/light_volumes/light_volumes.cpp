#include "passes/light_volumes/light_volumes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "passes/common/surface_numbers.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "plan/visibility.h"

namespace lightgrid {
namespace {

constexpr double u = 0x1p-24;
using std::numbers::pi;

// Layout of the attributes in shaders/common/light_volume.glsl.
struct VolumeInstance {
  glm::mat4 clip_from_mesh;
  uint32_t light;
};

// Spheres by number of subdivisions, then cones by half-angle.
constexpr uint32_t first_ball = 1, balls = 3, box = 4, pyramid = 5, first_cone = 6;
constexpr double narrow_rad = 30 * pi / 180;  // up to here a pyramid is tight enough
constexpr double cone_step_rad = 10 * pi / 180;
constexpr int cones = 6;  // 40, 50 ... 90 degrees
// No vertex of a mesh is farther out than this many times the mesh's size; the box's corner is.
constexpr double farthest_corner = 1.74;

// Radii in pixels from which faces are cut once, and twice: below, extra vertices cost more than the pixels
// they save.
constexpr double cut_once_px = 32, cut_twice_px = 250;

double pixel_size(const View& view, double distance) {
  const double x = 2 / (view.clip_from_view[0][0] * view.width),
               y = 2 / (view.clip_from_view[1][1] * view.height);
  return std::max(x, y) * (view.orthographic ? 1 : std::max(distance, view.near_m));
}

// How far outside its true surface a volume must reach, if its corners are within `reach` of the light.
//   lights and shading in float: as in culling (docs/hard_cases.md#slack)
//   corners snapped to the rasteriser's grid, those of clipped triangles twice: two steps of the grid
//   depth interpolated across a triangle: 32 roundings of the nearest corner's depth
//   depth across triangles seen edge-on has no useful bound: 1/256 of the radius
double slack(const View& view, const LightBounds& light, double reach, int subpixel_bits) {
  const glm::dvec3 p = light.position;
  const double sum = std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
  const double farthest = std::max(-p.z + reach, 0.0), nearest = std::max(-p.z - reach, view.near_m);
  const double in_depth = view.orthographic ? view.far_m - view.near_m : farthest * farthest / nearest;
  return 24 * u * (sum + light.radius_m) + std::ldexp(pixel_size(view, farthest), 1 - subpixel_bits) +
         32 * u * in_depth + light.radius_m / 256;
}

// Slack that includes its own enlargement; none if that does not converge: a light before the near plane that
// ends far away.
std::optional<double> settled_slack(const View& view, const LightBounds& light, double per_slack,
                                    int subpixel_bits) {
  double given = 0;
  for (int i = 0; i < 8; ++i) {
    const double needed =
        slack(view, light, farthest_corner * (light.radius_m + per_slack * given), subpixel_bits);
    if (!(needed < 1e15)) return {};
    if (needed <= given) return given;
    given = 1.05 * needed;
  }
  return {};
}

glm::dmat4 placed(const glm::dvec3& at, const glm::dmat3& axes) {
  glm::dmat4 matrix(axes);
  matrix[3] = glm::dvec4(at, 1);
  return matrix;
}

// Orthonormal axes, the third along `direction`.
glm::dmat3 axes_along(const glm::dvec3& direction) {
  const glm::dvec3 other = std::abs(direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, direction));
  return {x, glm::cross(direction, x), direction};
}

uint32_t ball_for(const View& view, const LightBounds& light, VolumeMeshes meshes) {
  if (meshes == VolumeMeshes::box) return box;
  if (meshes == VolumeMeshes::icosahedron) return first_ball;
  const double pixels = light.radius_m / pixel_size(view, -light.position.z - light.radius_m);
  return first_ball + (pixels > cut_once_px) + (pixels > cut_twice_px);
}

// Sets mesh and matrix, or mesh `everything`.
void shape_volume(const View& view, const LightBounds& light, VolumeMeshes meshes, int subpixel_bits,
                  LightVolume& volume) {
  const double angle = light.widened_angle_rad();
  const bool cone = angle < pi / 2 && meshes != VolumeMeshes::box;
  // A cone grown by its slack equals the cone moved back by slack / sin(angle).
  const double back = cone ? 1 / std::sin(angle) : 0;
  const std::optional<double> given = settled_slack(view, light, 1 + back, subpixel_bits);
  volume.mesh = LightVolume::everything;
  if (!given) return;
  const double size = light.radius_m + (1 + back) * *given;
  if (!cone) {
    volume.mesh = ball_for(view, light, meshes);
    volume.view_from_mesh = placed(light.position, glm::dmat3(size));
    return;
  }
  glm::dmat3 axes = axes_along(light.direction) * size;
  if (angle <= narrow_rad) {
    volume.mesh = pyramid;
    axes[0] *= std::tan(angle);
    axes[1] *= std::tan(angle);
  } else {
    volume.mesh = first_cone +
                  uint32_t(std::clamp(std::ceil((angle - narrow_rad) / cone_step_rad), 1.0, double(cones))) -
                  1;
  }
  volume.view_from_mesh = placed(light.position - light.direction * (back * *given), axes);
}

// From the corners' positions in clip space.
void find_pixels(const View& view, const glm::dvec2& low, const glm::dvec2& high, LightVolume& volume) {
  const glm::dvec2 size(view.width, view.height);
  volume.low_px = glm::clamp((low * 0.5 + 0.5) * size, glm::dvec2(0), size);
  volume.high_px = glm::clamp((high * 0.5 + 0.5) * size, glm::dvec2(0), size);
  volume.first = glm::ivec2(glm::floor(volume.low_px));
  volume.end = glm::ivec2(glm::ceil(volume.high_px));
}

void cover_screen(const View& view, LightVolume& volume) {
  volume.clip_from_mesh = glm::mat4(1);
  volume.center = {0, 0, 0};
  volume.radius = std::numeric_limits<double>::infinity();
  volume.crosses_near = true;
  find_pixels(view, glm::dvec2(-1), glm::dvec2(1), volume);
}

// Derives the rest from mesh and matrix. False: all corners are outside one of the view's planes.
bool place_volume(const View& view, const Frustum& frustum, LightVolume& volume) {
  const LightMesh& mesh = light_meshes()[volume.mesh];
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  glm::dvec2 screen_low(low), screen_high(high);
  double inside[6] = {-1, -1, -1, -1, -1, -1}, nearest = low.x;
  std::vector<glm::dvec3> corners;
  corners.reserve(mesh.positions.size());
  for (const glm::vec3& position : mesh.positions) {
    const glm::dvec3 p(volume.view_from_mesh * glm::dvec4(position, 1));
    corners.push_back(p);
    low = glm::min(low, p);
    high = glm::max(high, p);
    nearest = std::min(nearest, -p.z);
    for (int i = 0; i < frustum.count; ++i) {
      inside[i] = std::max(
          inside[i], glm::dot(glm::dvec3(frustum.planes[i]), p) + frustum.planes[i].w >= 0 ? 1.0 : -1.0);
    }
    const glm::dvec4 clip = view.clip_from_view * glm::dvec4(p, 1);
    screen_low = glm::min(screen_low, glm::dvec2(clip) / clip.w);
    screen_high = glm::max(screen_high, glm::dvec2(clip) / clip.w);
  }
  for (int i = 0; i < frustum.count; ++i) {
    if (inside[i] < 0) return false;
  }
  volume.center = 0.5 * (low + high);
  volume.radius = 0;
  for (const glm::dvec3& p : corners) volume.radius = std::max(volume.radius, glm::length(p - volume.center));
  volume.clip_from_mesh = glm::mat4(view.clip_from_view * volume.view_from_mesh);
  // Rounding: 1e-5 of the distance, as for clusters.
  volume.crosses_near = nearest < view.near_m + 1e-5 * (std::abs(view.near_m) + volume.radius);
  if (volume.crosses_near) {
    screen_low = glm::dvec2(-1);
    screen_high = glm::dvec2(1);
  }
  find_pixels(view, screen_low, screen_high, volume);
  return true;
}

}  // namespace

const std::vector<LightMesh>& light_meshes() {
  static const std::vector<LightMesh> meshes = [] {
    std::vector<LightMesh> all = {everything_mesh()};
    for (uint32_t i = 0; i < balls; ++i) all.push_back(ball_mesh(int(i)));
    all.push_back(box_mesh());
    all.push_back(pyramid_mesh());
    for (int i = 1; i <= cones; ++i) all.push_back(cone_mesh(narrow_rad + i * cone_step_rad));
    return all;
  }();
  return meshes;
}

std::vector<LightVolume> light_volumes(const View& view, std::span<const ViewLight> lights,
                                       VolumeMeshes meshes, int subpixel_bits) {
  const Frustum frustum = frustum_of(view);
  std::vector<LightVolume> volumes;
  for (size_t i = 0; i < lights.size(); ++i) {
    const LightBounds bounds = bounds_of(lights[i]);
    if (!(bounds.radius_m > 0)) continue;
    LightVolume volume{.light = uint32_t(i), .bounds = bounds};
    shape_volume(view, bounds, meshes, subpixel_bits, volume);
    if (volume.mesh == LightVolume::everything) {
      if (!may_see_sphere(frustum, bounds.position, bounds.radius_m)) continue;
      cover_screen(view, volume);
    } else if (!place_volume(view, frustum, volume)) {
      continue;
    }
    volumes.push_back(volume);
  }
  return volumes;
}

// The volumes of a plan that builds in advance.
static std::vector<LightVolume> whole_screens(const View& view, std::span<const ViewLight> lights,
                                              PlannedLights planned) {
  std::vector<LightVolume> volumes;
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!counts_as_seen(planned, lights[i], true)) continue;
    LightVolume volume{.light = uint32_t(i), .bounds = bounds_of(lights[i]), .mesh = LightVolume::everything};
    cover_screen(view, volume);
    volumes.push_back(volume);
  }
  return volumes;
}

LightVolumes::LightVolumes(PassContext& work) : array_(make_vertex_array()) {
  glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits_);
  std::vector<glm::vec3> positions;
  std::vector<uint16_t> indices;
  for (const LightMesh& mesh : light_meshes()) {
    ranges_.push_back(
        {GLint(positions.size()), GLsizei(mesh.indices.size()), indices.size() * sizeof(uint16_t)});
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
  }
  vertices_ = make_buffer(positions.size() * sizeof(glm::vec3), positions.data());
  indices_ = make_buffer(indices.size() * sizeof(uint16_t), indices.data());
  instance_bytes_ = work.plan.lights.local.size() * sizeof(VolumeInstance);
  instances_ = make_buffer(instance_bytes_, nullptr);
  mesh_bytes_ = positions.size() * sizeof(glm::vec3) + indices.size() * sizeof(uint16_t);

  const GLuint array = array_.name();
  glVertexArrayElementBuffer(array, indices_.name());
  glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(glm::vec3));
  glVertexArrayVertexBuffer(array, 1, instances_.name(), 0, sizeof(VolumeInstance));
  glVertexArrayBindingDivisor(array, 1, 1);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  for (GLuint column = 0; column < 4; ++column) {
    glVertexArrayAttribFormat(array, 1 + column, 4, GL_FLOAT, GL_FALSE, GLuint(column * sizeof(glm::vec4)));
  }
  glVertexArrayAttribIFormat(array, 5, 1, GL_UNSIGNED_INT, sizeof(glm::mat4));
  for (GLuint attribute = 0; attribute < 6; ++attribute) {
    glVertexArrayAttribBinding(array, attribute, attribute > 0);
    glEnableVertexArrayAttrib(array, attribute);
  }
}

size_t LightVolumes::memory_bytes() const { return mesh_bytes_ + instance_bytes_; }

bool LightVolumes::follow(PassContext& work) {
  return instance_bytes_ == work.plan.lights.local.size() * sizeof(VolumeInstance);
}

const std::vector<LightVolume>& LightVolumes::update(const ViewState& seen) {
  const std::vector<ViewLight> lights =
      lights_in_view(seen.scene, seen.view, ranges_of(seen.plan.settings), seen.plan.lights.local);
  const PlannedLights planned = seen.plan.lights.planned;
  std::vector<LightVolume> volumes =
      planned == PlannedLights::in_view
          ? light_volumes(seen.view, lights, seen.plan.settings[setting::volume_mesh], subpixel_bits_)
          : whole_screens(seen.view, lights, planned);
  if (seen.plan.masks.stencil_bits > 0) {
    const std::vector<uint8_t> masks = stencil_masks(seen).of_light;
    std::ranges::stable_sort(volumes, {}, [&](const LightVolume& v) { return masks[v.light]; });
  }
  upload_volumes(std::move(volumes));
  return volumes_;
}

void LightVolumes::upload_volumes(std::vector<LightVolume> volumes) {
  volumes_ = std::move(volumes);
  std::vector<VolumeInstance> instances;
  for (const LightVolume& volume : volumes_) instances.push_back({volume.clip_from_mesh, volume.light});
  if (!instances.empty())
    glNamedBufferSubData(instances_.name(), 0, GLsizeiptr(instances.size() * sizeof(VolumeInstance)),
                         instances.data());
}

void LightVolumes::begin() const {
  glBindVertexArray(array_.name());
  glEnable(GL_DEPTH_CLAMP);
  glEnable(GL_CLIP_DISTANCE0);
  glDisable(GL_CULL_FACE);
  glFrontFace(GL_CCW);
}

void LightVolumes::end() const {
  glDisable(GL_DEPTH_CLAMP);
  glDisable(GL_CLIP_DISTANCE0);
  glBindVertexArray(0);
}

void LightVolumes::draw(size_t first, size_t count) const {
  for (size_t i = first, next = i; i < first + count; i = next) {
    while (next < first + count && volumes_[next].mesh == volumes_[i].mesh) ++next;
    const Range& range = ranges_[volumes_[i].mesh];
    glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, range.count, GL_UNSIGNED_SHORT,
                                                  reinterpret_cast<const void*>(range.first_index_byte),
                                                  GLsizei(next - i), range.base_vertex, GLuint(i));
  }
}

}  // namespace lightgrid
