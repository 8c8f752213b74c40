#include "view/listed.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "capture/frame_culler.h"
#include "reference/position.h"
#include "scene/view_lights.h"
#include "session/oracle.h"

namespace lightgrid {

ListedFrame read_listed_frame(TechniqueRun& run) {
  const RenderView& v = run.view();
  const Settings& settings = v.plan.settings;
  ListedFrame listed{{v.scene.name, v.view, settings.tile, v.plan.slice_far_m,
                      lights_with_ranges(v.scene, settings.ranges), read_depth(run)},
                     local_lights(v),
                     {}};
  listed.lists = listed_lights(run, listed.frame.depth);
  return listed;
}

PixelInspection lights_at(const ListedFrame& listed, PicturePixel pixel) {
  const CapturedFrame& frame = listed.frame;
  const ListedLights& lists = listed.lists;
  PixelInspection result;
  const size_t place = size_t(pixel.y) * frame.view.width + pixel.x;
  result.covered = frame.depth[place] > 0;
  if (!result.covered) return result;
  const glm::dvec3 position = position_from_depth(frame.view, pixel.x, pixel.y, frame.depth[place]);
  result.distance_m = -position.z;
  const uint32_t cell = lists.cell_of_pixel.empty() ? 0 : lists.cell_of_pixel[place];
  const auto first = lists.indices.begin() + ptrdiff_t(lists.first[cell]);
  const std::set<uint32_t> found(first, first + lists.count[cell]);
  for (uint32_t i = 0, local = 0; i < frame.lights.size(); ++i) {
    if (frame.lights[i].type == LightType::directional) continue;
    const ViewLight& light = listed.lights[local];
    LightVerdict verdict{.index = local, .light = int(i), .radius_m = light.radius_m};
    verdict.listed = found.contains(local++);
    verdict.lit = is_lit(light, position);
    verdict.distance_m = glm::length(light.position - position);
    if (verdict.listed || verdict.lit) result.lights.push_back(verdict);
  }
  const auto rank = [](const LightVerdict& l) { return std::tuple(!l.lit, l.listed, l.distance_m); };
  std::ranges::stable_sort(result.lights, {}, rank);
  return result;
}

std::optional<PixelInspection> inspect_pixel(TechniqueRun& run, const CapturedFrame& frame,
                                             PicturePixel pixel) {
  RenderView& v = run.view();
  if (!v.plan.light_grid) return {};
  const Settings& settings = v.plan.settings;
  FrameCuller culler(*v.renderer.cl, *v.renderer.kernels, frame, settings, run.technique().needs);
  culler.run();
  return inspect_pixel(frame, culler.grid(), culler.intervals(), settings, pixel.x, pixel.y);
}

void add_margins(PixelInspection& lights, const PixelInspection& inspection, int most_dropped) {
  for (const LightVerdict& verdict : inspection.lights) {
    const auto known = std::ranges::find(lights.lights, verdict.light, &LightVerdict::light);
    if (known != lights.lights.end()) {
      known->test = verdict.test;
      known->margin_m = verdict.margin_m;
    } else if (most_dropped-- > 0) {
      lights.lights.push_back(verdict);
      lights.lights.back().listed = lights.lights.back().lit = false;
    }
  }
}

std::array<std::string, 2> lines_of(const LightVerdict& verdict, const Scene& scene) {
  const Light& light = scene.lights[verdict.light];
  const std::string name = light.name.empty() ? fmt::format("light {}", verdict.light) : light.name;
  const char* lost = verdict.lit && !verdict.listed ? " LOST" : "";
  std::string decided;
  if (verdict.test == "empty") {
    decided = "dropped: no surface in its cell";
  } else if (!verdict.test.empty()) {
    decided = fmt::format("{} by {} {:+.3f} m", verdict.listed ? "kept" : "dropped", verdict.test,
                          verdict.margin_m);
  }
  return {fmt::format("{} {:.2f} of {:.2f} m{}", name, verdict.distance_m, verdict.radius_m, lost), decided};
}

void ListedCount::start(ListedFrame frame, size_t picture) {
  picture_ = picture;
  running_ = std::async(std::launch::async, [frame = std::move(frame)] {
    return count_pairs(frame.frame.view, frame.frame.depth, frame.lights, frame.lists);
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
