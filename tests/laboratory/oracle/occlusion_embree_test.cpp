// The oracle of shadows against Embree's robust mode, in float, on built-in scenes. Skipped without Embree.
#include <gtest/gtest.h>

#ifdef LIGHTGRID_EMBREE
#if LIGHTGRID_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include "oracle/occlusion.h"
#include "scene/random.h"
#include "scenes/builtin.h"

namespace lightgrid::lab {
namespace {

// The ray's id is the number of the receiver's triangle.
void leave_out_own(const RTCFilterFunctionNArguments* a) {
  for (unsigned i = 0; i < a->N; ++i) {
    if (RTCHitN_primID(a->hit, a->N, i) == RTCRayN_id(a->ray, a->N, i)) a->valid[i] = 0;
  }
}

bool casts(const Scene& scene, int instance) {
  return scene.instances[size_t(instance)].casts_shadow &&
         scene.materials[scene.meshes[scene.instances[instance].mesh].material].alpha_mode ==
             AlphaMode::opaque;
}

class EmbreeScene {
 public:
  explicit EmbreeScene(const Scene& scene) {
    const WorldBox box = world_box(scene);
    centre_ = (box.min + box.max) * 0.5;
    for (const Instance& instance : scene.instances) {
      const Mesh& mesh = scene.meshes[instance.mesh];
      first_.push_back(vertices_.size() / 3);
      if (!casts(scene, int(first_.size()) - 1)) continue;
      for (const uint32_t i : mesh.indices)
        vertices_.push_back(
            relative(glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[i], 1))));
    }
    device_ = rtcNewDevice(nullptr);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices_.size()));
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), vertices_.size() / 3));
    for (unsigned i = 0; i < vertices_.size(); ++i) {
      corners[i] = i;
      for (int k = 0; k < 3; ++k) places[3 * i + unsigned(k)] = vertices_[i][k];
    }
    rtcSetGeometryOccludedFilterFunction(geometry, leave_out_own);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  bool hidden(const glm::dvec3& light, const Receiver& r) const {
    const glm::vec3 from = relative(light), step = relative(r.place.place) - from;
    RTCRay ray{from.x, from.y, from.z, 0, step.x, step.y, step.z, 0};
    ray.tfar = 1 - float(r.gap_m) / glm::length(step);
    ray.mask = ~0u;
    ray.id = unsigned(first_[size_t(r.own.instance)]) + r.own.triangle;
#if LIGHTGRID_EMBREE == 3
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &ray);
#else
    rtcOccluded1(scene_, &ray, nullptr);
#endif
    return ray.tfar < 0;
  }

 private:
  glm::vec3 relative(const glm::dvec3& p) const { return glm::vec3(p - centre_); }

  glm::dvec3 centre_{0};
  std::vector<size_t> first_;  // triangle of each instance
  std::vector<glm::vec3> vertices_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

// On a random opaque triangle, on the side that faces the light.
Receiver random_receiver(Random& random, const Scene& scene, const glm::dvec3& light) {
  for (;;) {
    const int i = int(random.next() % scene.instances.size());
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    if (!casts(scene, i)) continue;
    const uint32_t triangle = uint32_t(random.next() % (mesh.indices.size() / 3));
    glm::dvec3 c[3];
    for (int k = 0; k < 3; ++k)
      c[k] = glm::dvec3(scene.instances[i].world_from_object *
                        glm::dvec4(mesh.positions[mesh.indices[3 * triangle + uint32_t(k)]], 1));
    const double u = random.uniform(), v = random.uniform() * (1 - u);
    const glm::dvec3 place = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
    if (glm::length(light - place) < 0.1) continue;
    const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
    const double turn = glm::dot(normal, light - place) < 0 ? -1 : 1;
    return {{i, triangle}, {place, 1e-5}, 1.1e-3, {place + normal * turn / glm::length(normal), 1e-5}};
  }
}

struct Disagreements {
  int seen = 0, hidden = 0, either = 0, leaked = 0, acned = 0;
};

Disagreements compare_in(const Scene& scene, int pairs) {
  const Occlusion occlusion(scene);
  const EmbreeScene embree(scene);
  Random random(30);
  Disagreements d;
  for (int i = 0; i < pairs; ++i) {
    const glm::dvec3 light = scene.lights[size_t(random.next() % scene.lights.size())].position;
    const Receiver receiver = random_receiver(random, scene, light);
    Light at;
    at.position = light;
    const SightAnswer answer = occlusion.sight(at, receiver);
    const Sight sight = answer.sight;
    if (sight == Sight::hidden && !casts(scene, answer.by.instance)) continue;
    const bool hidden = embree.hidden(light, receiver);
    ++(sight == Sight::seen ? d.seen : sight == Sight::hidden ? d.hidden : d.either);
    d.leaked += sight == Sight::hidden && !hidden;
    d.acned += sight == Sight::seen && hidden;
  }
  return d;
}

TEST(OcclusionAgainstEmbree, AgreesOnBuiltInScenesWhereItIsCertain) {
  for (const char* name : {"hall", "gallery", "street"}) {
    const Disagreements d = compare_in(find_builtin_scene(name)->make(), 20'000);
    EXPECT_EQ(d.leaked, 0) << name;
    EXPECT_EQ(d.acned, 0) << name;
    EXPECT_GT(d.seen, 400) << name;
    EXPECT_GT(d.hidden, 4000) << name;
    EXPECT_LT(d.either, 400) << name;  // lights of the street lie in faces of their lamps
  }
}

}  // namespace
}  // namespace lightgrid::lab
#else
TEST(OcclusionAgainstEmbree, AgreesOnBuiltInScenesWhereItIsCertain) {
  GTEST_SKIP() << "built without Embree (libembree-dev, 3 or 4)";
}
#endif
