#include "accuracy/shadow_truth.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "oracle/lit_set.h"
#include "oracle/position.h"
#include "oracle/shading.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"

namespace lightgrid::lab {
namespace {

// At most as many of the covered pixels as have `most` pairs of lights that cast, by an estimate.
std::vector<uint32_t> affordable_pixels(const ShownSurfaces& shown, const CastingLights& lights,
                                        uint64_t most) {
  constexpr size_t estimated = 4096;
  const std::vector<uint32_t> covered = covered_pixels(shown.depth),
                              sample = sample_pixels(covered, estimated);
  std::vector<float> depth(shown.depth.size());
  for (const uint32_t p : sample) depth[p] = shown.depth[p];
  std::vector<ViewLight> casting;
  for (size_t i = 0; i < lights.casting.size(); ++i) {
    if (lights.casting[i]) casting.push_back(lights.in_view[i]);
  }
  const uint64_t pairs = count_pairs(shown.view, depth, casting, list_every_light(0)).lit;
  if (pairs * covered.size() <= most * sample.size()) return covered;
  return sample_pixels(covered, std::max<size_t>(1, size_t(most * sample.size() / pairs)));
}

}  // namespace

std::vector<CastingTriangle> casting_triangles(const Scene& scene, const std::vector<SceneTriangle>& shown) {
  std::map<int, TriangleNumbers> of_mesh;
  std::vector<CastingTriangle> found;
  for (const SceneTriangle& triangle : shown) {
    found.emplace_back();
    if (triangle.instance < 0) continue;
    const int mesh = scene.instances[size_t(triangle.instance)].mesh;
    const TriangleNumbers& numbers = of_mesh.try_emplace(mesh, scene.meshes[size_t(mesh)]).first->second;
    if (const auto number = numbers.find(triangle.vertices)) found.back() = {triangle.instance, *number};
  }
  return found;
}

CastingLights casting_lights(const Scene& scene, const View& view, const LightRanges& ranges,
                             const std::vector<int>& places) {
  CastingLights lights{lights_in_view(scene, view, ranges, places), {}};
  for (const int i : places) {
    const Light& light = scene.lights[size_t(i)];
    lights.casting.push_back(light.casts_shadow ? &light : nullptr);
  }
  return lights;
}

bool ShadowTruth::casts() const { return std::ranges::any_of(scene_.lights, &Light::casts_shadow); }

const SeenPairs* ShadowTruth::pairs(const ViewState& v, const std::vector<float>& depth,
                                    const std::vector<SceneTriangle>& triangles) {
  if (!casts()) return nullptr;
  const Model model = model_of(v);
  for (const Decided& d : decided_) {
    if (d.pairs && d.model == model && d.depth == depth && d.triangles == triangles) return d.pairs.get();
  }
  const std::vector<CastingTriangle> casting = casting_triangles(scene_, triangles);
  std::vector<int> places = v.plan.lights.local;
  places.insert(places.end(), v.plan.lights.directional.begin(), v.plan.lights.directional.end());
  const CastingLights lights = casting_lights(scene_, v.view, model.ranges, places);
  const ShownSurfaces shown{v.view, depth, casting};
  Decided& d = decided_[next_];
  next_ = 1 - next_;
  d = {model, depth, triangles,
       std::make_unique<SeenPairs>(occlusion_->get(model.by_blended), shown, lights,
                                   affordable_pixels(shown, lights, max_pairs_))};
  return d.pairs.get();
}

std::unique_ptr<SeenPairs> ShadowTruth::at_pixels(const ViewState& v, const std::vector<float>& depth,
                                                  const std::vector<CastingTriangle>& triangles,
                                                  const std::vector<uint32_t>& pixels, bool in_range) {
  if (!casts()) return nullptr;
  std::vector<int> all(scene_.lights.size());
  std::iota(all.begin(), all.end(), 0);
  const CastingLights lights = casting_lights(scene_, v.view, ranges_of(v.plan.settings), all);
  return std::make_unique<SeenPairs>(occlusion_->get(v.plan.settings[setting::shadow_blended]),
                                     ShownSurfaces{v.view, depth, triangles}, lights, pixels, in_range);
}

const SeenPairs* ShadowTruth::of_layer(const ViewState& v, const HostShadowLayer& layer) {
  if (!casts()) return nullptr;
  const Model model = model_of(v);
  for (const DecidedLayer& d : layers_) {
    if (d.model == model && d.depth == layer.depth && d.triangles == layer.triangles) return d.pairs.get();
  }
  std::vector<CastingTriangle> triangles;
  for (const glm::ivec2& t : layer.triangles) triangles.push_back({t.x, uint32_t(t.y)});
  const CastingLights lights = casting_lights(scene_, v.view, model.ranges, v.plan.lights.local);
  const ShownSurfaces shown{v.view, layer.depth, triangles};
  if (layers_.size() >= max_layers) layers_.clear();
  layers_.push_back({model, layer.depth, layer.triangles,
                     std::make_unique<SeenPairs>(occlusion_->get(model.by_blended), shown, lights,
                                                 affordable_pixels(shown, lights, max_pairs_))});
  return layers_.back().pairs.get();
}

void ShadowTruth::moved(bool geometry) {
  for (Decided& d : decided_) d = {};
  layers_.clear();
  if (geometry) occlusion_->scene_moved();
}

}  // namespace lightgrid::lab
