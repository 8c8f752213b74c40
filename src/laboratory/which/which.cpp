#include "which/which.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/timer.h"
#include "frontier/paired_times.h"
#include "frontier/timed_frames.h"
#include "frontier/view_figures.h"
#include "measures/words.h"
#include "scene/random.h"
#include "which/race.h"
#include "which/scene_errors.h"

namespace lightgrid::lab {
namespace {

constexpr int min_reduced_width = 160, max_reduction = 4;
// FLIP at the reduced size may differ from that at the view's size by this factor.
constexpr double reduced_factor = 2;
// Points start one after the other, while the machine's speed may change: only those slower by these factors are
// dropped then, after one frame and after two.
constexpr double one_frame_factor = 3, two_frames_factor = 1.5;
// Shares of the time: points start until the first, the reference at the view's size may take the second.
constexpr double share_of_starts = 0.6, share_of_reference = 0.25;
// What remains for rounds after a start that takes as long as the longest before it, and for the answer and the end
// of the program after the last round.
constexpr double share_of_rounds = 0.2, share_of_end = 0.02;
// A round may take so many times as long as the longest before it.
constexpr double round_slack = 1.25;
// Also if one point is left, so that its time has an interval.
constexpr int min_race_rounds = 6;
constexpr int draws = 2000;

View reduced_view(View view) {
  const int side = std::clamp(view.width / min_reduced_width, 1, max_reduction);
  view.width = std::max(view.width / side, 1);
  view.height = std::max(view.height / side, 1);
  return view;
}

// Their error depends on the size: a tile has as many pixels at the reduced size, which cover more of the scene and
// are reached by more lights.
bool has_capped_lists(const WhichPoint& p) { return !setting_in_force(p.point.settings, "list_cap").empty(); }

Estimate exponential(const Location& l) { return {std::exp(l.estimate), std::exp(l.low), std::exp(l.high)}; }

struct Entry {
  WhichPoint& point;
  PointRun run;
  RaceTime start = {};           // the least of its starting frames
  std::vector<double> log_ms{};  // wall-clock time, round by round
};

class Contest {
 public:
  Contest(Renderer& renderer, const Scene& scene, const View& view, const SceneChoice& choice,
          const WhichJob& job, const Timer& timer)
      : renderer_(renderer),
        job_(job),
        view_(view),
        timer_(timer),
        gpu_(renderer, scene),
        clock_(renderer),
        reduced_(renderer, gpu_, job.common, job.truth, choice, reduced_view(view)),
        full_(renderer, gpu_, job.common, job.truth, choice, view) {
    answer_.scene = choice.scene;
    answer_.lights = int(scene.lights.size());
    answer_.size = {view.width, view.height};
    answer_.reduced = {reduced_.view().width, reduced_.view().height};
    answer_.max_flip = job.max_flip;
    answer_.truth = job.truth;
    answer_.machine = machine_of(renderer);
  }

  WhichAnswer run() {
    start_all();
    drop_late_starters();
    Race race(entries_.size());
    while (!race.competing().empty() && !make_leader_accurate(race)) {
    }
    run_rounds(race);
    conclude(race);
    answer_.seconds = seconds();
    return std::move(answer_);
  }

 private:
  double seconds() const { return job_.before_s + timer_.elapsed_ms() / 1000; }
  void tell(const std::string& step) const {
    if (job_.progress) job_.progress(std::min(seconds() / job_.seconds, 1.0), step);
  }

  // Points that draw with the rasteriser in OpenCL first: they need no reference but their own, and the fastest
  // point, with which others are compared, is usually among them. Within both groups, exact points first.
  std::vector<ChosenPoint> in_order() const {
    std::vector<ChosenPoint> points = job_.points;
    std::ranges::stable_sort(points, {}, [&](const ChosenPoint& p) {
      const Contestant& c = p.contestant;
      const bool exact = !is_approximate(*c.technique, c.settings) &&
                         c.settings[setting::range] == job_.common[setting::range];
      return 2 * !has_own_surfaces(p) + !exact;
    });
    return points;
  }

  void start_all() {
    const std::vector<ChosenPoint> points = in_order();
    answer_.points.reserve(points.size());  // entries refer to them
    entries_.reserve(points.size());
    for (const ChosenPoint& point : points) {
      WhichPoint& about = answer_.points.emplace_back();
      about.point = described(answer_.scene, point);
      if (!entries_.empty() && !has_time_to_start()) continue;
      tell(point.label + " starts");
      const double before = seconds();
      Entry entry{about, PointRun(renderer_, gpu_, reduced_.view(), point, pool_)};
      about.fate = start(entry);
      if (!entry.run.refused().empty()) about.refused = entry.run.refused();
      if (about.fate == Fate::competes) entries_.push_back(std::move(entry));
      // The first one also compiles what all have in common.
      if (answer_.points.size() > 1) longest_start_s_ = std::max(longest_start_s_, seconds() - before);
    }
  }

  // Compiling cannot be interrupted.
  bool has_time_to_start() const {
    return seconds() < share_of_starts * job_.seconds &&
           seconds() + longest_start_s_ < (1 - share_of_rounds) * job_.seconds;
  }

  // The first frame compiles programs and does not count. A frame does not get faster with more pixels: a point
  // whose reduced frame is slower than the leader's complete one is slow.
  Fate start(Entry& entry) {
    const double flip = reduced_.flip_of(entry.run);
    if (!entry.run.refused().empty()) return Fate::refused;
    entry.point.reduced_flip = flip;
    const bool doubtful = !(flip <= reduced_factor * job_.max_flip);
    if (doubtful && !(has_capped_lists(entry.point) && can_measure_at_full_size())) return Fate::inaccurate;
    const double reduced_ms = entry.run.draw();
    const RaceTime reduced{reduced_ms, on_gpu() ? std::nullopt : entry.run.cpu_ms()};
    if (is_slower_by(1, reduced)) return slow(entry, reduced_ms);
    entry.start.wall_ms = std::numeric_limits<double>::infinity();
    for (const double factor : {one_frame_factor, two_frames_factor}) {
      const RaceTime time = time_of(timed_frames(std::vector{&entry.run}, view_, 1, clock_, [] {}), 0);
      if (!entry.run.refused().empty()) return Fate::refused;
      if (time.wall_ms < entry.start.wall_ms) entry.start = time;
      if (is_slower_by(factor, entry.start)) return slow(entry, entry.start.wall_ms);
    }
    entry.point.ms = Estimate{entry.start.wall_ms, entry.start.wall_ms, entry.start.wall_ms};
    if (doubtful) {
      entry.point.flip = flip_at_full_size(entry);
      if (!entry.run.refused().empty()) return Fate::refused;
      if (!(*entry.point.flip <= job_.max_flip)) return Fate::inaccurate;
    }
    if ((doubtful || flip <= job_.max_flip / reduced_factor) && entry.start.wall_ms < fastest_.wall_ms)
      fastest_ = entry.start;
    return Fate::competes;
  }

  Fate slow(Entry& entry, double ms) const {
    entry.point.ms = Estimate{ms, ms, ms};
    const double ratio = ms / fastest_.wall_ms;
    entry.point.relative_time = Estimate{ratio, ratio, ratio};
    return Fate::slow;
  }

  // By both clocks: the other one counts work, which may be spread over more cores.
  bool is_slower_by(double factor, const RaceTime& time) const {
    if (time.wall_ms <= factor * fastest_.wall_ms) return false;
    return !time.work_ms || !fastest_.work_ms || *time.work_ms > factor * *fastest_.work_ms;
  }

  // The leader may have started last.
  void drop_late_starters() {
    std::vector<Entry> kept;
    kept.reserve(entries_.size());
    for (Entry& entry : entries_) {
      if (is_slower_by(two_frames_factor, entry.start)) {
        entry.point.fate = slow(entry, entry.start.wall_ms);
      } else {
        kept.push_back(std::move(entry));
      }
    }
    entries_ = std::move(kept);
  }

  // The mean of the passes of run `i`.
  RaceTime time_of(const std::vector<std::vector<RoundTimes>>& passes, size_t i) const {
    RaceTime mean{0, 0};
    for (const std::vector<RoundTimes>& times : passes) {
      mean.wall_ms += times[i].ms / double(passes.size());
      std::optional<double> work = times[i].cpu_ms;
      if (on_gpu()) work = times[i].device ? std::optional(times[i].device->device_ms) : std::nullopt;
      if (!work || !mean.work_ms) {
        mean.work_ms.reset();
      } else {
        *mean.work_ms += *work / double(passes.size());
      }
    }
    return mean;
  }
  bool on_gpu() const { return !renderer_.cl->info().cpu; }

  // Drawing the reference at the view's size must leave time for the race.
  bool can_measure_at_full_size() {
    if (full_.reference_seconds() > 0) return true;
    const double pixels = double(view_.width) * view_.height,
                 reduced = double(reduced_.view().width) * reduced_.view().height,
                 time = std::min(share_of_reference * job_.seconds, end_s_ - seconds());
    return reduced_.reference_seconds() * pixels / reduced < time ||
           (reduced_.reference_seconds() < time &&
            reduced_.seconds_without_compiling() * pixels / reduced < time);
  }

  double flip_at_full_size(Entry& entry) {
    full_.exposure = reduced_.exposure;
    return full_.flip_of(entry.run);
  }

  // Measures the leader's error at the view's size, before others are compared with it. Returns whether it is
  // within the bound, and drops it otherwise.
  bool make_leader_accurate(Race& race) {
    const size_t leader = race.rounds() > 0 ? race.leader() : first_in_start(race);
    Entry& entry = entries_[leader];
    if (!entry.point.flip && can_measure_at_full_size()) {
      tell("error of " + entry.point.point.label);
      entry.point.flip = flip_at_full_size(entry);
    }
    if (entry.run.refused().empty() && entry.point.flip.value_or(*entry.point.reduced_flip) <= job_.max_flip)
      return true;
    entry.point.fate = entry.run.refused().empty() ? Fate::inaccurate : Fate::refused;
    entry.point.refused = entry.run.refused();
    race.drop(leader);
    return false;
  }

  size_t first_in_start(const Race& race) const {
    return *std::ranges::min_element(race.competing(), {},
                                     [&](size_t i) { return entries_[i].start.wall_ms; });
  }

  void run_rounds(Race& race) {
    if (race.competing().empty()) return;
    double longest_s = 0;  // each timed frame follows one that does not count
    for (const size_t i : race.competing())
      longest_s += 2 * frames_per_round * entries_[i].start.wall_ms / 1000;
    while ((!race.is_decided() || race.rounds() < min_race_rounds) &&
           seconds() + round_slack * longest_s < end_s_) {
      const double before = seconds();
      run_round(race);
      while (!race.competing().empty() && !make_leader_accurate(race)) {
      }
      if (race.competing().empty()) return;
      const size_t leader = race.leader();
      std::vector<Location> behind(entries_.size());
      for (const size_t i : race.competing()) behind[i] = race.behind(i, leader);
      for (const size_t i : race.drop_slower()) {
        entries_[i].point.fate = Fate::slow;
        entries_[i].point.relative_time = exponential(behind[i]);
      }
      longest_s = std::max(longest_s, seconds() - before);
    }
  }

  void run_round(Race& race) {
    std::vector<size_t> order = race.competing();
    shuffle(order, Random::mix(job_.seed) + uint64_t(race.rounds()));
    std::vector<PointRun*> runs;
    for (const size_t i : order) runs.push_back(&entries_[i].run);
    const auto step = [&] {
      tell(fmt::format("round {}, {} points compete", race.rounds() + 1, order.size()));
    };
    const auto passes = timed_frames(runs, view_, frames_per_round, clock_, step);
    std::vector<RaceTime> times(entries_.size());
    for (size_t place = 0; place < order.size(); ++place) {
      Entry& entry = entries_[order[place]];
      if (!entry.run.refused().empty()) {
        entry.point.fate = Fate::refused;
        entry.point.refused = entry.run.refused();
        race.drop(order[place]);
        continue;
      }
      times[order[place]] = time_of(passes, place);
      entry.log_ms.push_back(std::log(times[order[place]].wall_ms));
      ++entry.point.rounds;
    }
    race.add_round(times);
  }

  void conclude(Race& race) {
    answer_.rounds = race.rounds();
    for (Entry& entry : entries_) {
      if (!entry.log_ms.empty()) entry.point.ms = exponential(hodges_lehmann(entry.log_ms));
    }
    if (race.competing().empty()) {
      answer_.closest = closest();
      return;
    }
    if (race.by_work()) answer_.clock = on_gpu() ? "device" : "cpu";
    const size_t best = race.rounds() > 0 ? race.leader() : first_in_start(race);
    for (const size_t i : race.competing()) {
      if (i == best || race.rounds() == 0) continue;
      entries_[i].point.relative_time = exponential(race.behind(i, best));
    }
    entries_[best].point.relative_time = Estimate{1, 1, 1};
    answer_.choice = index_of(entries_[best].point);
    answer_.runner_up = next_in_time();
    answer_.confidence = confidence(race, best);
  }

  size_t index_of(const WhichPoint& point) const { return size_t(&point - answer_.points.data()); }

  // Among the points within the error.
  std::optional<size_t> next_in_time() const {
    std::optional<size_t> next;
    for (size_t i = 0; i < answer_.points.size(); ++i) {
      const WhichPoint& p = answer_.points[i];
      if (i == answer_.choice || !p.relative_time) continue;
      if (!(p.flip.value_or(*p.reduced_flip) <= job_.max_flip)) continue;
      if (!next || p.relative_time->value < answer_.points[*next].relative_time->value) next = i;
    }
    return next;
  }

  std::optional<size_t> closest() const {
    std::optional<size_t> closest;
    for (size_t i = 0; i < answer_.points.size(); ++i) {
      const auto flip_of = [&](size_t p) {
        return answer_.points[p].flip.value_or(*answer_.points[p].reduced_flip);
      };
      if (!answer_.points[i].reduced_flip || std::isnan(flip_of(i))) continue;
      if (!closest || flip_of(i) < flip_of(*closest)) closest = i;
    }
    return closest;
  }

  // The share of draws in which no other runner is faster, less the probability that the fastest was dropped.
  double confidence(const Race& race, size_t best) const {
    const std::vector<size_t>& competing = race.competing();
    if (competing.size() < 2) return 1 - Race::max_wrong;
    if (race.rounds() < 2) return 0;
    std::vector<LogTimes> times;
    for (const size_t i : competing) times.push_back(race.log_times(i, best));
    const auto drawn = drawn_log_times(times, 0, draws, job_.seed);
    const size_t place = size_t(std::ranges::find(competing, best) - competing.begin());
    const auto wins = std::ranges::count_if(drawn, [&](const std::vector<double>& draw) {
      return draw[place] <= *std::ranges::min_element(draw);
    });
    return std::max(0.0, double(wins) / double(drawn.size()) - Race::max_wrong);
  }

  Renderer& renderer_;
  const WhichJob& job_;
  const View view_;
  const Timer& timer_;
  GpuScene gpu_;
  DeviceClock clock_;
  SceneErrors reduced_, full_;
  const std::shared_ptr<TargetPool> pool_ = std::make_shared<TargetPool>();
  const double end_s_ = (1 - share_of_end) * job_.seconds;
  double longest_start_s_ = 0;
  WhichAnswer answer_;
  std::vector<Entry> entries_;
  RaceTime fastest_{std::numeric_limits<double>::infinity()};  // whose error is surely within the bound
};

}  // namespace

std::vector<ChosenPoint> which_points(const std::vector<std::string>& techniques, const Settings& common,
                                      bool opengl, const std::optional<FrontierTruth>& shadows) {
  std::vector<ChosenPoint> points = chosen_points(techniques, {}, common, opengl, shadows);
  if (!techniques.empty()) return points;
  const bool has_ranges = common[setting::range] != LightRange::infinite;
  std::erase_if(points, [&](const ChosenPoint& p) {
    return p.contestant.settings[setting::brdf] != common[setting::brdf] || (has_ranges && adds_light(p));
  });
  return points;
}

WhichAnswer which(Renderer& renderer, const SceneChoice& choice, const WhichJob& job) {
  const Timer timer;
  const ChosenScene chosen = load_chosen_scene(choice);
  return Contest(renderer, chosen.scene, chosen.view, choice, job, timer).run();
}

}  // namespace lightgrid::lab
