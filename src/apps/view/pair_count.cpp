#include "view/pair_count.h"

#include <algorithm>
#include <chrono>

#include "accuracy/oracle.h"
#include "accuracy/shadow_truth.h"
#include "oracle/position.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"

namespace lightgrid::app {
using namespace lab;

ListedFrame read_listed_frame(TechniqueRun& run) {
  const RenderView& v = run.view();
  const Settings& settings = v.plan.settings;
  ListedFrame listed{{v.scene.name, v.view, settings[setting::tile], v.plan.lists.far_m,
                      lights_with_ranges(v.scene, ranges_of(settings)), read_depth(run)},
                     local_lights(v),
                     {}};
  listed.lists = listed_lights(run, listed.frame.depth);
  return listed;
}

// Directional lights are listed everywhere, after all others, as shadows have them.
void PairCount::count_light_alone(Job& job, const TechniqueRun& run) {
  const ViewState& v = run.view();
  const int light = *job.choice.light;
  const auto kept = std::ranges::find(job.places, light);
  const bool directional = kept == job.places.end();
  if (directional) {
    const auto& all = v.plan.lights.directional;
    const auto place = std::ranges::find(all, light);
    for (const int i : std::span(all.begin(), place + (place != all.end()))) job.places.push_back(i);
    job.listed.lights = lights_in_view(v.scene, v.view, ranges_of(v.plan.settings), job.places);
  }
  const auto index = uint32_t(directional ? job.places.size() - 1 : size_t(kept - job.places.begin()));
  for (size_t i = 0; i < job.listed.lights.size(); ++i) {
    ViewLight& other = job.listed.lights[i];
    if (i != index) {
      other.type = LightType::point;
      other.radius_m = -1;  // it lights nothing
    }
  }
  ListedLights& lists = job.listed.lists;
  if (directional) {
    lists = {.first = {0}, .count = {1}, .indices = {index}};
    return;
  }
  for (size_t cell = 0; cell < lists.count.size(); ++cell) {
    const std::span<const uint32_t> all(lists.indices);
    const auto list = all.subspan(std::min(size_t(lists.first[cell]), all.size())).first(lists.count[cell]);
    const auto found = std::ranges::find(list, index);
    lists.count[cell] = found != list.end();
    if (found != list.end()) lists.first[cell] += uint64_t(found - list.begin());
  }
}

void PairCount::start(TechniqueRun& run, const CountChoice& choice) {
  job_ = std::make_shared<Job>();
  job_->choice = choice;
  job_->listed = read_listed_frame(run);
  job_->places = run.view().plan.lights.local;
  if (choice.light)
    count_light_alone(*job_, run);
  else
    job_->directional = run.view().plan.lights.directional;
  if (choice.shadows) {
    job_->shadows = read_frame_shadows(run);
    job_->tiles =
        std::max(1, int(std::ranges::count_if(job_->shadows->depth, [](float d) { return d > 0; }) / 256));
  }
  running_ = std::async(std::launch::async,
                        [job = job_, &occlusion = occlusion_] { return count(*job, occlusion); });
}

std::optional<LitPairs> PairCount::count(Job& job, SceneOcclusion& occlusion) {
  const CapturedFrame& frame = job.listed.frame;
  std::optional<SeenPairs> seen;
  if (job.shadows) {
    std::lock_guard lock(job.reads_scene);
    if (job.stops) return {};
    const Scene& scene = occlusion.scene();
    CastingLights lights{job.listed.lights, {}};
    const ViewLight everywhere{.type = LightType::directional};
    lights.in_view.insert(lights.in_view.end(), job.directional.size(), everywhere);
    for (const auto* places : {&job.places, &job.directional}) {
      for (const int i : *places) {
        const Light& light = scene.lights[size_t(i)];
        lights.casting.push_back(light.casts_shadow ? &light : nullptr);
      }
    }
    const std::vector<CastingTriangle> triangles = casting_triangles(scene, job.shadows->shown);
    seen.emplace(occlusion.get(job.shadows->by_blended), ShownSurfaces{frame.view, frame.depth, triangles},
                 lights, covered_pixels(frame.depth), true, [&] {
                   ++job.tiles_done;
                   return job.stops.load();
                 });
  }
  if (job.stops) return {};
  std::optional<PairShadows> shadows;
  if (seen)
    shadows.emplace(PairShadows{*seen, job.shadows->shaded ? &*job.shadows->shaded : nullptr,
                                uint32_t(job.directional.size())});
  return count_pairs(frame.view, frame.depth, job.listed.lights, job.listed.lists,
                     shadows ? &*shadows : nullptr);
}

const LitPairs* PairCount::result(const CountChoice& choice, bool wait) {
  if (running()) {
    if (job_->choice != choice) job_->stops = true;
    if (!wait && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
    const bool stopped = job_->stops;
    auto counted = running_.get();
    if (counted && !stopped) {
      done_ = std::move(counted);
      done_choice_ = job_->choice;
    }
  }
  return done_ && done_choice_ == choice ? &*done_ : nullptr;
}

void PairCount::leave_scene() {
  if (!running()) return;
  job_->stops = true;
  std::lock_guard lock(job_->reads_scene);
}

}  // namespace lightgrid::app
