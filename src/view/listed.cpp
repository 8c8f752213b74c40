#include "view/listed.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "capture/frame_culler.h"
#include "session/oracle.h"
#include "reference/position.h"
#include "scene/view_lights.h"

namespace lightgrid {

ListedFrame read_listed_frame(TechniqueRun& run) {
  RenderView& v = run.view();
  ListedFrame frame;
  frame.view = v.view;
  frame.depth = read_depth(run);
  frame.lists = listed_lights(run, frame.depth);
  const std::vector<ViewLight> all = lights_in_view(v.scene, v.view, v.plan.settings.ranges);
  for (const int light : v.plan.local) {
    frame.lights.push_back(all[light]);
    frame.scene_lights.push_back(light);
  }
  return frame;
}

PixelLights lights_at(const ListedFrame& frame, const Scene& scene, PicturePixel pixel) {
  PixelLights result;
  const size_t place = size_t(pixel.y) * frame.view.width + pixel.x;
  const float depth = frame.depth[place];
  result.covered = depth > 0;
  if (!result.covered) return result;
  const glm::dvec3 position = position_from_depth(frame.view, pixel.x, pixel.y, depth);
  result.distance_m = -position.z;
  const uint32_t cell = frame.lists.cell_of_pixel.empty() ? 0 : frame.lists.cell_of_pixel[place];
  const auto first = frame.lists.indices.begin() + ptrdiff_t(frame.lists.first[cell]);
  const std::set<uint32_t> listed(first, first + frame.lists.count[cell]);
  const std::vector<uint32_t> lit_indices = lit_lights(frame.lights, position);
  const std::set<uint32_t> lit(lit_indices.begin(), lit_indices.end());
  std::set<uint32_t> either = listed;
  either.insert(lit.begin(), lit.end());
  for (const uint32_t i : either) {
    if (i >= frame.lights.size()) continue;
    const int light = frame.scene_lights[i];
    result.lights.push_back({light, scene.lights[light].name,
                             glm::length(frame.lights[i].position - position), frame.lights[i].radius_m,
                             listed.contains(i), lit.contains(i), "", 0});
  }
  const auto rank = [](const PixelLight& l) { return std::tuple(!l.lit, l.listed, l.distance_m); };
  std::ranges::sort(result.lights,
                    [&](const PixelLight& a, const PixelLight& b) { return rank(a) < rank(b); });
  for (const PixelLight& light : result.lights) {
    result.listed += light.listed;
    result.lit += light.lit;
    result.lost += light.lit && !light.listed;
  }
  return result;
}

std::optional<PixelInspection> inspect_pixel(TechniqueRun& run, const std::vector<float>& depth,
                                             PicturePixel pixel) {
  RenderView& v = run.view();
  if (!v.plan.light_grid) return {};
  const Settings& settings = v.plan.settings;
  const CapturedFrame frame{
      v.scene.name, v.view, settings.tile, v.plan.slice_far_m, lights_with_ranges(v.scene, settings.ranges),
      depth};
  FrameCuller culler(*v.renderer.cl, *v.renderer.kernels, frame, settings, run.technique().needs);
  culler.run();
  return inspect_pixel(frame, culler.grid(), culler.intervals(), settings, pixel.x, pixel.y);
}

void add_margins(PixelLights& lights, const PixelInspection& inspection, const Scene& scene,
                 int most_dropped) {
  for (const LightVerdict& verdict : inspection.lights) {
    const auto known = std::ranges::find(lights.lights, verdict.light, &PixelLight::light);
    if (known != lights.lights.end()) {
      known->test = verdict.test;
      known->margin_m = verdict.margin_m;
    } else if (most_dropped-- > 0) {
      const Light& light = scene.lights[verdict.light];
      lights.lights.push_back({verdict.light, light.name, verdict.distance_m, light.radius_m, false, false,
                               verdict.test, verdict.margin_m});
    }
  }
}

std::array<std::string, 2> lines_of(const PixelLight& light) {
  const std::string name = light.name.empty() ? fmt::format("light {}", light.light) : light.name;
  const char* lost = light.lit && !light.listed ? " LOST" : "";
  std::string decided;
  if (light.test == "empty") {
    decided = "dropped: no surface in its cell";
  } else if (!light.test.empty()) {
    decided =
        fmt::format("{} by {} {:+.3f} m", light.listed ? "kept" : "dropped", light.test, light.margin_m);
  }
  return {fmt::format("{} {:.2f} of {:.2f} m{}", name, light.distance_m, light.radius_m, lost), decided};
}

void ListedCount::start(ListedFrame frame, size_t picture) {
  picture_ = picture;
  running_ = std::async(std::launch::async, [frame = std::move(frame)] {
    return count_pairs(frame.view, frame.depth, frame.lights, frame.lists);
  });
}

const LitPairs* ListedCount::result(size_t picture, bool wait) {
  if (running_.valid()) {
    if (!wait && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
    done_ = running_.get();
    done_picture_ = picture_;
  }
  return done_ && done_picture_ == picture ? &*done_ : nullptr;
}

}  // namespace lightgrid
