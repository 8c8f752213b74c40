#include "run/virtual_lights.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "base/error.h"
#include "cl/transfer.h"
#include "effects/effects.h"
#include "passes/rasterize.h"
#include "passes/resolve.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

// All views together have at most this many pixels, and each view is this wide.
constexpr size_t max_pixels = size_t(1) << 21;
constexpr int widest = 256, narrowest = 16;

Settings settings_of_views(Settings s) {
  s.set(setting::shadows, ShadowMethod::none);
  s.set(setting::shadow_threshold, 0);
  s.set(setting::everything_on, false);
  if (s[setting::range] == LightRange::stochastic) s.set(setting::range, LightRange::infinite);
  return s;
}

int side_for(size_t views) {
  int side = widest;
  while (side > narrowest && views * size_t(side) * size_t(side) > max_pixels) side /= 2;
  return side;
}

double near_of(const Scene& scene) {
  const WorldBox box = world_box(scene);
  return box.empty() ? 0.1 : std::clamp(glm::length(box.max - box.min) * 1e-4, 1e-6, 0.1);
}

// Effects that let a part of a light pass: the rest is not reflected.
Effects effects_on_lights() {
  static const std::vector<const Effect*> effects = [] {
    std::vector<const Effect*> found;
    std::ranges::copy_if(all_effects, std::back_inserter(found),
                         [](const Effect* effect) { return effect->reach.has_value(); });
    return found;
  }();
  return effects;
}

}  // namespace

VirtualLights::VirtualLights(Scene& scene, const std::string& device, const Settings& settings,
                             const VirtualLightSettings& choice)
    : scene_(scene),
      settings_(settings_of_views(settings)),
      choice_(choice),
      renderer_(device, GlBackend::none),
      gpu_(renderer_, scene) {}

void VirtualLights::look(const Light& light, uint32_t number, int side, double near_m) {
  for (const View& view : views_from(light, side, near_m)) {
    if (seen_) {
      seen_->look(view);
    } else {
      const TechniqueNeeds needs{
          .effects = effects_on_lights(), .surfaces = {.opengl = false}, .shadows = {.asked_for = false}};
      seen_ = std::make_unique<RenderView>(renderer_, gpu_, view, settings_, needs);
    }
    RenderView& v = *seen_;
    // A lamp's own surface does not hide its light.
    if (std::erase_if(v.plan.surfaces.opaque,
                      [&](int i) { return !scene_.instances[size_t(i)].casts_shadow; }) > 0)
      v.caches.follow(v);
    v.effects.before_lights(v);
    const VisibilityBuffer visible = rasterize(v, v.caches);
    const ReflectedLight reflected = resolve_reflected(v, v.caches.resolver, visible, number);
    const size_t pixels = size_t(side) * size_t(side);
    std::vector<glm::vec4> flux(pixels), places(pixels);
    constexpr const char* what = "reading what a light's view reflects";
    read_buffer(*renderer_.cl, what, reflected.flux->cl_buffer(), flux.data(), pixels * sizeof flux[0]);
    read_buffer(*renderer_.cl, what, reflected.places->cl_buffer(), places.data(), pixels * sizeof flux[0]);
    ReflectedView& of = views_.emplace_back(ReflectedView{view, {}, inherited(light.properties)});
    for (size_t i = 0; i < pixels; ++i)
      of.pixels.push_back({glm::vec3(flux[i]), flux[i].w, glm::vec3(places[i]), places[i].w});
  }
}

void VirtualLights::place() {
  const std::vector<size_t> chosen = reflected_lights(scene_, choice_.from);
  std::vector<Light> own, all;
  for (const size_t i : chosen) own.push_back(scene_.lights[i]);
  std::ranges::copy_if(scene_.lights, std::back_inserter(all), [](const Light& l) { return !l.is_virtual; });
  const double near_m = near_of(scene_);
  views_.clear();
  reflected_ = own.size();
  size_t views = 0;
  for (const Light& light : own) views += views_from(light, narrowest, near_m).size();
  const int side = side_for(views);
  if (views * size_t(side) * size_t(side) > max_pixels) {
    throw input_error(
        "virtual-from: {} lights need {} views of {} x {} pixels, more than {} pixels; reflect "
        "fewer lights",
        own.size(), views, side, side, max_pixels);
  }
  // The views' plans see these lights alone, so that none changes when virtual lights join them.
  std::swap(scene_.lights, own);
  try {
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) look(scene_.lights[i], i, side, near_m);
  } catch (...) {
    std::swap(scene_.lights, own);
    throw;
  }
  if (!scene_.lights.empty()) {
    const std::vector<Light> placed = virtual_lights_of(views_, choice_);
    all.insert(all.end(), placed.begin(), placed.end());
  }
  scene_.lights = std::move(all);
}

SceneChanges VirtualLights::follow(SceneChanges changes) {
  gpu_.update(changes);
  const std::vector<Light> before = scene_.lights;
  place();
  for (size_t i = 0; i < scene_.lights.size(); ++i) {
    Light& light = scene_.lights[i];
    if (!light.is_virtual || i >= before.size()) continue;
    light.casts_shadow = before[i].casts_shadow;
    if (!(light == before[i])) changes.lights.push_back(int(i));
  }
  std::ranges::sort(changes.lights);
  return changes;
}

}  // namespace lightgrid
