#include "frontier/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "base/cpu_clock.h"
#include "base/error.h"
#include "base/text.h"
#include "base/timer.h"
#include "cl/error.h"
#include "compare/contestants.h"
#include "measures/metrics.h"
#include "measures/words.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"
#include "scene/random.h"

namespace lightgrid::lab {
namespace {

struct Star {
  const char* technique;
  const char* settings;  // assignments, split at spaces
  int frames = 1;
};

// After each technique as it is: the rasteriser, a finer volume, the cull tests of two techniques, buffers of
// fewer bits, the capacity of lidr and of engines' lists, lists that are samples; ranges and far light beyond
// them, of one technique of each kind of lists (windows, BRDFs and finer steps on the fastest alone). So few
// that several views of each of the default scenes fit into the default budget: --vary measures further ones.
constexpr Star default_variations[] = {
    {"voxel_lights", "raster=opencl"},
    {"voxel_lights", "raster=opencl voxel-size=128x128x64"},
    {"voxel_lights", "raster=opencl range=cutoff cutoff=0.02"},
    {"voxel_lights", "raster=opencl range=infinite"},
    {"world_grid", "raster=opencl"},
    {"world_grid", "raster=opencl range=cutoff cutoff=0.2"},
    {"world_grid", "raster=opencl range=cutoff cutoff=0.02"},
    {"world_grid", "raster=opencl range=cutoff cutoff=0.001"},
    {"world_grid", "raster=opencl range=infinite"},
    {"world_grid", "raster=opencl far-light=4096"},
    {"world_grid", "raster=opencl range=cutoff cutoff=0.2 far-light=4096"},
    {"forward_plus", "range=cutoff cutoff=0.02"},
    {"forward_plus", "range=infinite"},
    {"forward_plus", "far-light=4096"},
    {"forward_plus", "cull-test=sphere"},
    {"forward_plus", "cull-test=aabb"},
    {"forward_plus", "cull-test=exact"},
    {"deferred_tiled", "buffer-bits=8"},
    {"lidr", "lidr-overlap=4"},
    {"forward_zprepass", "list-cap=8 list-cap-order=brightest"},
    {"clustered", "list-cap=32"},
    {"visibility", "list-cap=64 list-cap-order=distance"},
    {"visibility", "list-cap=8 list-cap-order=sampled"},
    {"visibility", "range=infinite list-cap=16 list-cap-order=tree"},
    {"visibility", "tile=32"},
    {"visibility", "cull-test=sphere"},
    {"visibility", "cull-test=aabb"},
    {"visibility", "cull-test=exact"},
    {"visibility", "brdf=lambert"},
    {"visibility", "window=none"},
    {"visibility", "range=infinite"},
    {"visibility", "range=cutoff cutoff=1"},
    {"visibility", "range=cutoff cutoff=0.5"},
    {"visibility", "range=cutoff cutoff=0.2"},
    {"visibility", "range=cutoff cutoff=0.05"},
    {"visibility", "range=cutoff cutoff=0.02"},
    {"visibility", "range=cutoff cutoff=0.005"},
    {"visibility", "range=cutoff cutoff=0.001"},
    {"visibility", "range=cutoff cutoff=0.0001"},
    {"visibility", "far-light=4096"},
    {"visibility", "range=cutoff cutoff=1 far-light=512"},
    {"visibility", "range=cutoff cutoff=0.5 far-light=4096"},
    {"visibility", "range=cutoff cutoff=0.2 far-light=4096"},
    {"visibility", "range=cutoff cutoff=0.05 far-light=4096"},
    {"visibility", "range=stochastic alpha=1"},
    {"visibility", "range=stochastic alpha=0.1"},
    {"visibility", "range=stochastic alpha=0.1", 16},
    {"visibility", "range=stochastic alpha=0.01"},
};

// The same where lights cast. Ranges and BRDFs are another question, which --vary asks.
constexpr Star shadow_variations[] = {
    {"voxel_lights", "raster=opencl"},
    {"world_grid", "raster=opencl"},
    {"lidr", "lidr-overlap=4"},
    {"forward_plus", "shadow-pick=4"},
    {"forward_plus", "shadows=map"},
    {"forward_plus", "shadows=none"},
    {"visibility", "shadow-pick=1"},
    {"visibility", "shadow-pick=4"},
    {"visibility", "shadow-pick=16"},
    {"visibility", "shadows=map shadow-size=32"},
    {"visibility", "shadows=map shadow-size=64"},
    {"visibility", "shadows=map shadow-size=128"},
    {"visibility", "shadows=map shadow-size=256"},
    {"visibility", "shadows=map shadow-size=512"},
    {"visibility", "shadows=map shadow-bits=16"},
    {"visibility", "shadows=map shadow-bits=24"},
    {"visibility", "shadows=map shadow-filter=pcf3"},
    {"visibility", "shadows=map shadow-filter=pcf5"},
    {"visibility", "shadows=none"},
};

// Besides, where they are spheres: rays for each pixel and light, and for each pixel to places on its lights.
constexpr Star soft_variations[] = {
    {"visibility", "shadow-rays=4"},
    {"visibility", "shadow-rays=16"},
    {"visibility", "shadow-rays=64"},
    {"visibility", "shadow-rays=4 shadow-pick=1"},
    {"visibility", "shadow-rays=4 shadow-pick=4"},
    {"visibility", "shadow-rays=4 shadow-pick=16"},
};

// The points of each of these techniques in families of lights, with the ranges of each; cutoffs of 0.005 and
// 0.0005 are 5 and 16 times the ranges of scattered lights.
constexpr Star family_techniques[] = {{"forward_plus", ""},
                                      {"clustered", ""},
                                      {"deferred_tiled", ""},
                                      {"world_grid", "raster=opencl"},
                                      {"visibility", ""}};
constexpr const char* family_ranges[] = {"", "range=cutoff cutoff=0.005", "range=infinite", "far-light=4096"};
constexpr Star family_variations[] = {
    {"visibility", "range=cutoff cutoff=0.05 far-light=4096"},
    {"visibility", "range=stochastic alpha=0.1"},
    {"visibility", "list-cap=8 list-cap-order=sampled"},
    {"visibility", "range=cutoff cutoff=0.0005"},
    {"visibility", "range=infinite list-cap=64 list-cap-order=tree"},
};

std::vector<std::string> words(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

ChosenPoint point(const Technique& technique, const Settings& settings, int frames) {
  ChosenPoint chosen{{&technique, settings}, frames, ""};
  chosen.label = label_of(chosen.contestant, frames);
  return chosen;
}

// The points of a star that run, with OpenGL or without it.
class StarPoints {
 public:
  StarPoints(const Settings& common, bool opengl) : common_(common), opengl_(opengl) {}

  void add(const Technique& technique, const std::string& assignments, int frames) {
    Settings settings = common_;
    for (const std::string& assignment : words(assignments, ' ')) apply_setting(settings, assignment);
    if (draws_with_opengl(technique.needs, settings) && !opengl_) return;
    points.push_back(point(technique, settings, frames));
  }

  std::vector<ChosenPoint> points;

 private:
  const Settings& common_;
  const bool opengl_;
};

std::vector<ChosenPoint> star(const Settings& common, bool opengl,
                              const std::optional<FrontierTruth>& shadows) {
  StarPoints star(common, opengl);
  for (const Technique* technique : techniques()) star.add(*technique, "", 1);
  const auto add_all = [&](std::span<const Star> variations) {
    for (const Star& s : variations) star.add(find_technique(s.technique), s.settings, s.frames);
  };
  add_all(shadows ? std::span<const Star>(shadow_variations) : default_variations);
  if (shadows && shadows->source_m > 0) add_all(soft_variations);
  return std::move(star.points);
}

int frames_of(const std::string& text) {
  const int frames = parse_number<int>(text).value_or(0);
  if (frames < 1 || frames > 1024) throw input_error("vary frames: {} is not a number from 1 to 1024", text);
  return frames;
}

std::vector<ChosenPoint> named(const std::vector<std::string>& items, const Settings& common) {
  std::vector<ChosenPoint> points;
  for (const Contestant& c : named_contestants(items, common))
    points.push_back(point(*c.technique, c.settings, 1));
  return points;
}

void vary(std::vector<ChosenPoint>& points, const std::vector<ChosenPoint>& around, const std::string& text) {
  const size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const std::vector<std::string> values =
      equals == std::string::npos ? std::vector<std::string>() : words(text.substr(equals + 1), ',');
  if (values.empty()) throw input_error("vary {}: not KEY=VALUE,VALUE,…", text);
  bool read = false;
  for (const std::string& value : values) {
    for (const ChosenPoint& centre : around) {
      const Technique& technique = *centre.contestant.technique;
      Settings settings = centre.contestant.settings;
      if (key == "frames") {
        const int frames = frames_of(value);
        if (!is_random(technique, settings)) continue;
        points.push_back(point(technique, settings, frames));
        read = true;
        continue;
      }
      apply_setting(settings, key + "=" + value);
      if (!reads_setting(technique, key)) continue;
      points.push_back(point(technique, settings, centre.frames));
      read = true;
    }
  }
  if (!read)
    throw input_error("vary {}: no technique reads {}", text,
                      key == "frames" ? "frames without range=stochastic or list-cap-order=sampled" : key);
}

}  // namespace

std::vector<ChosenPoint> chosen_points(const std::vector<std::string>& techniques,
                                       const std::vector<std::string>& varied, const Settings& common,
                                       bool opengl, const std::optional<FrontierTruth>& truth) {
  std::vector<ChosenPoint> points =
      techniques.empty() ? star(common, opengl, truth) : named(techniques, common);
  std::vector<ChosenPoint> around;
  for (const ChosenPoint& p : points) {
    if (!techniques.empty() || p.label == p.contestant.technique->name) around.push_back(p);
  }
  if (techniques.empty() && !varied.empty()) points = around;
  for (const std::string& text : varied) vary(points, around, text);
  std::vector<ChosenPoint> distinct;
  for (ChosenPoint& p : points) {
    if (std::ranges::find(distinct, p.label, &ChosenPoint::label) == distinct.end())
      distinct.push_back(std::move(p));
  }
  return distinct;
}

ChosenPoint baseline_point(const Settings& common, bool opengl, const std::string& text) {
  if (!text.empty()) {
    const std::vector<ChosenPoint> points = named(words(text, ','), common);
    if (points.size() != 1) throw input_error("baseline {}: is {} points, not one", text, points.size());
    return points.front();
  }
  return point(find_technique(opengl ? "forward_plus" : "visibility"), common, 1);
}

std::vector<ChosenPoint> family_points(const Settings& common, bool opengl) {
  StarPoints star(common, opengl);
  for (const Star& s : family_techniques) {
    for (const std::string ranges : family_ranges)
      star.add(find_technique(s.technique), s.settings + (" " + ranges), 1);
  }
  for (const Star& s : family_variations) star.add(find_technique(s.technique), s.settings, s.frames);
  return std::move(star.points);
}

std::string label_of(const Contestant& contestant, int frames) {
  const auto own = settings_of(*contestant.technique, contestant.settings), plain = to_strings(Settings{});
  std::string differing;
  for (const SettingRow& help : setting_rows()) {
    const std::string key = json_key(help.key);
    const auto found = own.find(key);
    const bool given = contestant.settings.given(help);
    if (found == own.end() || (found->second == plain.at(key) && !(given && key == "slices"))) continue;
    differing += (differing.empty() ? "" : ",") + help.key + "=" + found->second;
  }
  if (frames > 1) differing += fmt::format("{}frames={}", differing.empty() ? "" : ",", frames);
  return contestant.technique->name + (differing.empty() ? "" : ":" + differing);
}

ChosenPoint external_point(std::shared_ptr<const ExternalRenderer> renderer) {
  const std::string label = renderer->label();
  return {{}, 1, label, std::move(renderer)};
}

FrontierPoint described(const std::string& scene, const ChosenPoint& point) {
  if (point.external) return {scene, point.external->name, point.external->settings, point.label, 1};
  const Contestant& c = point.contestant;
  return {scene, c.technique->name, settings_of(*c.technique, c.settings), point.label, point.frames};
}

bool adds_light(const ChosenPoint& point) {
  const LightRange range = point.contestant.settings[setting::range];
  return range == LightRange::infinite || range == LightRange::stochastic ||
         !setting_in_force(described("", point).settings, "far_light").empty();
}

void PointRun::attempt(const std::function<void()>& work) {
  if (!refused_.empty()) return;
  if (const std::optional<Error> failure = failure_of(work)) {
    refused_ = failure->what();
    run_.reset();
  }
}

bool times_bytes(const Renderer& renderer) { return !renderer.cl->info().cpu; }

// The mean of several frames is made of floats. Time does not depend on the exposure, but shadow-threshold
// does.
static Settings timed_settings(const Renderer& renderer, const ChosenPoint& point) {
  Settings settings = point.contestant.settings;
  if (!times_bytes(renderer) || point.frames > 1) return settings;
  if (!settings[setting::display_ev] && settings[setting::shadow_threshold] > 0) return settings;
  settings.set(setting::picture, PictureFormat::bytes);
  settings.set(setting::display_ev, settings[setting::display_ev].value_or(0));
  return settings;
}

PointRun::PointRun(Renderer& renderer, GpuScene& gpu, const View& view, const ChosenPoint& point,
                   std::shared_ptr<TargetPool> pool, const ExportedScene* exported)
    : point_(point), view_(view) {
  if (point.external) {
    exported_ = *exported;
    external_ = std::make_unique<ExternalProcess>(point.external->command, point.external->folder,
                                                  point.external->timeout_s);
    return;
  }
  attempt([&] {
    run_ = std::make_unique<TechniqueRun>(renderer, gpu, view, timed_settings(renderer, point),
                                          *point.contestant.technique, std::move(pool));
  });
}

void PointRun::refuse(const std::string& why) {
  refused_ = why;
  run_.reset();
}

bool PointRun::is_random() const {
  return !point_.external && lightgrid::is_random(*point_.contestant.technique, point_.contestant.settings);
}

// Seeds of lists that follow one another complement each other: those of a picture's frames do, but pictures
// are independent.
uint32_t PointRun::seed(int frame) const {
  const Settings& settings = point_.contestant.settings;
  const auto in_a_row = uint32_t(frame_ * point_.frames + frame);
  if (has_random_ranges()) return settings[setting::light_seed] + in_a_row;
  if (numbers_ == NumbersOfFrames::in_a_row) return settings[setting::list_seed] + in_a_row;
  const auto picture = uint32_t(frame_ == 0 ? 0 : Random::mix(uint64_t(frame_)));
  return settings[setting::list_seed] + picture + uint32_t(frame);
}

void PointRun::go_to_frame(int number, NumbersOfFrames numbers) {
  frame_ = number;
  numbers_ = numbers;
  if (!is_random()) return;
  attempt([&] { run_->draw_random(seed(0)); });
}

void PointRun::look(const View& view, const SceneChanges& changes) {
  view_ = view;
  if (external_) return;
  attempt([&] { run_->look(view, changes); });
}

void PointRun::draw_one(bool timed) {
  timed && run_->draws_bytes() ? run_->run_picture(true) : run_->run_frame(true);
}

void PointRun::draw_frames(bool timed, const std::function<void(const Image& image)>& add) {
  for (int frame = 0; frame < point_.frames; ++frame) {
    if (is_random()) run_->draw_random(seed(frame));
    draw_one(timed);
    if (point_.frames > 1) add(run_->image());
  }
}

double PointRun::draw(DeviceClock* clock) {
  struct Watched {  // also ends after an exception
    PassTimer& timer;
    Watched(PassTimer& t, DeviceClock* clock) : timer(t) { timer.watcher = clock; }
    ~Watched() { timer.watcher = nullptr; }
  };
  double ms = 0;
  device_times_.reset();
  cpu_ms_.reset();
  if (external_) return ask(false);
  attempt([&] {
    const Watched watched(run_->view().timer, clock);
    if (clock) clock->start();
    const double cpu_before_ms = process_cpu_ms();
    const Timer timer;
    bool first = true;
    draw_frames(clock != nullptr, [&](const Image& image) {
      if (std::exchange(first, false)) mean_ = Image(image.width, image.height);
      const float weight = 1.0f / float(point_.frames);
      for (size_t i = 0; i < mean_.pixels.size(); ++i) mean_.pixels[i] += image.pixels[i] * weight;
    });
    ms = timer.elapsed_ms();
    cpu_ms_ = process_cpu_ms() - cpu_before_ms;
    if (clock) device_times_ = clock->stop();
  });
  return ms;
}

double PointRun::draw_for_errors() {
  if (external_) return ask(true);
  attempt([&] {
    PictureMoments moments;
    draw_frames(false, [&](const Image& image) { moments.add(image); });
    if (point_.frames == 1) return;
    mean_ = moments.mean();
    deviation_ = moments.deviation();
  });
  return 0;
}

void PointRun::draw_first_frame() {
  if (external_) return;
  attempt([&] {
    if (is_random()) run_->draw_random(seed(0));
    draw_one(true);
  });
}

}  // namespace lightgrid::lab
