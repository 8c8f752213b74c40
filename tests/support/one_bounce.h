// A light's contribution to a pixel after one reflection, in double on the oracle's surfaces, with Embree's
// rays: the truth of virtual lights. Shares no formula with them: directions are chosen at the pixel, none at
// the light.
#pragma once

#ifdef LIGHTGRID_EMBREE
#if LIGHTGRID_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "oracle/attenuation.h"
#include "oracle/scene_surfaces.h"
#include "scene/random.h"

namespace lightgrid {
using namespace lab;

class OneBounce {
 public:
  // Opaque and masked surfaces stop rays, from both sides; blended ones do not. The scene outlives it. lobe:
  // of both reflections.
  OneBounce(const Scene& scene, Brdf lobe) : scene_(scene), lobe_(lobe) {
    const WorldBox box = world_box(scene);
    centre_ = (box.min + box.max) * 0.5;
    reach_m_ = glm::length(box.max - box.min);
    for (int i = 0; i < int(scene.instances.size()); ++i) {
      const Instance& instance = scene.instances[size_t(i)];
      const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
      const Material& m = scene.materials[size_t(mesh.material)];
      if (m.alpha_mode == AlphaMode::blend) continue;
      for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t) {
        Triangle& made = triangles_.emplace_back();
        made.instance = i;
        for (size_t k = 0; k < 3; ++k) {
          made.vertices[k] = mesh.indices[3 * t + k];
          made.corners[k] =
              glm::dvec3(instance.world_from_object * glm::dvec4(mesh.positions[made.vertices[k]], 1));
        }
        made.front = glm::cross(made.corners[1] - made.corners[0], made.corners[2] - made.corners[0]);
        if (glm::determinant(glm::dmat3(instance.world_from_object)) < 0) made.front = -made.front;
      }
    }
    build();
  }
  ~OneBounce() {
    rtcReleaseScene(embree_);
    rtcReleaseDevice(device_);
  }
  OneBounce(const OneBounce&) = delete;
  OneBounce& operator=(const OneBounce&) = delete;

  // Radiance towards the eye from a pixel that shows this triangle, of one light after one reflection: the
  // mean over `samples` directions about its normal, in proportion to the cosine. `seed` shifts them.
  glm::dvec3 radiance(const View& view, int x, int y, int instance, const std::array<uint32_t, 3>& vertices,
                      const Light& light, int samples, uint64_t seed) {
    SceneSurfaces seen(scene_, view);
    const TriangleInView triangle = seen.triangle(instance, vertices);
    const glm::dvec2 pixel(x + 0.5, y + 0.5);
    const Surface surface = seen.surface_at(triangle, pixel);
    const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
    const glm::dvec3 way((pixel.x * 2 / view.width - 1) / view.clip_from_view[0][0],
                         (pixel.y * 2 / view.height - 1) / view.clip_from_view[1][1], -1);
    const std::array<glm::dvec3, 3> corners = corners_of(instance, vertices);
    glm::dvec3 plane = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const glm::dvec3 along = world_from_view * way;
    if (glm::dot(plane, along) > 0) plane = -plane;
    const double distance = glm::dot(corners[0] - view.eye, plane) / glm::dot(along, plane);
    const glm::dvec3 at = view.eye + distance * along + plane * (reach_m_ * 1e-6);
    const glm::dvec3 to_eye = -glm::normalize(way), n = surface.normal;
    const glm::dvec3 right =
        glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 up = glm::cross(n, right);
    Random random(Random::mix(seed) + Random::mix((uint64_t(y) << 32) + uint64_t(x) + 1));
    const double shift_u = double(random.uniform()), shift_v = double(random.uniform());
    glm::dvec3 sum(0);
    for (int i = 0; i < samples; ++i) {
      const double u = fraction((i + 0.5) / samples + shift_u);
      const double v = fraction(i * 0.6180339887498949 + shift_v) * 2 * std::numbers::pi;
      const double cosine = std::sqrt(1 - u);
      const glm::dvec3 to_surface = n * cosine + (right * std::cos(v) + up * std::sin(v)) * std::sqrt(u);
      const glm::dvec3 arriving = reflected_from(at, world_from_view * to_surface, light);
      if (arriving == glm::dvec3(0) || !(cosine > 0)) continue;
      sum += arriving * reflected(surface, to_eye, to_surface, lobe_) * (std::numbers::pi / cosine);
    }
    return sum / double(samples);
  }

 private:
  struct Triangle {
    int instance = 0;
    std::array<uint32_t, 3> vertices{};
    std::array<glm::dvec3, 3> corners{};
    glm::dvec3 front{0};  // normal of the front face, not unit
  };

  static double fraction(double x) { return x - std::floor(x); }
  const Material& material(int instance) const {
    return scene_.materials[size_t(scene_.meshes[size_t(scene_.instances[size_t(instance)].mesh)].material)];
  }
  std::array<glm::dvec3, 3> corners_of(int instance, const std::array<uint32_t, 3>& vertices) const {
    const Instance& of = scene_.instances[size_t(instance)];
    std::array<glm::dvec3, 3> corners;
    for (size_t k = 0; k < 3; ++k)
      corners[k] = glm::dvec3(of.world_from_object *
                              glm::dvec4(scene_.meshes[size_t(of.mesh)].positions[vertices[k]], 1));
    return corners;
  }

  // Radiance that arrives from a direction: of the first surface there under the light.
  glm::dvec3 reflected_from(const glm::dvec3& at, const glm::dvec3& direction, const Light& light) {
    RTCRayHit hit{};
    set(hit.ray, at, direction, 0, reach_m_ * 2);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    intersect(hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return glm::dvec3(0);
    const Triangle& t = triangles_[hit.hit.primID];
    const Material& m = material(t.instance);
    const glm::dvec3 place = t.corners[0] + double(hit.hit.u) * (t.corners[1] - t.corners[0]) +
                             double(hit.hit.v) * (t.corners[2] - t.corners[0]);
    const glm::dvec3 to_light = light.position - place;
    const double of_eye = -glm::dot(t.front, direction), of_light = glm::dot(t.front, to_light);
    if (m.unlit || of_eye * of_light <= 0 || (of_eye < 0 && !m.double_sided)) return glm::dvec3(0);
    const glm::dvec3 above =
        place + glm::normalize(t.front) * (of_light > 0 ? reach_m_ * 1e-6 : -reach_m_ * 1e-6);
    if (hidden(above, light.position)) return glm::dvec3(0);
    // The surface as a camera at the light sees it, in one small pixel.
    Camera camera = look_at(light.position, place);
    camera.fov_y_rad = 1e-4;
    camera.near_m = std::min(1e-3, glm::length(to_light) / 2);
    const View view = make_view(camera, 1, 1);
    SceneSurfaces seen(scene_, view);
    const Surface surface = seen.surface_at(seen.triangle(t.instance, t.vertices), {0.5, 0.5});
    Scene of_light_alone;
    of_light_alone.lights = {light};
    const ViewLight in_view = lights_in_view(of_light_alone, view)[0];
    const glm::dvec3 position(0, 0, -glm::length(to_light));
    const glm::dvec3 back = glm::normalize(glm::dmat3(view.view_from_world) * -direction);
    return reflected(surface, back, {0, 0, 1}, lobe_) * in_view.radiant_intensity *
           attenuation(in_view, position, true);
  }

  bool hidden(const glm::dvec3& from, const glm::dvec3& to) {
    RTCRayHit hit{};
    set(hit.ray, from, to - from, 0, 1 - 1e-6);
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    shadow_ = true;
    intersect(hit);
    shadow_ = false;
    return hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

  void set(RTCRay& ray, const glm::dvec3& from, const glm::dvec3& way, double near, double far) const {
    const glm::vec3 o(from - centre_), d(way);
    ray.org_x = o.x;
    ray.org_y = o.y;
    ray.org_z = o.z;
    ray.dir_x = d.x;
    ray.dir_y = d.y;
    ray.dir_z = d.z;
    ray.tnear = float(near);
    ray.tfar = float(far);
    ray.mask = ~0u;
  }

  void intersect(RTCRayHit& hit) {
#if LIGHTGRID_EMBREE == 3
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_, &context, &hit);
#else
    rtcIntersect1(embree_, &hit, nullptr);
#endif
  }

  // Holes of masks, and in rays to a light what casts no shadow.
  static void filter(const RTCFilterFunctionNArguments* a) {
    auto* self = static_cast<OneBounce*>(a->geometryUserPtr);
    for (unsigned i = 0; i < a->N; ++i) {
      const Triangle& t = self->triangles_[RTCHitN_primID(a->hit, a->N, i)];
      const bool casts = self->scene_.instances[size_t(t.instance)].casts_shadow;
      if ((self->shadow_ && !casts) ||
          self->is_hole(t, double(RTCHitN_u(a->hit, a->N, i)), double(RTCHitN_v(a->hit, a->N, i))))
        a->valid[i] = 0;
    }
  }

  bool is_hole(const Triangle& t, double u, double v) {
    const Material& m = material(t.instance);
    if (m.alpha_mode != AlphaMode::mask) return false;
    const Mesh& mesh = scene_.meshes[size_t(scene_.instances[size_t(t.instance)].mesh)];
    double alpha = double(m.base_color.a);
    const TextureSlot& slot = m.base_color_map;
    if (slot.texture >= 0) {
      const auto& uvs = slot.uv_set == 1 ? mesh.uv1 : mesh.uv0;
      const glm::dvec2 uv = (1 - u - v) * glm::dvec2(uvs[t.vertices[0]]) +
                            u * glm::dvec2(uvs[t.vertices[1]]) + v * glm::dvec2(uvs[t.vertices[2]]);
      const Texture& texture = scene_.textures[size_t(slot.texture)];
      auto found = samplers_.find(slot.texture);
      if (found == samplers_.end())
        found = samplers_.try_emplace(slot.texture, scene_.bitmaps[size_t(texture.bitmap)], texture).first;
      alpha *= found->second.at(glm::dmat3x2(slot.uv_from_vertex) * glm::dvec3(uv, 1), {0, 0}, {0, 0}).a;
    }
    return alpha < double(m.alpha_cutoff);
  }

  void build() {
    device_ = rtcNewDevice(nullptr);
    embree_ = rtcNewScene(device_);
    rtcSetSceneFlags(embree_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * triangles_.size()));
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles_.size()));
    for (size_t i = 0; i < 3 * triangles_.size(); ++i) {
      corners[i] = unsigned(i);
      const glm::vec3 place(triangles_[i / 3].corners[i % 3] - centre_);
      for (int k = 0; k < 3; ++k) places[3 * i + size_t(k)] = place[k];
    }
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(embree_);
  }

  const Scene& scene_;
  Brdf lobe_;
  std::vector<Triangle> triangles_;
  glm::dvec3 centre_{0};
  double reach_m_ = 0;
  bool shadow_ = false;
  std::map<int, TextureSampler> samplers_;
  RTCDevice device_ = nullptr;
  RTCScene embree_ = nullptr;
};

}  // namespace lightgrid
#endif
