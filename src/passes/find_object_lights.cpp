// Object-light pairs on the CPU: tests boxes of instances, then of their clusters, against spheres and cones
// of lights.
#include "passes/find_object_lights.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/error.h"

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

void ObjectLights::update(Work& work, const Seen& seen, const DrawList& list) {
  objects_.clear();
  lights_.clear();
  reaches_.clear();
  for (const ViewLight& light :
       lights_in_view(seen.scene, seen.view, seen.plan.settings.ranges, seen.plan.local))
    reaches_.emplace_back(bounds_of(light));
  std::vector<uint32_t> every_light(reaches_.size());
  std::iota(every_light.begin(), every_light.end(), 0u);
  for (const DrawItem& item : list) {
    const Aabb& bounds = seen.scene.meshes[seen.scene.instances[item.instance].mesh].bounds;
    const ViewBox whole = box_in_view(seen.transforms[item.instance].view_from_object, bounds);
    add_item(work, seen, item, lights_reaching(whole, reaches_, every_light));
  }
  for (Object& object : objects_) {
    object.ranges =
        index_ranges(work.gpu.in_gl().mesh(seen.scene.instances[object.instance].mesh), object.clusters);
  }
  upload_lists();
}

void ObjectLights::add_item(Work& work, const Seen& seen, const DrawItem& item,
                            const std::vector<uint32_t>& candidates) {
  const GlMesh& mesh = work.gpu.in_gl().mesh(seen.scene.instances[item.instance].mesh);
  const size_t first_object = objects_.size();
  for (const uint32_t cluster : item.clusters) {
    const ViewBox box =
        box_in_view(seen.transforms[item.instance].view_from_object, mesh.clusters[cluster].bounds);
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

LightSource from_objects(Work& work, const Seen& seen, const ObjectLights& objects) {
  const auto in_gl = [&work, &seen, &objects] {
    GlLightLoop loop = light_loop(seen);
    loop.defines.emplace_back("LIGHTS_OBJECT");
    if (objects.texture()) loop.textures.push_back({Sampler::object_lights, objects.texture()});
    return loop;
  };
  return LightSource(in_gl, {}, objects.lights().size() * sizeof(uint32_t));
}

static void count_bytes(const Seen& seen, const ObjectLights& objects, PassTimer::Scope& pass) {
  pass.moves(seen.plan.local.size() * sizeof(LightReach) + objects.objects().size() * sizeof(ViewBox),
             objects.lights().size() * sizeof(uint32_t));
}

const ObjectLights& find_object_lights(Work& work, const Seen& seen, Cached<ObjectLights>& cache,
                                       const DrawList& surfaces) {
  auto pass = work.timer.pass("find_object_lights", "cpu");
  ObjectLights& objects = cache.of(work, seen);
  objects.update(work, seen, surfaces);
  count_bytes(seen, objects, pass);
  return objects;
}

const ObjectLights& find_blended_object_lights(Work& work, const Seen& seen, Cached<ObjectLights>& cache) {
  ObjectLights& objects = cache.of(work, seen);
  if (!seen.plan.blend) return objects;
  auto pass = work.timer.pass("find_blended_object_lights", "cpu");
  objects.update(work, seen, seen.blended);
  count_bytes(seen, objects, pass);
  return objects;
}

}  // namespace lightgrid
