#include "accuracy/area_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "accuracy/oracle_sample.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"

namespace lightgrid::lab {

AreaTruth area_truth(const ViewState& v, SceneOcclusion& occlusion, size_t max_at_edges) {
  constexpr size_t classified = 8192;
  constexpr int places_to_classify = 16;
  const bool casts = std::ranges::any_of(v.scene.lights, &Light::casts_shadow) &&
                     v.plan.settings[setting::shadows] != ShadowMethod::none;
  const AreaOracle oracle(v.scene, v.view, ranges_of(meant_by(v.plan.settings)),
                          {.brdf = v.plan.settings[setting::brdf],
                           .ambient = v.scene.ambient,
                           .base = base_terms(v.scene, v.view, v.plan),
                           .background = background_term(v.scene, v.view, v.plan)},
                          casts ? &occlusion.get(v.plan.settings[setting::shadow_blended]) : nullptr);
  std::vector<uint32_t> all(v.view.grid().values());
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<uint32_t> sample = sample_pixels(all, classified);
  const std::vector<SeenSurfaces> seen = oracle.surfaces_at(sample, places_to_classify);
  std::vector<uint32_t> edges, inside;
  for (size_t i = 0; i < sample.size(); ++i) (seen[i].at_edge() ? edges : inside).push_back(sample[i]);
  const size_t most = affordable_samples(max_at_edges, v.scene);
  std::vector<uint32_t> pixels = sample_pixels(edges, most);
  const std::vector<uint32_t> of_inside = sample_pixels(inside, most / 2);
  pixels.insert(pixels.end(), of_inside.begin(), of_inside.end());
  const std::vector<PixelArea> areas = oracle.at(pixels);
  AreaTruth truth;
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (areas[i].blended || areas[i].undecided) continue;
    truth.pixels.push_back(pixels[i]);
    truth.areas.push_back(areas[i]);
  }
  return truth;
}

namespace {

AreaError::Part part_error(const Image& image, const AreaTruth& truth, bool edges, double brightest,
                           double white) {
  AreaError::Part part;
  double squares = 0, squares_shown = 0, largest = 0;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    if (truth.areas[i].at_edge != edges) continue;
    ++part.pixels;
    for (int c = 0; c < 3; ++c) {
      const double own = image.pixels[truth.pixels[i]][c], expected = truth.areas[i].radiance[c];
      const double apart = std::isnan(own) ? INFINITY : std::abs(own - expected);
      const double shown = std::isnan(own) ? INFINITY : std::min(own, white) - std::min(expected, white);
      squares += apart * apart;
      squares_shown += shown * shown;
      largest = std::max(largest, apart);
    }
  }
  if (part.pixels == 0) return part;
  const auto over = [](double error, double whole) { return error == 0 ? 0 : error / whole; };
  part.max_rel = over(largest, brightest);
  part.rmse_rel = over(std::sqrt(squares / (3.0 * double(part.pixels))), brightest);
  part.rmse_shown = over(std::sqrt(squares_shown / (3.0 * double(part.pixels))), white);
  return part;
}

}  // namespace

AreaError area_error(const Image& image, const AreaTruth& truth, double brightest, double white) {
  return {part_error(image, truth, true, brightest, white),
          part_error(image, truth, false, brightest, white)};
}

}  // namespace lightgrid::lab
