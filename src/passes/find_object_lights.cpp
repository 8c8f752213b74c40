// Object-light pairs on the CPU: boxes of instances, then of their clusters, against balls and cones of
// lights.
#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/error.h"
#include "passes/object_lights.h"

namespace lightgrid {
namespace {

std::vector<uint32_t> lights_reaching(const ViewBox& box, const std::vector<LightReach>& reaches,
                                      const std::vector<uint32_t>& candidates) {
  std::vector<uint32_t> found;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(found),
               [&](uint32_t light) { return reaches[light].may_reach(box); });
  return found;
}

}  // namespace

void ObjectLights::update(Frame& f, const std::vector<int>& instances, DrawOrder order,
                          const TileDistances* distances) {
  objects_.clear(), lights_.clear(), reaches_.clear();
  const std::vector<ViewLight> all = lights_in_view(f.scene, f.view);
  for (const int i : f.plan.local) reaches_.emplace_back(all[size_t(i)]);
  std::vector<uint32_t> every_light(reaches_.size());
  std::iota(every_light.begin(), every_light.end(), 0u);
  for (const VisiblePart& part : visible_parts(f, instances, order, distances)) {
    const ViewBox whole =
        box_in_view(part.view_from_object, f.scene.meshes[f.scene.instances[part.instance].mesh].bounds);
    add_part(f, part, lights_reaching(whole, reaches_, every_light));
  }
  upload();
}

void ObjectLights::add_part(Frame& f, const VisiblePart& part, const std::vector<uint32_t>& candidates) {
  const GpuMesh& mesh = f.gpu.mesh(f.scene.instances[part.instance].mesh);
  const size_t first_object = objects_.size();
  for (const uint32_t cluster : part.clusters) {
    const ViewBox box = box_in_view(part.view_from_object, mesh.clusters[cluster].bounds);
    const std::vector<uint32_t> lights = lights_reaching(box, reaches_, candidates);
    if (objects_.size() > first_object) {
      Object& last = objects_.back();
      if (std::equal(lights.begin(), lights.end(), lights_.begin() + last.first_light, lights_.end())) {
        last.clusters.push_back(cluster);
        continue;
      }
    }
    objects_.push_back({part.instance, {cluster}, uint32_t(lights_.size()), uint32_t(lights.size())});
    lights_.insert(lights_.end(), lights.begin(), lights.end());
  }
}

void ObjectLights::upload() {
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

static void count_bytes(const Frame& f, const ObjectLights& objects, PassTimer::Scope& pass) {
  pass.moves(f.plan.local.size() * sizeof(LightReach) + objects.objects().size() * sizeof(ViewBox),
             objects.lights().size() * sizeof(uint32_t));
}

const ObjectLights& find_object_lights(Frame& f, const TileDistances& distances) {
  auto pass = f.timer.pass("find_object_lights", "cpu");
  ObjectLights& objects = f.kept<ObjectLights>();
  objects.update(f, f.plan.opaque, DrawOrder::front_to_back, &distances);
  count_bytes(f, objects, pass);
  return objects;
}

const ObjectLights& find_blended_object_lights(Frame& f) {
  ObjectLights& objects = f.kept<BlendedObjectLights>();
  if (!f.plan.blend) return objects;
  auto pass = f.timer.pass("find_blended_object_lights", "cpu");
  objects.update(f, f.plan.blended, DrawOrder::as_given, nullptr);
  count_bytes(f, objects, pass);
  return objects;
}

}  // namespace lightgrid
