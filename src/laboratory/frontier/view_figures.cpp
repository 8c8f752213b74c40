#include "frontier/view_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/oracle.h"
#include "accuracy/surfaces_in_double.h"
#include "base/embedded.h"
#include "base/error.h"
#include "cl/error.h"
#include "measures/error_measures.h"
#include "measures/metrics.h"
#include "plan/settings/model.h"
#include "scene/camera_path.h"
#include "scene/random.h"
#include "scenes/builtin.h"

namespace lightgrid::lab {
namespace {

// Pictures no farther from brute force, over the brightest channel, are taken for it: they share its file,
// its FLIP and its flicker.
constexpr double as_brute_force = 1e-6;
constexpr int frames_of_flicker = 3;

// 0, n / 2, n / 4, 3 n / 4, …: van der Corput's sequence, in places of `count`.
std::vector<size_t> spread_order(size_t count) {
  std::vector<size_t> order;
  std::vector<bool> taken(count, false);
  for (size_t i = 0; order.size() < count; ++i) {
    double place = 0;
    double step = 0.5;
    for (size_t bits = i; bits > 0; bits >>= 1, step /= 2) place += double(bits & 1) * step;
    const size_t index = size_t(place * double(count));
    if (taken[index]) continue;
    taken[index] = true;
    order.push_back(index);
  }
  return order;
}

std::vector<View> path_of_views(const Scene& scene, const View& start, const SceneChoice& choice, int count) {
  if (!choice.camera_path.empty()) return camera_path(scene, start, choice.camera_path);
  const std::string file = "frontier/views/" + choice.scene + ".json";
  if (choice.camera.empty() && find_builtin_scene(choice.scene) && embedded_files().contains(file))
    return camera_path_of_keys(start, embedded_file(file), file);
  return camera_path(scene, start, fmt::format("turn:{}", count));
}

}  // namespace

std::vector<View> frontier_views(const Scene& scene, const View& start, const SceneChoice& choice,
                                 int count) {
  if (count == 1 && choice.camera_path.empty()) return {start};
  const std::vector<View> all = path_of_views(scene, start, choice, count);
  std::vector<View> views;
  for (const size_t i : spread_order(std::min(all.size(), size_t(count)))) {
    views.push_back(all[i * all.size() / std::min(all.size(), size_t(count))]);
  }
  return views;
}

std::vector<View> slow_turn(const Scene& scene, const View& start, int frames) {
  std::vector<View> views = camera_path(scene, start, "turn:1440");
  views.resize(size_t(frames));
  return views;
}

bool has_own_surfaces(const ChosenPoint& point) {
  if (point.external) return point.external->own_surfaces;
  return own_surfaces(*point.contestant.technique, point.contestant.settings);
}

ViewFigures::ViewFigures(Renderer& renderer, GpuScene& gpu, const Scene& scene, const View& first,
                         const FrontierJob& job, const SceneChoice& choice)
    : renderer_(renderer),
      scene_(scene),
      choice_(choice),
      truth_(job.truth),
      shadows_(scene, job.shadow_pairs),
      truths_{Truths(renderer, gpu, job, !renderer.gl), Truths(renderer, gpu, job, true)},
      precision_(renderer, gpu, first, job.common, job.truth,
                 shadows_.casts() ? job.shadow_pairs : job.shaded_pairs),
      pictures_(job.pictures),
      nowhere_({}),
      first_(first),
      has_authored_(has_authored(job)),
      seed_(job.seed) {}

ViewFigures::Truths::Truths(Renderer& renderer, GpuScene& gpu, const FrontierJob& job, bool own_surfaces)
    : brute(renderer, gpu, job.common, job.truth, own_surfaces) {
  for (int frame = 1; frame < frames_of_flicker; ++frame)
    turned.emplace_back(renderer, gpu, job.common, job.truth, own_surfaces);
}

void ViewFigures::Truths::look(const View& view, const std::vector<View>& turn) {
  for (size_t frame = 1; frame < turn.size(); ++frame) turned[frame - 1].look(turn[frame]);
  brute.look(view);
  flip.reset();
  reference.reset();
  authored.reset();
  flicker.clear();
}

void ViewFigures::Truths::take_truths(Truths& of_areas, size_t frames) {
  brute.take_truth(of_areas.brute.truth());
  for (size_t frame = 1; frame < frames; ++frame)
    turned[frame - 1].take_truth(of_areas.turned[frame - 1].truth());
}

ViewFigures::Reference::Reference(const Image& image, double brightest_channel, const Exposure& exposure)
    : truth(&image), brightest(brightest_channel), shown(std::in_place, image, exposure) {}

ImageError ViewFigures::Reference::error_of(const Image& image, bool with_flip) const {
  ImageError error = frontier_error(image, *truth, brightest);
  if (with_flip) error.displayed = shown->flip_of(image);
  return error;
}

const ImageError& ViewFigures::Reference::error_of_brute_force(const Image& kept) {
  const auto [error, added] = of_brute_force.try_emplace(&kept);
  if (added) error->second = error_of(kept);
  return error->second;
}

void ViewFigures::refer(Truths& truths) {
  truths.reference.emplace(truths.brute.truth(), truths_[0].brute.brightest(), *exposure_);
  if (!has_authored_) return;
  truths.authored.emplace(truths.brute.authored(), brightest_channel(truths_[0].brute.authored()),
                          *exposure_);
}

// An earlier process may have measured the first view.
void ViewFigures::choose_exposure() {
  if (exposure_) return;
  BruteForce& brute = truths_[0].brute;
  brute.look(first_);
  exposure_ = chosen_exposure(choice_, brute.truth());
  tell_exposure(*exposure_, choice_.scene + ": ");
  pictures_.expose(*exposure_);
}

void ViewFigures::look(const View& view, int index, bool own, bool whole) {
  choose_exposure();
  view_ = view;
  turn_ = whole ? slow_turn(scene_, view, frames_of_flicker) : std::vector<View>();
  std::vector<Truths*> used = {&truths_[0]};
  if (own && renderer_.gl) used.push_back(&truths_[1]);
  for (Truths* truths : used) truths->look(view, turn_);
  BruteForce& first = truths_[0].brute;
  if (truth_.places && used.size() > 1) truths_[1].take_truths(truths_[0], turn_.size());
  // Where a median pixel is black, HDR-FLIP has no exposures.
  exposures_ = whole ? flip_exposures(first.truth()) : std::nullopt;
  for (Truths* truths : used) {
    if (exposures_) truths->flip.emplace(truths->brute.truth(), *exposures_);
    refer(*truths);
  }
  if (used.size() > 1 && !truth_.places)
    truths_[1].surfaces = truths_[0].reference->error_of(truths_[1].brute.truth());
  brightest_ = first.brightest();
  shadows_.moved(false);
  precision_.measure(view, first, used.size() > 1 ? &truths_[1].brute : nullptr,
                     Random::mix(seed_) + uint64_t(index), shadows_);
}

void take_passes(const FrameFigures& result, FrontierRecord& record) {
  for (const PassResult& pass : result.passes) {
    const uint64_t bytes = pass.bytes_read + pass.bytes_written;
    record.pass_ms[pass.name] += pass.median_ms;
    record.pass_bytes[pass.name] += bytes;
    record.bytes_moved += bytes;
  }
}

ViewFigures::Truths& ViewFigures::truths_of(const ChosenPoint& point) {
  return truths_[has_own_surfaces(point) && renderer_.gl ? 1 : 0];
}

void ViewFigures::measure(PointRun& run, FrontierRecord& record) {
  if (record.external) return fill_external(run, record);
  run.look(view_);
  run.draw_for_errors();
  record.refused = run.refused();
  if (!record.refused.empty()) return;
  const auto failure = failure_of([&] { fill(run, record); });  // its lists may not fit into memory
  if (failure) record.refused = failure->what();
}

void ViewFigures::fill_external(PointRun& run, FrontierRecord& record) {
  run.look(view_);
  const double ms = run.draw_for_errors();
  record.refused = run.refused();
  if (!record.refused.empty()) return;
  record.pass_ms["frame"] = ms;
  const Image image = run.image();
  measure_picture(run.point(), image, record);
  if (turn_.empty() || !(brightest_ > 0)) return;
  const auto failure = failure_of(
      [&] { record.errors.temporal_rmse_rel = flicker_of(run, truths_of(run.point()), image) / brightest_; });
  if (failure) record.refused = failure->what();
}

void ViewFigures::measure_picture(const ChosenPoint& point, const Image& image, FrontierRecord& record) {
  Truths& truths = truths_of(point);
  PointErrors& errors = record.errors;
  for (ImageError* unknown : {&errors.model, &errors.precision, &errors.technique}) {
    for (const ErrorMeasure& measure : frontier_error_measures()) unknown->*measure.value = unknown_error;
  }
  errors.total = truths.reference->error_of(image);
  if (has_authored_) {
    errors.authored.emplace().model = errors.model;
    errors.authored->total = truths.authored->error_of(image);
  }
  errors.in_double = precision_.in_double(image, has_own_surfaces(point));
  errors.surfaces = truths.surfaces;
  record.nan_pixels = count_nan_pixels(image);
  record.exposure_ev = exposure_->ev;
  fill_flip(image, truths, record);
}

void ViewFigures::fill(PointRun& point_run, FrontierRecord& record) {
  const ChosenPoint& point = point_run.point();
  Truths& truths = truths_of(point);
  const Image image = point_run.image();
  const Image& meant = truths.brute.picture(point.contestant.settings);
  const bool own = has_own_surfaces(point);
  record.errors.precision = precision_.of(own);
  record.errors.in_double = precision_.in_double(image, own);
  record.errors.surfaces = truths.surfaces;
  record.nan_pixels = count_nan_pixels(image);
  if (point.frames > 1) {
    const double relative = brightest_ > 0 ? point_run.deviation() / brightest_ : 0;
    record.errors.deviation_rmse_rel = relative;
    point_run.draw_first_frame();
  }
  record.errors.technique = frontier_error(point_run.run().image(), meant, brightest_);
  // Frames of random ranges mean one each.
  const bool means_one_picture = point.frames == 1 || !point_run.has_random_ranges();
  const bool as_meant = point.frames == 1 && record.errors.technique.max_rel <= as_brute_force;
  record.exposure_ev = exposure_->ev;
  const auto compare = [&](Reference& reference, ImageError& model, ImageError& total) {
    if (means_one_picture) model = reference.error_of_brute_force(meant);
    if (as_meant) {
      total = frontier_error(image, *reference.truth, reference.brightest);
      total.displayed = model.displayed;
    } else {
      total = reference.error_of(image);
    }
    if (!means_one_picture) model = total;
  };
  compare(*truths.reference, record.errors.model, record.errors.total);
  if (has_authored_) {
    AuthoredErrors& errors = record.errors.authored.emplace();
    compare(*truths.authored, errors.model, errors.total);
  }
  fill_flip(as_meant ? meant : image, truths, record);

  TechniqueRun& run = point_run.run();
  const std::vector<float> depth = read_depth(run);
  record.covered_pixels = uint64_t(std::ranges::count_if(depth, [](float d) { return d > 0; }));
  record.pairs = pairs_of(run, point.contestant.settings, depth);
  if (run.limits_lists()) record.overflow = record.pairs.lost;
  if (record.view == 0) run.run_profiled_frames(100);
  const FrameFigures result = run.result();
  record.memory_bytes = result.memory_total;
  if (record.view == 0) take_passes(result, record);  // passes are counted where they are profiled
  if (point_run.is_random()) measure_seeds(point_run, truths, record);
  if (turn_.empty() || !(brightest_ > 0)) return;
  const double change =
      as_meant ? flicker_of_brute_force(point, truths) : flicker_of(point_run, truths, image);
  record.errors.temporal_rmse_rel = change / brightest_;
}

PairCounts ViewFigures::pairs_of(TechniqueRun& run, const Settings& settings,
                                 const std::vector<float>& depth) {
  const SeenPairs* seen =
      shadows_.casts() ? shadows_.pairs(run.view(), depth, shown_triangles(run)) : nullptr;
  PairCounts counts = pair_counts(run, count_listed_pairs(run, depth, seen), seen);
  if (!counts_shadow_pairs(settings, truth_)) counts.shadows.reset();
  return counts;
}

void ViewFigures::fill_flip(const Image& image, Truths& truths, FrontierRecord& record) {
  const HdrFlip* flip = truths.flip ? &*truths.flip : nullptr;
  if (record.view > 0 && !flip) return;
  PictureFiles& files = record.view == 0 ? pictures_ : nowhere_;
  const PictureFiles::Written written = files.write(choice_.scene, image, truths.brute.truth(), flip);
  record.image = written.name;
  record.errors.total.flip_mean = written.flip_mean;
  record.flip = exposures_;
}

namespace {

// A measure over pictures of one view: their mean and standard deviation, as over views.
void join(const std::vector<ImageError>& pictures, ImageError& mean, ImageError* deviation) {
  const auto moments = [](const std::vector<double>& figures) {
    double sum = 0, squares = 0;
    for (const double figure : figures) sum += figure;
    const double centre = sum / double(figures.size());
    for (const double figure : figures) squares += (figure - centre) * (figure - centre);
    return std::pair(centre, std::sqrt(squares / double(figures.size() - 1)));
  };
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    std::vector<double> figures;
    for (const ImageError& picture : pictures) figures.push_back(picture.*measure.value);
    mean.*measure.value = joined(figures, measure.over_views);
    if (deviation) deviation->*measure.value = moments(figures).second;
  }
  std::vector<double> flips, visible;
  for (const ImageError& picture : pictures) {
    if (!picture.displayed) continue;
    flips.push_back(picture.displayed->mean);
    visible.push_back(picture.displayed->visible);
  }
  mean.displayed = {moments(flips).first, moments(visible).first};
  if (deviation) deviation->displayed = {moments(flips).second, moments(visible).second};
}

// For a point's first view, and for its others: they show changes from view to view, and so many more of them
// fit into the same time.
constexpr int pictures_of_first_view = 32,
              pictures_of_a_view = 8;                        // of averaged frames the latter everywhere
constexpr int flips_of_first_view = 8, flips_of_a_view = 4;  // FLIP takes long
constexpr int frames_of_a_view = 1000;                       // no two views share random numbers

}  // namespace

// One draw would be noise: its error is within a factor of three of what is expected.
void ViewFigures::measure_seeds(PointRun& run, Truths& truths, FrontierRecord& record) {
  const bool first = record.view == 0;
  const int pictures = first && record.point.frames == 1 ? pictures_of_first_view : pictures_of_a_view;
  const int flips = first ? flips_of_first_view : flips_of_a_view;
  std::vector<ImageError> totals, authored;
  PictureMoments moments;
  BiasOfPictures bias;
  // The mean over random ranges is the picture without ranges, that over samples of lists the one of whole
  // lists.
  const bool ranges = run.has_random_ranges();
  const Image& expected =
      ranges ? *truths.reference->truth : truths.brute.picture(run.point().contestant.settings);
  for (int i = 0; i < pictures; ++i) {
    run.go_to_frame(frames_of_a_view * (record.view + 1) + i);
    run.draw();
    if (!run.refused().empty()) throw machine_error("{}", run.refused());
    const Image image = run.image();
    const bool with_flip = i % (pictures / flips) == 0;
    totals.push_back(truths.reference->error_of(image, with_flip));
    if (truths.authored) authored.push_back(truths.authored->error_of(image, with_flip));
    moments.add(image);
    bias.add(image, expected);
  }
  run.go_to_frame(0);
  SeedErrors& seeds = record.errors.seeds.emplace();
  seeds.pictures = pictures;
  seeds.flip_pictures = flips;
  join(totals, record.errors.total, &seeds.deviation);
  if (ranges) record.errors.model = record.errors.total;
  if (truths.authored) {
    join(authored, record.errors.authored->total, nullptr);
    if (ranges) record.errors.authored->model = record.errors.authored->total;
  }
  if (!(brightest_ > 0)) return;
  const BiasOfPictures::Estimate estimate = bias.estimate();
  seeds.bias_mse_rel = estimate.mean_square / (brightest_ * brightest_);
  seeds.bias_mse_rel_error = estimate.standard_error / (brightest_ * brightest_);
  record.errors.bias_rmse_rel = std::sqrt(std::max(seeds.bias_mse_rel, 0.0));
  if (record.point.frames == 1) record.errors.deviation_rmse_rel = moments.deviation() / brightest_;
}

// The turn begins with the view itself.
double ViewFigures::flicker_of(PointRun& run, Truths& truths, const Image& first) {
  ChangeOfError change;
  change.add(first, truths.brute.truth());
  for (size_t frame = 1; frame < turn_.size(); ++frame) {
    run.look(turn_[frame]);
    run.go_to_frame(int(frame));
    if (run.point().external)
      run.draw_for_errors();
    else
      run.draw();
    if (!run.refused().empty()) throw machine_error("{}", run.refused());
    change.add(run.image(), truths.turned[frame - 1].truth());
  }
  run.go_to_frame(0);
  return change.rmse();
}

// Once a view and meaning.
double ViewFigures::flicker_of_brute_force(const ChosenPoint& point, Truths& truths) {
  Settings settings = point.contestant.settings;
  const Image& first = truths.brute.picture(settings);
  const auto [place, added] = truths.flicker.try_emplace(&first, 0.0);
  if (!added) return place->second;
  ChangeOfError change;
  change.add(first, truths.brute.truth());
  for (size_t frame = 1; frame < turn_.size(); ++frame) {
    settings.set(setting::light_seed, settings[setting::light_seed] + 1);  // as PointRun::go_to_frame has it
    BruteForce& turned = truths.turned[frame - 1];
    change.add(turned.draw(settings), turned.truth());
  }
  return place->second = change.rmse();
}

}  // namespace lightgrid::lab
