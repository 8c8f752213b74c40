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
  const auto has_one = [&](int i) { return cookie_of(scene.lights[size_t(i)]) != nullptr; };
  const auto first = std::ranges::find_if(plan.lights.local, has_one);
  if (first == plan.lights.local.end()) return EffectNeed{false, "no point or spot light has one"};
  return EffectNeed{true,
                    fmt::format("{} has one; {} of {} lights do", light_witness(scene, *first),
                                std::ranges::count_if(plan.lights.local, has_one), plan.lights.local.size())};
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

class LightCookies : public EffectState {
 public:
  bool follow(PassContext&) override {
    followed_ = false;
    return true;
  }

  void before_lights(PassContext& work) override {
    if (followed_) return;
    const CookieWords words(work);
    std::vector<glm::vec4> column;
    for (const std::vector<int>* lights : {&work.plan.lights.local, &work.plan.lights.directional}) {
      for (const int i : *lights) {
        const Light& light = work.scene.lights[size_t(i)];
        const auto values = values_of(light, cookie_of(light), words, work.view);
        column.insert(column.end(), values.begin(), values.end());
      }
    }
    put(work, inputs_.cookie_lights, column);
    if (words.words != uploaded_) put(work, inputs_.cookie_words, words.words);
    uploaded_ = words.words;
    followed_ = true;
  }

  void bind() const override { inputs_.bind(); }
  ClArguments reach_arguments() override { return inputs_.arguments(); }
  size_t memory_bytes() const override { return inputs_.bytes(); }

 private:
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
  static void put(PassContext& work, ColumnInput& to, std::vector<Value> values) {
    if (values.empty()) values.emplace_back(0);
    to.put(*work.renderer.cl, work.plan.opengl, "uploading cookies", values);
  }

  LightCookiesInputs inputs_;
  std::vector<uint32_t> uploaded_;
  bool followed_ = false;
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<LightCookies>(); }

}  // namespace

extern constexpr Effect light_cookies{
    .name = "light_cookies", .decide = decide, .make = make, .reach = ReachOracle{term, share}};

}  // namespace lightgrid
