// The fastest technique and settings for one view of a scene within an error, by a race: all points start, and the
// time goes to those that still compete (docs/which.md).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "frontier/measure.h"

namespace lightgrid::lab {

struct WhichJob {
  std::vector<ChosenPoint> points;
  Settings common;  // settings of the reference
  FrontierTruth truth;
  double max_flip = 0.05;  // mean FLIP of the pictures as displayed
  double seconds = 30;     // until the answer
  double before_s = 0;     // the part of them that passed before the call
  uint64_t seed = 1;
  std::function<void(double done, const std::string& step)> progress = nullptr;
};

// An estimate with its 95 % interval.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

// The outcome of the race for a point.
enum class Fate { not_started, refused, inaccurate, slow, competes };
const char* name_of(Fate fate);  // "not started", ...

struct WhichPoint {
  FrontierPoint point;
  Fate fate = Fate::not_started;
  std::string refused;                    // why it did not run
  std::optional<double> reduced_flip;     // at WhichAnswer::reduced
  std::optional<double> flip;             // at the view's own size
  std::optional<Estimate> ms;             // wall-clock time; no interval (low = high) before the rounds
  std::optional<Estimate> relative_time;  // relative to the leader when it was dropped, or to the choice
  int rounds = 0;                         // that it took part in
};

struct WhichAnswer {
  std::string scene;
  int lights = 0;
  ImageSize size, reduced;
  double max_flip = 0, seconds = 0;  // seconds: that it took
  FrontierTruth truth;
  FrontierMachine machine;
  std::vector<WhichPoint> points;   // in the order in which they started
  std::optional<size_t> choice;     // among points; empty: none is within max_flip
  std::optional<size_t> runner_up;  // likewise, the next in time
  std::optional<size_t> closest;    // the least error, if none is within max_flip
  double confidence = 0;            // that no other point within the error is faster
  int rounds = 0;
  std::string clock = "wall";  // the clock that decided at the end: "wall", "cpu" or "device"
};

// The default points of a sweep, without those that make another picture: other reflection models and, if lights have
// ranges, points that add light beyond them.
std::vector<ChosenPoint> which_points(const std::vector<std::string>& techniques, const Settings& common,
                                      bool opengl, const std::optional<FrontierTruth>& shadows);

// Throws Error for what concerns the whole scene. A point that cannot run is refused.
WhichAnswer which(Renderer& renderer, const SceneChoice& choice, const WhichJob& job);

// How the answer changes: the same race among the fastest points with twice and four times the lights, scattered
// with the ranges of the scene's number of lights, and at twice the size. Each takes up to job.seconds.
struct WhichChange {
  std::string what;  // "512 scattered lights", "1280x720"
  WhichAnswer answer;
};
std::vector<WhichChange> changes_of(Renderer& renderer, const SceneChoice& choice, const WhichJob& job,
                                    const WhichAnswer& answer);

// "visibility:tile=32: 21.3 ms per frame (21.1 to 21.5), FLIP 0.012; next: ...".
std::string in_words(const WhichAnswer& answer);
nlohmann::ordered_json to_json(const WhichAnswer& answer);
std::string which_page(const WhichAnswer& answer, const std::vector<WhichChange>& changes);

}  // namespace lightgrid::lab
