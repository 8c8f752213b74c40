// The answer that records give: for each point its figures over the views, the Pareto front of each scene,
// ties, break-evens, growth, failures, and sentences in plain words.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "frontier/paired_times.h"
#include "frontier/record.h"

namespace lightgrid::lab {

// A median with its 95 % nonparametric confidence interval (order statistics).
struct MedianInterval {
  double median = 0, low = 0, high = 0;
  int runs = 0;
};

// True if no point of its scene is better in both displayed FLIP and relative time; probability: the share of
// draws of the scene's times in which none is. NaN: not measured, with fewer than min_rounds rounds or a
// control that failed.
struct OnFront {
  bool on = false;
  double probability = 0;
  // The same over draws of times and errors from what views leave open; NaN too if fewer than two were timed.
  double over_views = 0;
};

// A point's times by the devices' own clocks (DeviceTimes); otherwise as in PointFigures. No runs:
// unknown.
struct DeviceFigures {
  MedianInterval device_ms, hand_over_ms, copy_ms, read_back_ms;
  PointTimes times;  // of device_ms
  RelativeTime relative_time;
  std::map<std::string, OnFront> fronts;
};

// Processor time of the process, with the drivers' threads; otherwise as in PointFigures. No runs: unknown.
struct CpuFigures {
  MedianInterval cpu_ms;
  PointTimes times;
  RelativeTime relative_time;
  std::map<std::string, OnFront> fronts;
};

// The clock that decides in a scene: whether controls passed, points are on the front, and a time is worse.
enum class Clock { wall, cpu, device };
inline constexpr const char* clock_names[] = {"wall", "cpu", "device"};

// A point over all its views. Errors: the largest max_rel, otherwise root mean squares or means over views.
struct PointFigures {
  FrontierPoint point;
  int views = 0, timed_views = 0;  // with errors; the first of them, with times
  int width = 0, height = 0;       // pixels
  MedianInterval frame_ms;         // sum over timed views, divided by their number
  double p95_ms = 0, p99_ms = 0;   // percentiles of all timed frames
  PointTimes times;                // relative to the baseline's frames in the same round and view
  RelativeTime relative_time;
  PointErrors errors;
  int flip_views = 0, temporal_views = 0;  // that have FLIP, and flicker
  // 95 % intervals over views (bootstrap_interval) by error, "total" or "authored", and measure; empty where
  // there are fewer than six.
  std::map<std::pair<std::string, std::string>, std::pair<double, double>> over_views;
  PairCounts pairs;                    // sums over views
  std::optional<FrontierTruth> truth;  // empty: every light without a range
  std::optional<ExternalPoint> external;
  std::optional<double> exposure_ev;           // exposure of the scene's pictures
  uint64_t memory_bytes = 0;                   // the largest of the views
  uint64_t bytes_moved = 0;                    // a frame of the views that were profiled: the first
  std::map<std::string, double> pass_ms;       // medians of profiled frames
  std::map<std::string, uint64_t> pass_bytes;  // read and written; parts of earlier versions have none
  uint64_t nan_pixels = 0;
  std::map<std::string, OnFront> fronts;  // by the error that it is of (front_errors)
  DeviceFigures device;
  CpuFigures cpu;
  Clock decides = Clock::wall;
  // By view, the errors of which there are fronts.
  std::map<std::string, std::map<int, double>> front_errors_by_view;

  const RelativeTime& deciding_time() const {
    return decides == Clock::device ? device.relative_time
           : decides == Clock::cpu  ? cpu.relative_time
                                    : relative_time;
  }
  const std::map<std::string, OnFront>& deciding_fronts() const {
    return decides == Clock::device ? device.fronts : decides == Clock::cpu ? cpu.fronts : fronts;
  }
};

// The percentage of pairs of a pixel and a casting light in range that are shaded though hidden, and dark
// though seen. None where shadows were not counted, or there is no such pair.
std::optional<double> leaked_percent(const PairCounts& pairs);
std::optional<double> acned_percent(const PairCounts& pairs);

// "If a FLIP of … is acceptable, use …": the point of least time whose mean FLIP as displayed is at most
// `error`, picked on one half of the rounds and reported on the other.
struct CheapestWithin {
  std::string scene, of;  // of: the error (front_errors)
  double error = 0;
  int point = 0;               // index
  RelativeTime relative_time;  // in the rounds that it was not picked on; with a single round, in that one
  double probability = 0;  // the share of draws of the scene's times in which it is the cheapest, as OnFront
  double over_views = 0;   // likewise
};

// Points of a scene that the sweep was asked for, and those of them that ran.
struct Coverage {
  std::string scene;
  int measured = 0, asked = 0;
};

// The baseline, timed as points of its own at several places of each round: what differs from 1 is no
// technique's.
struct Control {
  std::string scene;
  RelativeTime relative_time;  // over all places together
  std::vector<double> places;  // the estimate of each
  // 1 is in the interval, if there is one, and within 1 % of the estimate.
  bool passed() const;
  // The logarithm by which the intervals of the scene's points are wider: 0 if it passed, otherwise what the
  // control is off by.
  double widening() const;
};

// "forward", or of a series "forward, 10,000 lights".
std::string label_in_series(const FrontierRecord& record);

// The state of the machine in those rounds of a process in which it could be read.
struct ProcessConditions {
  int shard = 0, process = 0, rounds = 0;
  // Largest and, of clock and power, least: least, largest.
  std::optional<double> others_percent, steal_percent, temperature_c;
  std::optional<std::pair<double, double>> clock_mhz, power_w;
  int shared_rounds = 0, throttled_rounds = 0;  // is_shared, is_throttled
};

// A point that draws without OpenGL, over the scene's point `visibility` as it is: round by round, so that
// the sweep's baseline cancels. No runs: one of the two has no such times.
struct AmongOpenCl {
  std::string scene;
  int point = 0, over = 0;  // indices
  RelativeTime relative_time, relative_device_time;
};

struct FrontBand {
  std::string scene, of;  // of: the error (front_errors)
  std::vector<BandStep> steps;
};

// The shading cost from which the tighter of two cull tests is worth its time: extra culling time over pairs
// saved.
struct BreakEven {
  std::string scene, tighter, looser;  // labels; otherwise of equal settings. Tighter: lists fewer pairs
  double ns_per_pixel_light = 0;       // infinite: the tighter test never wins; 0: it always does
  double extra_ms = 0;                 // extra time of culling the first view: the median over rounds of both
  double pairs_saved = 0;              // listed pairs of that view
  // 95 % interval of ns_per_pixel_light, from that of the median (median_interval); rounds: 0 if there is
  // none, since pass times are known by their medians alone, or no pair is saved.
  double low = 0, high = 0;
  int rounds = 0;
};

struct ShadingCost {  // on this machine, a slope over points of one technique and BRDF
  std::string scene, technique, brdf;
  double ns_per_pixel_light = 0;
  double low = 0, high = 0;  // 95 % interval of the slope (Student's t); infinite without a degree of freedom
};

// time = c x^exponent, least squares in logarithms, with a 95 % interval (power_law).
struct Growth {
  std::string scene, technique, of;  // technique: the point's label; of: the series
  double exponent = 0, low = 0, high = 0;
  std::vector<std::pair<double, double>> samples;  // x, median ms
  std::string kept = {};                           // over lights: FrontierPart::keep
};

// For a family of lights: the cheapest point of each technique whose displayed FLIP stays within a bound,
// along the family. Picked on every second of its rounds; its time is the median of the others.
struct EqualFlip {
  struct Sample {
    double x = 0;  // lights, or the overlap
    std::string label;
    double ms = 0;
  };
  std::string scene, technique, series, of;  // of: the error (front_errors)
  double error = 0;
  std::vector<Sample> samples;             // where a point is within it
  double exponent = 0, low = 0, high = 0;  // as in Growth
};

struct Failure {
  FrontierPoint point;
  std::string cause;  // "refused", "lost", "wrong", "shadow", "NaN" or "overflow"
  std::string why;    // in words, with the figure
};

struct FrontierAnswer {
  FrontierPart part;  // the first part; records of all parts
  std::vector<FrontierMachine> machines;
  std::vector<PointFigures> points;
  std::vector<Coverage> coverage;  // for scenes whose parts record what was requested
  std::vector<Control> controls;
  std::vector<ProcessConditions> processes;
  std::vector<CheapestWithin> cheapest_within;
  std::vector<FrontBand> front_bands;
  std::vector<Control> device_controls, cpu_controls;  // by these clocks
  std::vector<CheapestWithin> device_cheapest_within;
  std::vector<FrontBand> device_front_bands;
  // GPUs' frames end with a copy of the picture that can take longer than all else: where OpenCL runs on one
  // and the devices have clocks, sentences and the page are of these.
  bool by_device = false;
  std::vector<AmongOpenCl> among_opencl;  // empty for a sweep whose baseline draws without OpenGL
  std::vector<BreakEven> break_even;
  std::vector<ShadingCost> shading_costs;
  std::vector<Growth> growth;
  std::vector<EqualFlip> equal_flip, device_equal_flip;  // by the wall, by the devices' clocks
  std::vector<Failure> failures;
  std::vector<std::string> sentences;  // one paragraph, sentence by sentence
};

// Pure. Throws Error(input) if the parts are not of one sweep (check_same_sweep).
FrontierAnswer answer_of(const std::vector<FrontierPart>& parts);

// The version of frontier.json; docs/frontier_json.md lists the differences of versions 1 and 2.
inline constexpr int frontier_schema_version = 3;

// frontier.json, frontier.csv (one row a point and view: each record of `answer.part`), samples.csv (one row
// a run of such a row) and culling.csv (one row a round in which its culling was timed).
nlohmann::json to_json(const FrontierAnswer& answer);
std::string csv_text(const FrontierAnswer& answer);
std::string samples_csv_text(const FrontierAnswer& answer);
std::string cull_csv_text(const FrontierAnswer& answer);

// One self-contained HTML file made of frontier/page/*, parts of report/page/* and frontier.json. Pictures
// are those that records name (FrontierRecord::image) in `pictures`, in at most `max_picture_bytes` of text
// (page_pictures); without such files the page shows none.
std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures = {},
                      size_t max_picture_bytes = size_t(24) << 20);

// Writes all of these. Pictures that records name are looked for in `pictures` and copied into DIR/pictures
// if they are elsewhere; the page holds at most `page_bytes` of them.
void write_answer(const std::filesystem::path& folder, const FrontierAnswer& answer,
                  const std::vector<std::filesystem::path>& pictures, size_t page_bytes);

// A frontier held against an earlier one: what got worse.
struct GateResult {
  std::vector<std::string> worse;  // one sentence each; empty: the gate is passed
  std::vector<std::string> told;   // figures that were not compared, and why; no failure
};

// frontier.json, as to_json(FrontierAnswer) gives it. Throws Error(input) that names the file.
nlohmann::json read_frontier_json(const std::filesystem::path& path);

// Points are the same if scene, label, averaged frames and size agree. Worse is: an error that is more
// than 1.001 times the earlier one and 1e-9 larger, or finite no more; more pairs lost or wrong, or more
// pixels with NaN, than earlier; a relative time whose 95 % interval lies above the earlier one's; a refusal
// of what ran earlier; a control that did not pass, whatever it was earlier. A point of other views, or that
// is on one side only, is told. Throws Error(input) that names `earlier_name` and the field if `earlier` is
// malformed, is of another seed or baseline, or has no point to compare.
GateResult held_against(const nlohmann::json& now, const nlohmann::json& earlier,
                        const std::string& earlier_name);

}  // namespace lightgrid::lab
