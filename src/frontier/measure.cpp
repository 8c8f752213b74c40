#include "frontier/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "base/error.h"
#include "base/timer.h"
#include "cl/error.h"
#include "compare/oracle.h"
#include "frontier/brute_force.h"
#include "frontier/errors.h"
#include "frontier/growth_series.h"
#include "frontier/pictures.h"
#include "frontier/point_run.h"
#include "frontier/precision.h"
#include "frontier/scene_views.h"
#include "frontier/statistics.h"
#include "results/metrics.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

// The share of the scene's time that the series take, as far as it is limited.
constexpr double share_of_growth = 0.12;
// Pictures no farther from brute force, over the brightest channel, are taken for it: they share its file and
// its FLIP.
constexpr double as_brute_force = 1e-6;

// Points that take more than so many times as long as the baseline are far from the others: fewer rounds tell
// where.
constexpr double slow_factor = 3;
constexpr int slow_rounds = 4;

struct Measured {
  PointRun run;
  bool slow = false;
  std::vector<FrontierRecord> records;  // one a view
};

FrontierPoint described(const std::string& scene, const ChosenPoint& point) {
  const Contestant& c = point.contestant;
  return {scene, c.technique->name, settings_of(*c.technique, c.settings), point.label, point.frames};
}

bool has_own_surfaces(const ChosenPoint& point) {
  return own_surfaces(*point.contestant.technique, point.contestant.settings);
}

class SceneSweep {
 public:
  SceneSweep(Renderer& renderer, Scene& scene, const SceneChoice& choice, const View& start,
             const FrontierJob& job, RecordFile& file)
      : renderer_(renderer),
        scene_(scene),
        choice_(choice),
        start_(start),
        job_(job),
        file_(file),
        gpu_(renderer, scene),
        pictures_(job.pictures),
        views_(frontier_views(scene, start, choice, job.views)),
        with_opengl_(renderer, gpu_, job.common, !renderer.gl),
        with_opencl_(renderer, gpu_, job.common, true),
        precision_(renderer, gpu_, start, job.common, job.shaded_samples) {}

  void run() {
    make_runs();
    if (!measured_.empty()) {
      measure_errors();
      measure_flicker();
      measure_times();
      for (const Measured& m : measured_) file_.append(m.records);
      measured_.clear();
    }
    baseline_.reset();
    if (job_.growth) {
      const double left = std::max(job_.seconds - timer_.elapsed_ms() / 1000, 0.05 * job_.seconds);
      measure_growth(renderer_, gpu_, scene_, choice_, job_, left, file_);
    }
  }

 private:
  double seconds() const { return timer_.elapsed_ms() / 1000; }
  void tell(double done, const std::string& step) const {
    if (job_.progress) job_.progress(std::min(done, 1.0), step);
  }
  FrontierRecord record_of(const ChosenPoint& point, int view) const {
    FrontierRecord record;
    record.point = described(choice_.scene, point);
    record.view = view;
    record.width = start_.width, record.height = start_.height;
    record.lights = int(scene_.lights.size());
    return record;
  }

  void make_runs() {
    const auto pool = std::make_shared<TargetPool>();
    for (const ChosenPoint& point : job_.points) {
      if (file_.has(record_key(record_of(point, 0)))) continue;
      tell(0, point.label);
      measured_.push_back({PointRun(renderer_, gpu_, start_, point, pool)});
    }
    if (!measured_.empty()) baseline_.emplace(renderer_, gpu_, start_, job_.baseline, pool);
  }

  // Whether a warm-up and `rounds` rounds over `views` views still fit, after `more` seconds.
  bool fits(double more, int rounds, int views) const {
    const double until = job_.seconds * (job_.growth ? 1 - share_of_growth : 1.0);
    const int of_slow = std::min(rounds, slow_rounds);
    return seconds() + more + (fast_s_ * (rounds + 1) + slow_s_ * (of_slow + 1)) * views <= until;
  }

  // As many points as the time allows on one view, then as many views.
  void measure_errors() {
    baseline_->draw();
    const double baseline_s = baseline_->draw() / 1000;
    if (!baseline_->refused().empty()) {
      throw machine_error("{}: the baseline {} cannot run: {}", choice_.scene, job_.baseline.label,
                          baseline_->refused());
    }
    for (int view = 0; view < int(views_.size()); ++view) {
      const double before = seconds();
      if (view > 0 && !fits(last_view_s_, job_.least_rounds, view + 1)) break;
      with_opengl_.look(views_[view]);
      with_opencl_.look(views_[view]);
      const bool own =
          std::ranges::any_of(measured_, [](const Measured& m) { return has_own_surfaces(m.run.point()); });
      precision_.measure(views_[view], with_opengl_, own ? &with_opencl_ : nullptr);
      if (view == 0) make_flip();
      for (Measured& m : measured_) {
        tell(seconds() / job_.seconds,
             fmt::format("view {} of {}, {}", view + 1, views_.size(), m.run.point().label));
        m.records.push_back(errors_of(m, view));
        if (view > 0) continue;
        const double picture_s = seconds_of_passes(m.records.front());
        m.slow = picture_s > slow_factor * baseline_s;
        (m.slow ? slow_s_ : fast_s_) += 0.5 * baseline_s + picture_s;
        if (!fits(0, 1, 1)) break;
      }
      if (view == 0) leave_out_unmeasured();
      last_view_s_ = seconds() - before;
      used_views_ = view + 1;
    }
    if (used_views_ < int(views_.size()) && job_.notice)
      job_.notice(fmt::format("{}: {} of {} views, for the time there is", choice_.scene, used_views_,
                              views_.size()));
  }

  // If it leaves time for rounds.
  void measure_flicker() {
    constexpr int frames = 3;
    if (!fits(frames * (fast_s_ + slow_s_ + last_view_s_ / 10), job_.least_rounds, used_views_)) return;
    std::vector<ChangeOfError> changes(measured_.size());
    const std::vector<View> turn = slow_turn(scene_, views_.front(), frames);
    for (int frame = 0; frame < frames; ++frame) {
      with_opengl_.look(turn[size_t(frame)]);
      with_opencl_.look(turn[size_t(frame)]);
      for (size_t i = 0; i < measured_.size(); ++i) {
        PointRun& run = measured_[i].run;
        tell(seconds() / job_.seconds, "flicker, " + run.point().label);
        run.look(turn[size_t(frame)]);
        run.go_to_frame(frame);
        run.draw();
        if (run.refused().empty()) changes[i].add(run.image(), brute_force_of(run.point()).truth());
      }
    }
    for (size_t i = 0; i < measured_.size(); ++i) {
      measured_[i].run.go_to_frame(0);
      if (!measured_[i].run.refused().empty() || !(brightest_ > 0)) continue;
      measured_[i].records.front().errors.temporal_rmse_rel = changes[i].rmse() / brightest_;
    }
  }

  // Of a picture with all its frames.
  static double seconds_of_passes(const FrontierRecord& record) {
    double ms = 0;
    for (const auto& [name, pass_ms] : record.pass_ms) ms += pass_ms;
    return ms * record.point.frames / 1000;
  }

  void leave_out_unmeasured() {
    const size_t all = measured_.size();
    std::erase_if(measured_, [](const Measured& m) { return m.records.empty(); });
    if (measured_.size() < all && job_.notice)
      job_.notice(
          fmt::format("{}: {} of {} points, for the time there is", choice_.scene, measured_.size(), all));
  }

  // Where a median pixel is black, HDR-FLIP has no exposures.
  void make_flip() {
    const Image& truth = with_opengl_.truth();
    exposures_ = flip_exposures(truth);
    if (!exposures_) return;
    flip_.emplace(truth, *exposures_);
    flip_own_.emplace(with_opencl_.truth(), *exposures_);
  }

  BruteForce& brute_force_of(const ChosenPoint& point) {
    return has_own_surfaces(point) ? with_opencl_ : with_opengl_;
  }

  FrontierRecord errors_of(Measured& m, int view) {
    FrontierRecord record = record_of(m.run.point(), view);
    m.run.look(views_[view]);
    m.run.draw_for_errors();
    if (m.run.refused().empty()) {
      try {
        fill(record, m, view);  // its lists may not fit into memory
      } catch (const Error& error) {
        record.refused = error.what();
      } catch (const cl::Error& error) {
        record.refused = cl_machine_error(error).what();
      } catch (const std::bad_alloc&) {
        record.refused = "out of memory";
      }
    } else {
      record.refused = m.run.refused();
    }
    return record;
  }

  void fill(FrontierRecord& record, Measured& m, int view) {
    const ChosenPoint& point = m.run.point();
    BruteForce& brute = brute_force_of(point);
    const Image& image = m.run.image();
    // One for both kinds of surfaces, since a highlight of one pixel makes it.
    const double brightest = (renderer_.gl ? with_opengl_ : with_opencl_).brightest();
    if (view == 0) brightest_ = brightest;
    record.errors.total = error_figures(image, brute.truth(), brightest);
    record.errors.precision = has_own_surfaces(point) ? precision_.of_own_surfaces() : precision_.of_opengl();
    record.nan_pixels = count_nan_pixels(image);
    if (point.frames > 1) {
      const double relative = brightest > 0 ? m.run.deviation() / brightest : 0;
      record.errors.deviation_rmse_rel = relative;
      record.errors.bias_rmse_rel = bias_rmse(record.errors.total.rmse_rel, relative, point.frames);
      record.errors.model = record.errors.total;
      m.run.draw_first_frame();
    }
    const Image& meant = brute.picture(point.contestant.settings);
    record.errors.technique = error_figures(m.run.run().image(), meant, brightest);
    if (point.frames == 1) record.errors.model = error_figures(meant, brute.truth(), brightest);
    if (view == 0)
      show(record, point.frames == 1 && record.errors.technique.max_rel <= as_brute_force ? meant : image,
           brute);
    TechniqueRun& run = m.run.run();
    const std::vector<float> depth = read_depth(run);
    record.covered_pixels = uint64_t(std::ranges::count_if(depth, [](float d) { return d > 0; }));
    const LitPairs pairs = count_listed_pairs(run, depth);
    record.pairs = {pairs.listed, pairs.lit, pairs.lost, pairs.wrong};
    if (run.technique().limited_lists) record.overflow = pairs.lost;
    if (view == 0) run.run_profiled_frames(100);
    const RunResult result = run.result();
    record.memory_bytes = result.memory_total;
    for (const PassResult& pass : result.passes) {
      record.pass_ms[pass.name] += pass.median_ms;
      record.bytes_moved += pass.bytes_read + pass.bytes_written;
    }
  }

  void show(FrontierRecord& record, const Image& image, BruteForce& brute) {
    const auto& flip = &brute == &with_opencl_ ? flip_own_ : flip_;
    const PictureFiles::Written written =
        pictures_.write(choice_.scene, image, brute.truth(), flip ? &*flip : nullptr);
    record.image = written.name;
    record.errors.total.flip_mean = written.flip_mean;
    record.flip = exposures_;
  }

  // Rounds over all views: a baseline run, two points, a baseline run, two points…, in a new order each
  // round. A point counts with the baseline run beside it. Slow points are left out of late rounds. The first
  // round does not count: drivers compile in it what they dropped.
  void measure_times() {
    const double until = job_.seconds * (job_.growth ? 1 - share_of_growth : 1.0);
    double longest_round = 0;
    for (int round = 0; round <= job_.most_rounds; ++round) {
      const double before = seconds();
      if (round >= 2 && before + longest_round > until) break;
      if (round > job_.least_rounds && is_certain()) break;
      for (int view = 0; view < used_views_; ++view) time_view(round, view);
      if (round == 0) {
        for (Measured& m : measured_) forget_times(m);
        continue;
      }
      longest_round = std::max(longest_round, seconds() - before);
    }
  }

  void time_view(int round, int view) {
    std::vector<size_t> order;
    for (size_t i = 0; i < measured_.size(); ++i) {
      if (!measured_[i].slow || round <= slow_rounds) order.push_back(i);
    }
    Random random(Random::mix(job_.seed) + uint64_t(round) * 1000 + uint64_t(view));
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(random.next() % i)]);
    baseline_->look(views_[view]);
    baseline_->draw();
    double beside = baseline_->draw();
    for (size_t i = 0; i < order.size(); i += 2) {
      tell(seconds() / job_.seconds, fmt::format("times, round {}", round + 1));
      Measured& first = measured_[order[i]];
      add_times(first, view, timed(first, view), beside);
      if (i + 1 == order.size()) break;
      Measured& second = measured_[order[i + 1]];
      const double ms = timed(second, view);
      beside = baseline_->draw();
      add_times(second, view, ms, beside);
    }
  }

  static void forget_times(Measured& m) {
    for (FrontierRecord& record : m.records) record.frame_ms.clear(), record.baseline_ms.clear();
  }

  double timed(Measured& m, int view) {
    m.run.look(views_[view]);
    return m.run.draw();
  }

  void add_times(Measured& m, int view, double ms, double beside) {
    FrontierRecord& record = m.records[size_t(view)];
    if (!m.run.refused().empty()) record.refused = m.run.refused();
    if (!record.refused.empty()) return;
    record.frame_ms.push_back(ms);
    record.baseline_ms.push_back(beside);
  }

  // Whether each ratio's interval is narrow enough.
  bool is_certain() const {
    return std::ranges::all_of(measured_, [&](const Measured& m) {
      if (std::ranges::any_of(m.records, [](const FrontierRecord& r) { return !r.refused.empty(); }))
        return true;
      std::vector<double> ratios;
      for (size_t i = 0; i < m.records.front().frame_ms.size(); ++i) {
        double ms = 0, beside = 0;
        for (const FrontierRecord& record : m.records)
          ms += record.frame_ms[i], beside += record.baseline_ms[i];
        ratios.push_back(ms / beside);
      }
      const MedianInterval ratio = median_interval(ratios);
      return ratio.high - ratio.low <= job_.interval_width * ratio.median;
    });
  }

  Renderer& renderer_;
  Scene& scene_;
  const SceneChoice& choice_;
  const View start_;
  const FrontierJob& job_;
  RecordFile& file_;
  Timer timer_;
  GpuScene gpu_;
  PictureFiles pictures_;
  std::vector<View> views_;
  BruteForce with_opengl_, with_opencl_;
  Precision precision_;
  std::vector<Measured> measured_;
  std::optional<PointRun> baseline_;
  std::optional<FlipExposures> exposures_;
  std::optional<HdrFlip> flip_, flip_own_;
  double brightest_ = 0;                              // channel of the truth on the first view
  double last_view_s_ = 0, fast_s_ = 0, slow_s_ = 0;  // the latter of a round over one view
  int used_views_ = 0;
};

}  // namespace

void measure_scene(Renderer& renderer, const SceneChoice& choice, const FrontierJob& job, RecordFile& file) {
  ChosenScene chosen = load_chosen_scene(choice);
  SceneSweep(renderer, chosen.scene, choice, chosen.view, job, file).run();
}

}  // namespace lightgrid
