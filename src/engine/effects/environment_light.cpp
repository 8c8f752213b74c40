// Light from surroundings (docs/environment.md). Its tables are uploaded once, and its axes follow the camera.
#include "scene/environment_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "plan/settings/model.h"
#include "plan/surface_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "scene/surface.h"
#include "shared/effects/environment_light.h"

namespace lightgrid {
namespace {

using glm::dvec3;

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan&) {
  if (!scene.environment) return {};
  const auto lit = std::ranges::find_if(scene.instances, [&](const Instance& i) {
    return !scene.materials[size_t(scene.meshes[size_t(i.mesh)].material)].unlit;
  });
  const std::string on = lit == scene.instances.end()
                             ? "behind the scene"
                             : "on " + instance_witness(scene, int(lit - scene.instances.begin()));
  return EffectNeed{true, scene.environment->name + ' ' + on};
}

// In double. Of a lobe with this cosine to the viewer: shared/light_moments.h, lobe_albedo.
glm::dvec2 albedo_of(double perceptual_roughness, double n_dot_v) {
  const double a = perceptual_roughness * perceptual_roughness, v = std::min(n_dot_v, 1.0);
  const double both = 1 + a * (-1.0567 + v * (1.2844 - 0.135 * v)) +
                      a * a * (2.515 + v * (-7.5007 + 3.0227 * v)) +
                      a * a * a * (-1.6123 + v * (5.1581 - 2.3452 * v));
  const double rim = std::pow(1 - v, 5) / (1 + a * (8 + 20 * a));
  return {both - rim, rim};
}

double irradiance_of(const std::array<double, 9>& m, const dvec3& n) {
  const double trace = m[3] + m[4] + m[5];
  const double first = n.x * m[0] + n.y * m[1] + n.z * m[2];
  const double second = n.x * n.x * m[3] + n.y * n.y * m[4] + n.z * n.z * m[5] +
                        2 * (n.x * n.y * m[6] + n.x * n.z * m[7] + n.y * n.z * m[8]);
  return std::max(0.0, 3.0 / 32 * trace + 0.5 * first + 15.0 / 32 * second);
}

// What a surface reflects, in double. Directions are along the axes of the view.
class ReflectedInDouble {
 public:
  ReflectedInDouble(const Environment& environment, const View& view, Brdf brdf)
      : environment_(environment),
        world_from_view_(glm::transpose(glm::dmat3(view.view_from_world))),
        orthographic_(view.orthographic),
        brdf_(brdf) {}

  dvec3 of(const Surface& s, const dvec3& position) const {
    const dvec3 to_eye = orthographic_ ? dvec3(0, 0, 1) : glm::normalize(-position);
    const double n_dot_v = std::max(glm::dot(s.normal, to_eye), 1e-4);
    dvec3 back = diffuse(s, to_eye, n_dot_v);
    if (brdf_ != Brdf::lambert) {
      const double roughness = std::max(s.roughness, 0.045);
      const glm::dvec2 albedo = albedo_of(roughness, n_dot_v);
      const dvec3 f0 = glm::mix(s.f0, s.base_color, s.metallic);
      const double f90 = glm::mix(s.f90, 1.0, s.metallic);
      back += (f0 * albedo.x + f90 * albedo.y) * received(s.normal, to_eye, roughness);
      if (s.coat > 0) back = under_coat(s, to_eye, back);
    }
    return s.occlusion * back;
  }

 private:
  dvec3 diffuse(const Surface& s, const dvec3& to_eye, double n_dot_v) const {
    const dvec3 n = world_from_view_ * s.normal;
    dvec3 irradiance(0), all_sides(0);
    for (int c = 0; c < 3; ++c) {
      const auto& m = environment_.moments[size_t(c)];
      irradiance[c] = irradiance_of(m, n);
      all_sides[c] = (m[3] + m[4] + m[5]) / (4 * std::numbers::pi);
    }
    double part = 2 / (s.minnaert_k + 1) *
                  std::pow(std::clamp(glm::dot(s.normal, to_eye), 1.0 / 16, 1.0), 1 - s.minnaert_k);
    if (brdf_ != Brdf::lambert) {
      const double grazing = std::max(1 - n_dot_v, 0.0);
      const double facing = 1 - 0.014 * grazing * grazing * (1 + grazing);
      part *= (1 - s.metallic) *
              (facing * std::max(s.f90 - std::max({s.f0.r, s.f0.g, s.f0.b}), 0.0) + (1 - s.f90));
    }
    return s.base_color * (part / std::numbers::pi) * irradiance +
           s.subsurface_color * s.roll_off * all_sides;
  }

  dvec3 received(const dvec3& normal, const dvec3& to_eye, double roughness) const {
    const dvec3 mirrored = 2 * glm::dot(normal, to_eye) * normal - to_eye;
    const dvec3 middle = glm::mix(normal, mirrored, 1 - roughness * roughness);
    return lobe_radiance(environment_, glm::normalize(world_from_view_ * middle), roughness);
  }

  dvec3 under_coat(const Surface& s, const dvec3& to_eye, const dvec3& base) const {
    const double n_dot_v = std::max(glm::dot(s.coat_normal, to_eye), 1e-4);
    const double roughness = std::max(s.coat_roughness, 0.045);
    const glm::dvec2 albedo = albedo_of(roughness, n_dot_v);
    const double share = s.coat * (0.04 + 0.96 * std::pow(std::max(1 - n_dot_v, 0.0), 5));
    return glm::mix(base, (albedo.x + albedo.y) * received(s.coat_normal, to_eye, roughness), share);
  }

  const Environment& environment_;
  const glm::dmat3 world_from_view_;
  const bool orthographic_;
  const Brdf brdf_;
};

BaseTerm term(const Scene& scene, const View& view, const Settings& settings) {
  return [environment = scene.environment,
          reflected = ReflectedInDouble(*scene.environment, view, settings[setting::brdf])](
             const Surface& surface, const dvec3& position) { return reflected.of(surface, position); };
}

BackgroundTerm background(const Scene& scene, const View& view) {
  return [environment = scene.environment,
          world_from_view = glm::transpose(glm::dmat3(view.view_from_world))](const dvec3& direction) {
    return background_radiance(*environment, world_from_view * direction);
  };
}

LOOP_INPUTS(EnvironmentLightInputs, ENVIRONMENT_LIGHT_BASE_INPUTS);

std::vector<float> numbers_of_tables(const Environment& environment) {
  std::vector<float> numbers;
  size_t first = 2 * environment.tables.size();
  for (const EnvironmentTable& table : environment.tables) {
    numbers.insert(numbers.end(), {float(table.cells), float(first)});
    first += 3 * table.texels.size();
  }
  for (const EnvironmentTable& table : environment.tables) {
    for (const dvec3& texel : table.texels)
      numbers.insert(numbers.end(), {float(texel.r), float(texel.g), float(texel.b)});
  }
  return numbers;
}

EnvironmentParams params_of(const Environment& environment, const View& view) {
  std::vector<float> numbers;
  for (int axis = 0; axis < 3; ++axis) {
    for (int from = 0; from < 3; ++from) numbers.push_back(float(view.view_from_world[axis][from]));
  }
  for (const auto& color : environment.moments) numbers.insert(numbers.end(), color.begin(), color.end());
  EnvironmentParams params;
  std::memcpy(&params, numbers.data(), sizeof params);
  return params;
}

class EnvironmentLight : public EffectState {
 public:
  bool follow(PassContext& work) override {
    placed_ = false;
    return work.scene.environment == uploaded_ || !uploaded_;
  }

  void before_lights(PassContext& work) override {
    const Environment& environment = *work.scene.environment;
    if (!uploaded_) {
      inputs_.environment_tables.put(*work.renderer.cl, work.plan.opengl, "uploading the environment",
                                     numbers_of_tables(environment));
      uploaded_ = work.scene.environment;
    }
    if (!placed_)
      inputs_.environment_params.put(*work.renderer.cl, work.plan.opengl, "placing the environment",
                                     params_of(environment, work.view));
    placed_ = true;
  }

  void bind() const override { inputs_.bind(); }
  ClArguments base_arguments() override { return inputs_.arguments(); }
  size_t memory_bytes() const override { return inputs_.bytes(); }

 private:
  EnvironmentLightInputs inputs_;
  std::shared_ptr<const Environment> uploaded_;
  bool placed_ = false;
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<EnvironmentLight>(); }

}  // namespace

extern constexpr Effect environment_light{.name = "environment_light",
                                          .decide = decide,
                                          .make = make,
                                          .base = BaseOracle{.term = term},
                                          .background = BackgroundOracle{background}};

}  // namespace lightgrid
