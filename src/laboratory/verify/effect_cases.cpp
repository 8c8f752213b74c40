#include "verify/effect_cases.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "accuracy/oracle_sample.h"
#include "accuracy/surfaces_in_double.h"
#include "base/error.h"
#include "measures/metrics.h"
#include "oracle/attenuation.h"
#include "run/frames.h"
#include "scene/lights_file.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {
namespace {

using glm::dvec3;

void add_surface(Scene& scene, Mesh mesh, const char* name, const glm::dmat4& world_from_object) {
  const int material = int(scene.materials.size());
  add_material(scene, name, {0.7f, 0.6f, 0.5f}, material == ball ? 1.0f : 0.0f,
               material == ball ? 0.3f : 0.8f);
  add_instance(scene, name, add_mesh(scene, shapes::finished(std::move(mesh), name, material)),
               world_from_object);
}

Scene stage() {
  Scene scene;
  Mesh of_wall, of_ball, of_box;
  shapes::add_quad(of_wall, {-1.8f, -2, -4}, {4, 0, 0}, {0, 4, 0}, 2, 2);
  add_surface(scene, std::move(of_wall), "wall", glm::dmat4(1));
  shapes::add_sphere(of_ball, {0, 0, 0}, 0.7f, 6);
  add_surface(scene, std::move(of_ball), "ball", glm::translate(glm::dmat4(1), dvec3(0.3, -0.2, -3)));
  shapes::add_box(of_box, {0, 0, 0}, {1, 1, 1});
  glm::dmat4 sheared(1);
  sheared[0] = {-0.5, 0.1, 0, 0};
  sheared[1] = {0.2, 0.6, 0.1, 0};
  sheared[2] = {0, 0, 0.3, 0};
  sheared[3] = {-1, -1.1, -3.4, 1};
  add_surface(scene, std::move(of_box), "box", sheared);
  scene.ambient = glm::vec3(0.01f);
  return scene;
}

// Throws Error if the row's lights are refused.
Scene scene_of(const EffectRow& row) {
  Scene scene = stage();
  nlohmann::json lights = nlohmann::json::array();
  for (const std::string& fields : row.lights) {
    lights.push_back(nlohmann::json::parse(lamp));
    lights.back().update(nlohmann::json::parse("{" + fields + "}"));
  }
  read_lights(scene, nlohmann::json{{"lights", lights}}.dump(), "lights.json");
  if (row.change) row.change(scene);
  return scene;
}

bool plans(const TechniqueRun& run, std::string_view effect) {
  return std::ranges::any_of(run.view().plan.effects, [&](const Effect* e) { return e->name == effect; });
}

std::vector<uint32_t> covered_by(const std::vector<SceneTriangle>& shown) {
  std::vector<uint32_t> pixels;
  for (uint32_t i = 0; i < shown.size(); ++i)
    if (shown[i].instance >= 0) pixels.push_back(i);
  return pixels;
}

// The light beyond ranges that each sample of the volume of far light stores, against sums in double.
void holds_far_light(Check& c, TechniqueRun& run) {
  const ReadFarLight read = read_far_light(run.view());
  const FarGrid& g = read.grid;
  const size_t samples = size_t(g.size_x) * g.size_y * g.size_z;
  View along;
  along.view_from_world = glm::dmat4(1);
  along.eye = read.origin;
  const ViewState& v = run.view();
  const std::vector<ViewLight> lights = lights_in_view(v.scene, along, ranges_of(v.plan.settings));
  double largest = 0, apart = 0;
  for (size_t i = 0; i < samples; ++i) {
    const dvec3 at = dvec3(g.first_x, g.first_y, g.first_z) +
                     dvec3(i % g.size_x, i / g.size_x % g.size_y, i / g.size_x / g.size_y) *
                         dvec3(g.spacing_x, g.spacing_y, g.spacing_z);
    double sums[3][9] = {};
    for (const ViewLight& light : lights) {
      if (light.share.of_surface || is_directional(light)) continue;
      const dvec3 l = glm::normalize(light.position - at);
      const double beyond = attenuation(light, at, false) - attenuation(light, at, true);
      const double of[9] = {l.x, l.y, l.z, l.x * l.x, l.y * l.y, l.z * l.z, l.x * l.y, l.x * l.z, l.y * l.z};
      for (int color = 0; color < 3; ++color)
        for (int k = 0; k < 9; ++k) sums[color][k] += beyond * light.radiant_intensity[color] * of[k];
    }
    for (int color = 0; color < 3; ++color) {
      for (int k = 0; k < 9; ++k) {
        const size_t plane = k == 8 ? 6 : size_t(2 * color + k / 4);
        const double is = read.moments[plane * samples + i][k == 8 ? color : k % 4];
        largest = std::max(largest, std::abs(sums[color][k]));
        apart = std::max(apart, std::isnan(is) ? 1e300 : std::abs(is - sums[color][k]));
      }
    }
  }
  c.that(apart <= 1e-5 * largest, "{}: samples of far light differ by {:.2g} of the largest",
         run.technique().name, apart / largest);
}

class EffectCase {
 public:
  EffectCase(Check& c, const EffectRows& group, const EffectRow& row) : c_(c), group_(group), row_(row) {}

  void run() {
    try {
      draw(scene_of(row_));
      c_.that(!row_.refused, "is not refused");
    } catch (const Error& error) {
      if (!row_.refused) throw;
      const std::string words = error.what();
      c_.that(words.find(row_.refused) != std::string::npos, "is refused with \"{}\"", words);
    }
  }

 private:
  void draw(const Scene& scene) {
    const View view = make_view(choose_camera(scene, row_.camera), 48, 32);
    const Settings settings = settings_with(std::string(group_.settings) + " " + row_.settings);
    const auto forward = run_of(scene, "forward", view, settings);
    if (forward) {
      forward->run_frame();
      const SurfaceOracle oracle(forward->view(), read_depth(*forward));
      const std::vector<uint32_t> pixels = oracle.decided(oracle.pixels());
      const std::vector<dvec3> radiance = oracle.shade(pixels, true);
      hold_opengl(*forward, *forward, pixels, radiance);
      const auto deferred = run_of(scene, "deferred_tiled", view, settings);
      deferred->run_frame();
      hold_opengl(*deferred, *forward, pixels, radiance);
      decided_ = pixels;
    }
    const auto visibility = run_of(scene, "visibility", view, settings);
    if (!visibility) return c_.skip("the engine draws no pictures");
    visibility->run_frame();
    hold_opencl(*visibility);
  }

  std::shared_ptr<TechniqueRun> run_of(const Scene& scene, const char* technique, const View& view,
                                       const Settings& settings) {
    return c_.engine.run_of(scene, technique, view, settings);
  }

  void hold_opengl(TechniqueRun& run, TechniqueRun& forward, const std::vector<uint32_t>& pixels,
                   const std::vector<dvec3>& radiance) {
    hold_lists(run);
    if (is_far_light()) return;
    const double error = oracle_error(run.image(), forward.image(), pixels, radiance).max_rel;
    c_.that(error <= (row_.error > 0 ? row_.error : group_.opengl), "{}: an error of {:.2g}",
            run.technique().name, error);
  }

  void hold_opencl(TechniqueRun& run) {
    hold_lists(run);
    if (is_far_light()) return row_.is_planned ? holds_far_light(c_, run) : void();
    const std::vector<SceneTriangle> shown = shown_triangles(run);
    const SurfacesInDouble in_double =
        surfaces_in_double(run.view(), shown, decided_.empty() ? covered_by(shown) : decided_);
    const SurfacesError error = surfaces_error(run.image(), in_double, brightest_channel(run.image()));
    c_.that(error.pixels > 150 && error.p99_rel <= (row_.error > 0 ? row_.error : group_.opencl),
            "{}: an error of {:.2g} at {} pixels", run.technique().name, error.p99_rel, error.pixels);
  }

  // The picture is finite, the effect is planned as the row says, and no list loses a light.
  void hold_lists(TechniqueRun& run) {
    const char* name = run.technique().name;
    c_.that(count_nan_pixels(run.image()) == 0, "{}: NaN in the picture", name);
    c_.that(plans(run, group_.effect) == row_.is_planned, "{}: the plan has {}the effect", name,
            row_.is_planned ? "not " : "");
    const LitPairs pairs = count_listed_pairs(run, read_depth(run));
    c_.trials(pairs.listed + pairs.lit);
    c_.contacts(pairs.lit);
    if (pairs.lost > 0) c_.lost_pairs(pairs.lost, "{}: {} of {} pairs", name, pairs.lost, pairs.lit);
    c_.that(pairs.wrong == 0, "{}: {} entries are no light or listed twice", name, pairs.wrong);
  }

  // Its picture is approximate by design, so that its volume is compared.
  bool is_far_light() const { return std::string_view(group_.effect) == "far_light"; }

  Check& c_;
  const EffectRows& group_;
  const EffectRow& row_;
  std::vector<uint32_t> decided_;
};

}  // namespace

std::vector<CaseRun> effect_cases() {
  std::vector<CaseRun> runs;
  for (const EffectRows& group : effect_rows()) {
    for (const EffectRow& row : group.rows)
      runs.push_back({row.name, [&group, &row](Check& c) { EffectCase(c, group, row).run(); }});
  }
  return runs;
}

}  // namespace lightgrid::lab::verify
