// Area lights (docs/area_lights.md): rectangles. A spot with a width and a height emits from a rectangle
// around its position, as Lambert's law has it; the intensity is that along its direction.
#include <array>

#include "plan/light_plan.h"
#include "renderer/loop_inputs.h"
#include "renderer/pass_context.h"
#include "scene/area_lights.h"
#include "shared/effects/area_lights.h"

namespace lightgrid {
namespace {

using glm::dvec3;

extern const Setting<int> area_points;

const Setting<int> area_points{
    78,
    "area-points",
    "points at which a surface adds up a light's rectangle, for each part of its BRDF",
    {{"16", 4}, {"1", 1}, {"4", 2}, {"9", 3}},
    {.common = true,
     .shown_if_given = true,
     .approximate = [](const Settings& s) { return s[area_points] != 4; },
     .mean = [](Settings& s) { s.reset(area_points); }}};

std::optional<EffectNeed> decide(const Scene& scene, const FramePlan& plan) {
  const auto area =
      std::ranges::find_if(plan.lights.local, [&](int i) { return has_rectangle(scene.lights[size_t(i)]); });
  if (area == plan.lights.local.end()) return EffectNeed{false, "no point or spot light is a rectangle"};
  const Light& light = scene.lights[size_t(*area)];
  return EffectNeed{true, fmt::format("{} is a rectangle of {:g} m x {:g} m", light_witness(scene, *area),
                                      width_of(light), height_of(light))};
}

// Gauss's rule on 0 to 1.
struct Node {
  double position, weight;
};

std::vector<Node> gauss_nodes(int count) {
  std::vector<Node> nodes;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 20; ++step) {  // Newton's, on Legendre's polynomial
      double before = 1, value = x;
      for (int k = 2; k <= count; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
      }
      slope = count * (x * value - before) / (x * x - 1);
      x -= value / slope;
    }
    nodes.push_back({(1 - x) / 2, 1 / ((1 - x * x) * slope * slope)});
  }
  return nodes;
}

// The mean of a function over a rectangle by halving cells until Gauss's rule agrees with that of the halves.
// Nothing of it is the rule of the light loops.
class AdaptiveMean {
 public:
  using Function = std::function<dvec3(double x, double y)>;

  // peaks: places in -1 to 1 around which cells are halved down to `finest` in any case. horizons: (a, b, c)
  // with a + b x + c y = 0 at a horizon, where cells are halved down to 1/64, or a sliver would be missed.
  AdaptiveMean(Function f, std::vector<glm::dvec2> peaks, std::vector<dvec3> horizons, double finest)
      : f_(std::move(f)), peaks_(std::move(peaks)), horizons_(std::move(horizons)), finest_(finest) {
    const Cell all{0, 0, 1};
    const dvec3 first = rule(all);
    scale_ = largest(first);
    value = refined(all, first, 0);
  }

  dvec3 value{0};

 private:
  struct Cell {
    double x, y, half;
  };

  static double largest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

  dvec3 rule(const Cell& cell) const {
    static const std::vector<Node> nodes = gauss_nodes(5);
    dvec3 sum(0);
    for (const Node& i : nodes) {
      for (const Node& j : nodes)
        sum += i.weight * j.weight *
               f_(cell.x + (2 * i.position - 1) * cell.half, cell.y + (2 * j.position - 1) * cell.half);
    }
    return sum * (cell.half * cell.half);
  }

  bool must_be_halved(const Cell& cell) const {
    const auto near = [&](const glm::dvec2& p) {
      return std::max(std::abs(p.x - cell.x), std::abs(p.y - cell.y)) < 1.5 * cell.half;
    };
    const auto crosses = [&](const dvec3& h) {
      return std::abs(h.x + h.y * cell.x + h.z * cell.y) < (std::abs(h.y) + std::abs(h.z)) * cell.half;
    };
    return (cell.half > finest_ && std::ranges::any_of(peaks_, near)) ||
           (cell.half > 1.0 / 64 && std::ranges::any_of(horizons_, crosses));
  }

  dvec3 refined(const Cell& cell, const dvec3& whole, int depth) {
    std::array<Cell, 4> parts;
    std::array<dvec3, 4> values;
    dvec3 sum(0);
    for (size_t i = 0; i < 4; ++i) {
      const double half = cell.half / 2;
      parts[i] = {cell.x + (i & 1 ? half : -half), cell.y + (i & 2 ? half : -half), half};
      sum += values[i] = rule(parts[i]);
    }
    scale_ = std::max(scale_, largest(sum));
    if (depth >= deepest || (!must_be_halved(cell) && largest(sum - whole) <= tolerance * scale_)) return sum;
    sum = dvec3(0);
    for (size_t i = 0; i < 4; ++i) sum += refined(parts[i], values[i], depth + 1);
    scale_ = std::max(scale_, largest(sum));
    return sum;
  }

  static constexpr int deepest = 20;
  static constexpr double tolerance = 1e-6;
  Function f_;
  std::vector<glm::dvec2> peaks_;
  std::vector<dvec3> horizons_;
  double finest_, scale_ = 0;
};

// Where the viewer's ray, mirrored at a normal, meets the rectangle, or the place next to it.
glm::dvec2 mirrored_place(const LightRectangle& r, const dvec3& to_centre, const dvec3& normal,
                          const dvec3& to_eye) {
  const dvec3 ray = 2 * glm::dot(normal, to_eye) * normal - to_eye;
  const double towards = std::max(-glm::dot(ray, r.direction), 1e-6);
  const dvec3 hit = ray * (-glm::dot(to_centre, r.direction) / towards) - to_centre;
  return glm::clamp(glm::dvec2(glm::dot(hit, r.across) / glm::dot(r.across, r.across),
                               glm::dot(hit, r.up) / glm::dot(r.up, r.up)),
                    -1.0, 1.0);
}

dvec3 reflected_light(const LightRectangle& r, const dvec3& from_light, const LitSurface& surface) {
  const double ahead = glm::dot(from_light, r.direction);
  if (!(ahead > 0)) return dvec3(0);
  const dvec3 to_centre = -from_light;
  const auto at = [&](double x, double y) {
    const dvec3 to_light = to_centre + x * r.across + y * r.up;
    const double distance = glm::length(to_light);
    return surface.reflected(to_light / distance) * (ahead / (distance * distance * distance));
  };
  std::vector<glm::dvec2> peaks = {
      glm::clamp(glm::dvec2(glm::dot(from_light, r.across) / glm::dot(r.across, r.across),
                            glm::dot(from_light, r.up) / glm::dot(r.up, r.up)),
                 -1.0, 1.0)};
  std::vector<dvec3> horizons;
  for (const dvec3& normal : surface.normals) {
    peaks.push_back(mirrored_place(r, to_centre, normal, surface.to_eye));
    horizons.emplace_back(glm::dot(normal, to_centre), glm::dot(normal, r.across), glm::dot(normal, r.up));
  }
  // A third of the narrowest lobe, whose alpha is 0.002, at the nearest point.
  const double size = glm::length(r.across) + glm::length(r.up),
               nearest = std::max(ahead, glm::length(from_light) - size);
  return AdaptiveMean(at, peaks, horizons, std::clamp(6e-4 * nearest / size, 1e-6, 1.0)).value;
}

LitTerm term(const Scene&, const Light& light, const LightRanges&, const glm::dmat3& from_world) {
  if (!has_rectangle(light)) return {};
  const LightRectangle world = rectangle_of(light);
  const LightRectangle r{from_world * world.across, from_world * world.up, from_world * world.direction};
  return [r](const dvec3& from_light, const LitSurface& surface) {
    return reflected_light(r, from_light, surface);
  };
}

LOOP_INPUTS(AreaLightsInputs, AREA_LIGHTS_LIT_INPUTS);

class AreaLights : public LightInputs<AreaLightsInputs> {
  void fill(PassContext& work) override {
    const glm::dmat3 from_world(work.view.view_from_world);
    const std::vector<Node> nodes = gauss_nodes(work.plan.settings[area_points]);
    std::vector<glm::vec4> sides(AREA_RULE);
    for (size_t i = 0; i < nodes.size(); ++i)
      sides[i] = {nodes[i].position, nodes[i].weight, nodes.size(), 0};
    const std::vector<glm::vec4> of_lights =
        values_of_lights(work, [&](const Light& light) { return sides_of(light, from_world); });
    sides.insert(sides.end(), of_lights.begin(), of_lights.end());
    inputs_.area_sides.put(*work.renderer.cl, work.plan.opengl, "uploading area lights", sides);
  }

  static std::array<glm::vec4, 3> sides_of(const Light& light, const glm::dmat3& from_world) {
    if (!has_rectangle(light)) return {};
    const LightRectangle r = rectangle_of(light);
    return {glm::vec4(from_world * r.across, 1), glm::vec4(from_world * r.up, 0),
            glm::vec4(from_world * r.direction, 0)};
  }
};

std::unique_ptr<EffectState> make(PassContext&) { return std::make_unique<AreaLights>(); }

}  // namespace

extern constexpr Effect area_lights{
    .name = "area_lights", .decide = decide, .make = make, .lit = LitOracle{term}};

}  // namespace lightgrid
