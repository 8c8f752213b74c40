// Cookies (docs/profiles.md#cookies): images that lights project (scene/light_cookies.h).
#include "scene/light_cookies.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "plan/light_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "shared/effects/light_cookies.h"

namespace lightgrid {
namespace {

const Setting<bool> with_cookies{73,
                                 "light-cookies",
                                 "cookies of lights: images that they project",
                                 {{"on", true}, {"off", false}},
                                 {.model = true, .common = true, .of_lights = true, .shown_if_given = true}};

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan& plan) {
  if (!plan.settings[with_cookies]) return {};
  return need_of_lights(scene, plan, [](const Light& light) { return cookie_of(light) != nullptr; });
}

ReachTerm term(const Scene&, const Light& light, const LightRanges& ranges, const View& view) {
  const SharedTable table = with_cookies.of(ranges) ? cookie_of(light) : nullptr;
  if (!table) return {};
  const glm::dmat3 from_world(view.view_from_world);
  const LightAxes axes = axes_of(light);
  const glm::dvec3 right = from_world * axes.right, up = from_world * axes.up,
                   direction = from_world * axes.direction,
                   position = from_world * (light.position - view.eye);
  return [=, width = pixel_width(view)](const glm::dvec3& p, uint32_t) {
    const double pixel = width < 0 ? -width : width * std::max(-(position.z + p.z), 0.0);
    return cookie_share(cookie_of(*table), light,
                        {glm::dot(right, p), glm::dot(up, p), glm::dot(direction, p)}, pixel);
  };
}

LightShare share(const Scene&, const Light&, const LightRanges&) {
  return {.largest = 1, .of_surface = false};
}

LOOP_INPUTS(LightCookiesInputs, LIGHT_COOKIES_TINT_INPUTS);

// A light's place in cookie_words is a float there.
constexpr size_t max_words = size_t(1) << 24;

// The words of all cookies, one behind the other.
struct CookieWords {
  std::map<SharedTable, size_t> first;
  std::vector<uint32_t> words{0};

  explicit CookieWords(const ViewState& seen) {
    for (const int i : seen.plan.lights.local) {
      const SharedTable table = cookie_of(seen.scene.lights[size_t(i)]);
      if (!table || first.contains(table)) continue;
      first[table] = words.size();
      const std::span<const uint32_t> own = cookie_of(*table).words;
      words.insert(words.end(), own.begin(), own.end());
    }
    if (words.size() > max_words)
      throw input_error("{} cookies take {} texels; at most {} fit", first.size(), words.size(), max_words);
  }
};

class LightCookies : public LightInputs<LightCookiesInputs> {
  void fill(PassContext& work) override {
    const CookieWords words(work);
    put(work, inputs_.cookie_lights, values_of_lights(work, [&](const Light& light) {
          return values_of(light, cookie_of(light), words, work.view);
        }));
    if (words.words != uploaded_) put(work, inputs_.cookie_words, words.words);
    uploaded_ = words.words;
  }

  static std::array<glm::vec4, 4> values_of(const Light& light, const SharedTable& table,
                                            const CookieWords& words, const View& view) {
    if (!table) return {glm::vec4(0, 0, 0, -1), {}, {}, {}};
    const Cookie cookie = cookie_of(*table);
    const glm::dmat3 from_world(view.view_from_world);
    const LightAxes axes = axes_of(light);
    const bool projects = is_projector(light);
    const double half = projects ? 0.5 / std::tan(double(light.outer_cone_rad)) : 1;
    const double texels = projects ? half * std::max(cookie.width, cookie.height) : 1;
    return {glm::vec4(from_world * axes.right * half, words.first.at(table)),
            glm::vec4(from_world * axes.up * half, cookie.width),
            glm::vec4(from_world * axes.direction, projects ? double(cookie.height) : -double(cookie.height)),
            glm::vec4(from_world * (light.position - view.eye), texels * pixel_width(view))};
  }

  template <typename Value>
  static void put(PassContext& work, ColumnInput& to, const std::vector<Value>& values) {
    to.put(*work.renderer.cl, work.plan.opengl, "uploading cookies", values);
  }

  std::vector<uint32_t> uploaded_;
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<LightCookies>(); }

}  // namespace

extern constexpr Effect light_cookies{
    .name = "light_cookies", .decide = decide, .make = make, .reach = ReachOracle{term, share}};

}  // namespace lightgrid
