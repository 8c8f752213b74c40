// Object-light pairs on the CPU: tests boxes of instances, then of their clusters, against spheres and cones
// of lights.
#include "passes/find_object_lights.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "passes/cap_lists.h"
#include "plan/settings/model.h"
#include "scene/effect_terms.h"

namespace lightgrid {
namespace {

// The lights whose masks meet that of the instance. All of them if no effect has masks.
std::vector<uint32_t> lights_of_mask(const ViewState& seen, int instance, const std::vector<uint32_t>& all) {
  if (!seen.plan.masks.needed) return all;
  const uint32_t mask = mask_of(seen.scene.instances[size_t(instance)]);
  std::vector<uint32_t> met;
  std::ranges::copy_if(all, std::back_inserter(met), [&](uint32_t light) {
    return (mask_of(seen.scene.lights[size_t(seen.plan.lights.local[light])]) & mask) != 0;
  });
  return met;
}

std::vector<uint32_t> lights_reaching(const ViewBox& box, const std::vector<LightReach>& reaches,
                                      const std::vector<uint32_t>& candidates) {
  std::vector<uint32_t> found;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(found),
               [&](uint32_t light) { return reaches[light].may_reach(box); });
  return found;
}

}  // namespace

void ObjectLights::update(PassContext& work, const DrawList& list) {
  objects_.clear();
  lights_.clear();
  reaches_.clear();
  const std::vector<ViewLight> lights =
      lights_in_view(work.scene, work.view, ranges_of(work.plan.settings), work.plan.lights.local);
  for (const ViewLight& light : lights) reaches_.emplace_back(bounds_of(light));
  std::vector<uint32_t> every_light(reaches_.size());
  std::iota(every_light.begin(), every_light.end(), 0u);
  if (const auto& left_out = work.plan.lights.left_out; !left_out.empty())
    std::erase_if(every_light, [&](uint32_t light) { return left_out[light] != 0; });
  for (const DrawItem& item : list) {
    const Aabb& bounds = work.scene.meshes[work.scene.instances[item.instance].mesh].bounds;
    const ViewBox whole = box_in_view(work.transforms[item.instance].view_from_object, bounds);
    std::vector<uint32_t> reaching =
        lights_reaching(whole, reaches_, lights_of_mask(work, item.instance, every_light));
    cap_list(work.plan.settings, lights, whole.center, reaching);
    add_item(work, item, reaching);
  }
  for (Object& object : objects_) {
    object.ranges =
        index_ranges(work.gpu.in_gl().mesh(work.scene.instances[object.instance].mesh), object.clusters);
  }
  upload_lists();
}

void ObjectLights::add_item(PassContext& work, const DrawItem& item,
                            const std::vector<uint32_t>& candidates) {
  const GlMesh& mesh = work.gpu.in_gl().mesh(work.scene.instances[item.instance].mesh);
  const size_t first_object = objects_.size();
  for (const uint32_t cluster : item.clusters) {
    const ViewBox box =
        box_in_view(work.transforms[item.instance].view_from_object, mesh.clusters[cluster].bounds);
    const std::vector<uint32_t> lights = lights_reaching(box, reaches_, candidates);
    if (objects_.size() > first_object) {
      Object& last = objects_.back();
      if (std::equal(lights.begin(), lights.end(), lights_.begin() + last.first_light, lights_.end())) {
        last.clusters.push_back(cluster);
        continue;
      }
    }
    objects_.push_back({item.instance, {cluster}, uint32_t(lights_.size()), uint32_t(lights.size()), {}});
    lights_.insert(lights_.end(), lights.begin(), lights.end());
  }
}

void ObjectLights::upload_lists() {
  const size_t bytes = lights_.size() * sizeof(uint32_t);
  if (bytes > buffer_bytes_) {
    GLint texels = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    if (lights_.size() > size_t(texels)) {
      throw machine_error(
          "object-light pairs: {} are more than the {} texels that a buffer texture may have in this "
          "OpenGL; use fewer or smaller lights",
          lights_.size(), texels);
    }
    buffer_ = make_buffer(bytes, lights_.data());
    texture_ = make_buffer_texture(GL_R32UI, buffer_.name());
    buffer_bytes_ = bytes;
  } else if (bytes > 0) {
    glNamedBufferSubData(buffer_.name(), 0, GLsizeiptr(bytes), lights_.data());
  }
}

LightSource from_objects(PassContext& work, const ObjectLights& objects) {
  const auto in_gl = [&work, &objects] {
    GlLightLoop loop = light_loop(work);
    loop.defines.emplace_back("LIGHTS_OBJECT");
    if (objects.texture()) loop.textures.push_back({Sampler::object_lights, objects.texture()});
    return loop;
  };
  return LightSource(in_gl, {}, objects.lights().size() * sizeof(uint32_t));
}

static void count_bytes(const ViewState& seen, const ObjectLights& objects, PassTimer::Scope& pass) {
  pass.moves(seen.plan.lights.local.size() * sizeof(LightReach) + objects.objects().size() * sizeof(ViewBox),
             objects.lights().size() * sizeof(uint32_t));
}

const ObjectLights& find_object_lights(PassContext& work, Cached<ObjectLights>& cache,
                                       const DrawList& surfaces) {
  auto pass = work.timer.pass("find_object_lights", "cpu");
  ObjectLights& objects = cache.of(work);
  objects.update(work, surfaces);
  count_bytes(work, objects, pass);
  return objects;
}

const ObjectLights& find_blended_object_lights(PassContext& work, Cached<ObjectLights>& cache) {
  ObjectLights& objects = cache.of(work);
  if (!work.plan.surfaces.blend) return objects;
  auto pass = work.timer.pass("find_blended_object_lights", "cpu");
  objects.update(work, work.blended);
  count_bytes(work, objects, pass);
  return objects;
}

namespace {

// Bounds the float rounding of vertices, depth, lights and positions together: under 1e-5 of the distances.
// 1/256 of the radius is for depth across triangles seen edge-on, which has no useful bound (as in
// light_volumes.cpp).
constexpr double rounding = 1e-5, of_radius = 1.0 / 256;

double sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

ViewBox box_in_view(const glm::dmat4& view_from_object, const Aabb& box) {
  const glm::dvec3 center = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)),
                   half = glm::dvec3(box.max) - center;
  const glm::dmat3 axes(view_from_object);
  return {glm::dvec3(view_from_object * glm::dvec4(center, 1)),
          glm::abs(axes[0]) * half.x + glm::abs(axes[1]) * half.y + glm::abs(axes[2]) * half.z};
}

LightReach::LightReach(const LightBounds& light)
    : position_(light.position), direction_(light.direction), radius_(light.radius_m) {
  const double angle = light.widened_angle_rad();
  cone_ = angle < std::numbers::pi / 2;
  cos_ = std::cos(angle);
  sin_ = std::sin(angle);
}

bool LightReach::may_reach(const ViewBox& box) const {
  if (!(radius_ > 0)) return false;  // radius 0 lights nothing
  const double slack = rounding * (sum(position_) + sum(box.center) + sum(box.half));
  const double reach = radius_ * (1 + rounding + of_radius) + slack;
  const glm::dvec3 from_light = box.center - position_;
  const glm::dvec3 outside = glm::max(glm::abs(from_light) - box.half, 0.0);
  if (glm::dot(outside, outside) > reach * reach) return false;
  if (!cone_) return true;
  // The sphere around the box against the cone's side: the distance from it, negative inside. An apex in the
  // sphere passes.
  const double ball = glm::length(box.half) + slack + of_radius * std::min(radius_, 1e30);
  const double along = glm::dot(from_light, direction_);
  const double across = std::sqrt(std::max(glm::dot(from_light, from_light) - along * along, 0.0));
  return cos_ * across - sin_ * along <= ball;
}

}  // namespace lightgrid
