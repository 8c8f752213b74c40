#include "view/side_map.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "capture/frame_culler.h"
#include "passes/read_back.h"
#include "reference/position.h"
#include "scene/view_lights.h"
#include "session/oracle.h"
#include "session/runs.h"

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

void MapOfSide::show_counts(SideMap wanted, Side& side, bool wait) {
  const size_t picture = side.pictures();
  const LitPairs* pairs = count_.result(picture, wait);
  if (!pairs && !count_.running()) {
    count_.start(read_listed_frame(side.run()), picture);
    pairs = count_.result(picture, wait);
  }
  if (!pairs) return;
  const auto& counts = wanted == SideMap::listed ? pairs->listed_of_pixel
                       : wanted == SideMap::lit  ? pairs->lit_of_pixel
                                                 : pairs->lost_of_pixel;
  const uint32_t top = wanted == SideMap::lost ? 1 : top_of_scale(counts);
  legend_ = fmt::format("lights {} a pixel; {} pairs listed, {} lit, {} lost", map_names()[int(wanted)],
                        pairs->listed, pairs->lit, pairs->lost);
  scale_ = {&viridis_ramp(), top > 1 ? "1" : "", top > 3 ? fmt::format("{}", top / 2) : "",
            fmt::format("{} or more", top)};
  put(heat_map(side.width(), side.height(), counts, top), wanted, side);
}

void MapOfSide::show_difference(Side& side, const Image& reference) {
  Image image;
  RenderView& v = side.run().view();
  read_back(v, side.run().frame().image, image);
  const ImageError error = compare_images(image, reference);
  legend_ =
      fmt::format("difference from forward over its brightest: black equal, greatest {:.2g}", error.max_rel);
  scale_ = {&difference_ramp(), "1e-7", "3e-4", "1"};
  put(difference_image(image, reference), SideMap::difference, side);
}

void MapOfSide::put(const Image& image, SideMap map, const Side& side) {
  if (image.width != width_ || image.height != height_) {
    width_ = image.width;
    height_ = image.height;
    texture_ = make_texture_2d(GL_RGBA32F, width_, height_);
  }
  glTextureSubImage2D(texture_.name(), 0, 0, 0, width_, height_, GL_RGBA, GL_FLOAT, image.pixels.data());
  shown_ = map;
  shown_picture_ = side.pictures();
}

const Image& ReferencePicture::draw(const View& view, const Settings& settings) {
  if (run_ && same_model(model_, settings)) {
    run_->look(view);
  } else {
    model_ = with_model({}, settings);
    const EveryLight forward = every_light_technique(renderer_);
    run_ = std::make_unique<TechniqueRun>(renderer_, gpu_, view, model_, *forward.technique);
  }
  run_->run_frame(true);
  return run_->image();
}

}  // namespace lightgrid
