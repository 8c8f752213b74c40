#include "frontier/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <span>

#include "base/error.h"
#include "base/timer.h"
#include "frontier/families.h"
#include "frontier/fields.h"
#include "frontier/rounds.h"
#include "frontier/sequences.h"
#include "frontier/view_figures.h"

namespace lightgrid::lab {
namespace {

// Points that take more than slow_factor times as long as the baseline, and beaten_factor times as long as a
// point with no larger error, are far from the front: few rounds tell how far.
constexpr double slow_factor = 1.25, beaten_factor = 3;

// With less time than these take in the fewest rounds, errors are measured on fewer views: intervals over views
// need the times of several.
constexpr int min_timed_views = 4;

// With less time a point, as many points as possible are worth more than FLIP and flicker.
constexpr double seconds_a_point_with_flip = 2;

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// The value of the first line "KEY : VALUE" of /proc/cpuinfo.
std::string cpu_info(const std::string& key) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(':');
    if (line.starts_with(key) && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "";
}

// The time of a picture with all its frames.
double seconds_of_passes(const FrontierRecord& record) {
  double ms = 0;
  for (const auto& [name, pass_ms] : record.pass_ms) ms += pass_ms;
  return ms * record.point.frames / 1000;
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
        views_(frontier_views(scene, start, choice, job.views)),
        figures_(renderer, gpu_, scene, views_.front(), job, choice) {}

  void run() {
    make_runs();
    if (!measured_.empty() || !apart_.empty()) {
      measure_figures();
      measure_flicker();
      measure_cull_tests();
      measure_times();
      if (job_.process + 1 < job_.processes) {
        notice(steps_);
        return;
      }
      complete(measured_, file_);
      growth_round_s_ = round_of_growth();
      measured_.clear();
    }
    baseline_.reset();
    if (job_.growth) {
      const double left = growth_seconds(job_.seconds, seconds() - sequences_s_);
      measure_growth(renderer_, gpu_, scene_, choice_, job_, left, growth_round_s_, file_);
      end_step("growth");
    }
    notice(steps_);
  }

  double seconds_of_sequences() const { return sequences_s_; }

 private:
  double seconds() const { return timer_.elapsed_ms() / 1000; }
  void notice(const std::string& what) const {
    if (job_.notice) job_.notice(choice_.scene + ": " + what);
  }
  void tell(double done, const std::string& step) const {
    if (job_.progress) job_.progress(std::min(done, 1.0), step);
  }
  void end_step(const char* name) {
    steps_ += fmt::format("{}{} {:.0f} s", steps_.empty() ? "" : ", ", name, seconds() - step_began_s_);
    step_began_s_ = seconds();
  }

  FrontierRecord record_of(const ChosenPoint& point, int view) const {
    FrontierRecord record;
    record.point = described(choice_.scene, point);
    record.view = view;
    record.width = start_.width;
    record.height = start_.height;
    record.lights = int(scene_.lights.size());
    record.frames_per_round = frames_per_round;
    if (job_.truth != FrontierTruth()) record.truth = job_.truth;
    if (point.external) record.external = {point.external->note, point.runs()};
    return record;
  }

  // Points whose records are complete are left out; of others the records of an earlier process go on.
  void make_runs() {
    for (const ChosenPoint& point : job_.points) {
      if (!point.runs() && job_.process == 0) apart_.push_back(&point);
      if (!point.runs() || file_.has(record_key(record_of(point, 0)))) continue;
      tell(0, point.label);
      if (point.external && exported_.name.empty())
        exported_ = export_scene(job_.exports, choice_.scene, scene_, views_);
      measured_.push_back({PointRun(renderer_, gpu_, start_, point, pool_, &exported_), {}});
      std::vector<FrontierRecord>& records = measured_.back().records;
      for (int view = 0; view < int(views_.size()); ++view) {
        const auto begun = file_.open_records().find(record_key(record_of(point, view)));
        if (begun == file_.open_records().end()) break;
        records.push_back(begun->second);
      }
    }
    std::erase_if(apart_,
                  [&](const ChosenPoint* point) { return file_.has(record_key(record_of(*point, 0))); });
    if (measured_.empty() && apart_.empty()) return;
    baseline_.emplace(renderer_, gpu_, start_, job_.baseline, pool_);
    baseline_->draw();
    baseline_s_ = baseline_->draw() / 1000;
    if (!baseline_->refused().empty()) {
      throw machine_error("{}: the baseline {} cannot run: {}", choice_.scene, job_.baseline.label,
                          baseline_->refused());
    }
    end_step("programs");
  }

  double until() const { return job_.seconds * (job_.growth ? 1 - share_of_growth : 1.0) + sequences_s_; }
  // True if a warm-up and `rounds` rounds over `views` views still fit, after `more` seconds.
  bool fits(double more, int rounds, int views) const {
    double round_s = 0;
    for (const MeasuredPoint& m : measured_) {
      if (m.records.empty()) continue;
      const int runs = 1 + frames_per_round * (m.slow ? std::min(rounds, slow_rounds) : rounds);
      // Each timed picture follows one frame that is not.
      const double frame_s = m.picture_s / m.run.point().frames;
      round_s += (baseline_s_ + m.picture_s + frame_s + m.around_s) * runs;
    }
    return seconds() + more + round_s * views <= until();
  }

  // The time of a round of the points that growth is measured with: each frame, and the baseline's, follows
  // one that does not count.
  double round_of_growth() const {
    double round_s = 0;
    for (const MeasuredPoint& m : measured_) {
      if (is_grown(m.run.point())) round_s += 2 * (baseline_s_ + m.picture_s);
    }
    return round_s;
  }

  // As many points as the time allows on one view, then as many views, of which two can still be timed. Views
  // have HDR-FLIP and flicker as long as there is time for all of the others without, and for timing four.
  void measure_figures() {
    const bool own =
        std::ranges::any_of(measured_,
                            [](const MeasuredPoint& m) { return has_own_surfaces(m.run.point()); }) ||
        std::ranges::any_of(apart_, [](const ChosenPoint* point) { return has_own_surfaces(*point); });
    ViewSeconds view_s;
    bool whole = has_time_for_flip();
    for (int view = 0; view < int(views_.size()); ++view) {
      if (std::ranges::any_of(measured_, [&](const MeasuredPoint& m) { return has_view(m, view); })) {
        whole = is_whole(view);
      } else if (job_.process > 0) {
        break;  // views whose times no earlier process has
      } else if (view > 0) {
        whole = whole && fits(view_s.whole + view_s.plain * double(int(views_.size()) - view - 1),
                              job_.min_rounds_per_point, std::min(int(views_.size()), min_timed_views));
        if (!whole && !fits(view_s.plain, job_.min_rounds_per_point, std::min(view + 1, min_timed_views)))
          break;
      }
      const double before = seconds();
      measure_view(view, own, whole);
      used_views_ = view + 1;
      if (view == 0) {
        leave_out_unmeasured();
        classify();
      }
      view_s.measured(seconds() - before, view, whole);
      if (whole) whole_views_ = view + 1;
    }
    file_.append(apart_records_);  // in one line: all views or none
    if (used_views_ < int(views_.size()))
      notice(fmt::format("{} of {} views, for the time there is", used_views_, views_.size()));
    if (whole_views_ < used_views_)
      notice(fmt::format("HDR-FLIP and flicker on {} of {} views, for the time there is", whole_views_,
                         used_views_));
    end_step("figures");
  }

  // The expected time of a later view, with HDR-FLIP and flicker and without: estimates until one was
  // measured so.
  struct ViewSeconds {
    double whole = 0, plain = 0;
    void measured(double s, int view, bool with_flip) {
      // The first view also writes pictures, profiles passes and draws random points four times as often.
      if (view == 0) s *= 0.5;
      if (with_flip) {
        whole = s;
        plain = 0.6 * s;
      } else
        plain = s;
    }
  };

  bool has_time_for_flip() const {
    return job_.seconds >= seconds_a_point_with_flip * double(measured_.size());
  }
  static bool has_view(const MeasuredPoint& m, int view) { return int(m.records.size()) > view; }
  bool is_whole(int view) const {
    return std::ranges::any_of(measured_, [&](const MeasuredPoint& m) {
      return has_view(m, view) && m.records[size_t(view)].errors.temporal_rmse_rel.has_value();
    });
  }

  void measure_view(int view, bool own, bool whole) {
    constexpr size_t points_of_estimate = 3;
    const double began_s = seconds();
    size_t done = 0;
    bool looked = false;
    const auto look = [&] {
      if (!looked) figures_.look(views_[size_t(view)], view, own, whole);
      looked = true;
    };
    for (MeasuredPoint& m : measured_) {
      if (!has_view(m, view)) {
        if ((view == 0 && !fits(0, 1, 1)) || job_.process > 0) break;
        tell(seconds() / job_.seconds,
             fmt::format("view {} of {}, {}", view + 1, views_.size(), m.run.point().label));
        look();
        FrontierRecord record = record_of(m.run.point(), view);
        figures_.measure(m.run, record);
        if (record.external)
          m.around_s = std::max(m.run.asked_ms() / 1000 - seconds_of_passes(record), m.around_s);
        file_.begin(record);
        m.records.push_back(std::move(record));
        if (view == 0 && ++done == std::min(points_of_estimate, measured_.size()))
          tell_budget(done, seconds() - began_s);
      }
      if (view == 0) m.picture_s = seconds_of_passes(m.records.front());
    }
    if (job_.process > 0 || apart_.empty()) return;
    look();
    for (const ChosenPoint* point : apart_) {
      FrontierRecord record = record_of(*point, view);
      const ExternalFrame& frame = point->external->scenes.at(choice_.scene).frames[size_t(view)];
      figures_.measure_picture(*point, picture_of(frame, record.width, record.height), record);
      record.frame_ms = frame.frame_ms;
      record.baseline_ms = frame.baseline_ms;
      record.processes.resize(record.frame_ms.size(), 0);
      record.frames_per_round = 1;
      apart_records_.push_back(std::move(record));
    }
  }

  void leave_out_unmeasured() {
    const size_t all = measured_.size();
    std::erase_if(measured_, [](const MeasuredPoint& m) { return m.records.empty(); });
    if (measured_.size() < all)
      notice(fmt::format("{} of {} points, for the time there is", measured_.size(), all));
  }

  // After the first points of the first view: an estimate of what the time allows.
  void tell_budget(size_t points, double points_s) const {
    const double point_s = std::max(1e-3, points_s / double(points)), before_s = seconds() - points_s;
    const size_t all = measured_.size(), allowed = size_t(std::max(1.0, (until() - before_s) / point_s));
    if (allowed >= all) return notice(fmt::format("{} points, which the budget allows", all));
    const double all_s = (before_s + point_s * double(all)) / (job_.growth ? 1 - share_of_growth : 1.0);
    notice(
        fmt::format("the budget allows about {} of {} points; all of them take about {:.0f} min "
                    "(--budget, --technique and --vary choose)",
                    allowed, all, std::ceil(all_s / 60)));
  }

  // In none of the errors that fronts are of. A refused point has none.
  static bool has_no_larger_error(const MeasuredPoint& m, const MeasuredPoint& other) {
    const PointErrors &a = m.records.front().errors, &b = other.records.front().errors;
    return std::ranges::all_of(front_errors, [&](const char* kind) {
      return flip_of(a, kind) <= flip_of(b, kind) ||
             (std::isnan(flip_of(b, kind)) && kind != std::string("total"));
    });
  }

  void classify() {
    size_t slow = 0;
    for (MeasuredPoint& m : measured_) {
      m.slow = m.picture_s > slow_factor * baseline_s_ &&
               std::ranges::any_of(measured_, [&](const MeasuredPoint& other) {
                 return has_no_larger_error(other, m) && beaten_factor * other.picture_s < m.picture_s;
               });
      slow += m.slow;
    }
    if (slow > 0)
      notice(fmt::format(
          "{} of {} points take {} times as long as another with no larger error: timed in {} rounds", slow,
          measured_.size(), beaten_factor, slow_rounds));
  }

  void measure_flicker() {
    if (!job_.sequences || job_.process > 0) return;
    const double before = seconds();
    measure_sequences(renderer_, gpu_, scene_, choice_, views_.front(), job_, measured_, file_);
    sequences_s_ = seconds() - before;
    end_step("sequences");
  }

  void measure_cull_tests() {
    measure_cull_times(measured_, views_.front(), until() - seconds(), file_);
    end_step("cull tests");
  }

  // As many views as the time allows; those that were timed before, by an earlier process or until a sweep
  // was interrupted.
  int timed_views() const {
    const auto is_timed = [](const FrontierRecord& r) { return !r.frame_ms.empty(); };
    int begun = 0;
    for (const MeasuredPoint& m : measured_)
      begun = std::max(begun, int(std::ranges::count_if(m.records, is_timed)));
    if (begun > 0) return begun;
    int views = used_views_;
    while (views > 1 && !fits(0, job_.min_rounds_per_point, views)) --views;
    return views;
  }

  // The baseline as points of its own.
  void add_controls(int views) {
    for (int i = 0; i < job_.controls; ++i) {
      MeasuredPoint control{PointRun(renderer_, gpu_, start_, job_.baseline, pool_), {}};
      for (int view = 0; view < views; ++view) {
        FrontierRecord record = record_of(job_.baseline, view);
        record.series = fmt::format("control {}", file_.part().shard * job_.controls + i);
        const auto begun = file_.open_records().find(record_key(record));
        if (begun == file_.open_records().end()) file_.begin(record);
        control.records.push_back(begun == file_.open_records().end() ? record : begun->second);
      }
      measured_.push_back(std::move(control));
    }
  }

  void measure_times() {
    const size_t points = measured_.size();
    const int timed = timed_views();
    add_controls(timed);
    TimeRounds rounds{job_,
                      timer_,
                      until(),
                      std::span(views_).first(size_t(timed)),
                      measured_,
                      *baseline_,
                      file_,
                      DeviceClock(renderer_),
                      !renderer_.cl->info().cpu};
    const int done = rounds.run();
    notice(fmt::format("{} points, {} views{}, {} rounds", points, used_views_,
                       timed < used_views_ ? fmt::format(", {} of them timed", timed) : "", done));
    end_step("rounds");
  }

  Renderer& renderer_;
  Scene& scene_;
  const SceneChoice& choice_;
  const View start_;
  const FrontierJob& job_;
  RecordFile& file_;
  Timer timer_;
  GpuScene gpu_;
  std::vector<View> views_;
  ViewFigures figures_;
  const std::shared_ptr<TargetPool> pool_ = std::make_shared<TargetPool>();
  std::vector<MeasuredPoint> measured_;
  std::vector<const ChosenPoint*> apart_;  // other renderers' points that were timed elsewhere
  std::vector<FrontierRecord> apart_records_;
  ExportedScene exported_;  // without a name: not yet
  std::optional<PointRun> baseline_;
  double growth_round_s_ = 0, baseline_s_ = 0, step_began_s_ = 0, sequences_s_ = 0;
  std::string steps_;  // durations of the steps
  int used_views_ = 0, whole_views_ = 0;
};

}  // namespace

double load_average() {
  double loads[1] = {0};
  return getloadavg(loads, 1) == 1 ? loads[0] : 0;
}

FrontierMachine machine_of(const Renderer& renderer) {
  FrontierMachine m;
  const ClDeviceInfo& device = renderer.cl->info();
  m.cl_device = device.name;
  m.cl_driver = device.platform + " " + device.driver;
  m.gl_device = renderer.gl ? renderer.gl->renderer : "none";
  m.gl_driver = renderer.gl ? renderer.gl->version : "none";
  m.cl_kind = device.cpu ? "CPU" : "GPU";
  m.picture = times_bytes(renderer) ? "bytes" : "float";
  m.cpu = cpu_info("model name");
  const std::string governor = first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  m.governor = governor.empty() ? "unknown" : governor;
  m.clock_mhz = std::atof(cpu_info("cpu MHz").c_str());
  m.threads = device.compute_units;
  m.load_at_start = m.load_at_end = load_average();
  return m;
}

double measure_scene(Renderer& renderer, const SceneChoice& choice, const FrontierJob& job,
                     RecordFile& file) {
  ChosenScene chosen = load_chosen_scene(choice);
  if (job.families) {
    measure_families(renderer, chosen.scene, choice, job, file);
    return 0;
  }
  SceneSweep sweep(renderer, chosen.scene, choice, chosen.view, job, file);
  sweep.run();
  return sweep.seconds_of_sequences();
}

}  // namespace lightgrid::lab
