// The measurements of a frontier: one record for each point and view. Everything that the answer states
// (fronts, ties, break-evens, growth, failures) is computed from records alone, so that parts measured by
// several processes are joined by joining their records.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/log.h"
#include "frontier/conditions.h"
#include "measures/flicker.h"
#include "measures/flip.h"
#include "measures/results.h"

namespace lightgrid::lab {

// A technique with settings on a scene.
struct FrontierPoint {
  std::string scene;      // as given: a path or a built-in name
  std::string technique;  // its name
  std::map<std::string, std::string>
      settings;       // all of the settings that it reads, by the keys of results.json
  std::string label;  // "forward_plus:tile=8": what differs from the defaults
  int frames = 1;     // averaged frames, each with other random numbers; 1: not averaged
};

// The picture against the truth in double, at a random pixel of each of `pixels` equal shares of the opaque
// ones, in the measures of the frontier.
struct SampledErrors {
  int pixels = 0;
  ImageError picture;           // without flip_mean
  ImageError picture_in_float;  // the picture at the same pixels against the truth in float
  ImageError truth;             // that truth against the one in double: how far the two above may be apart
};

// Against every light with the range that the sweep's settings give it, over that picture's brightest
// channel.
struct AuthoredErrors {
  ImageError model;  // the meaning of the settings
  ImageError total;  // the picture
};

// The spread of random ranges and lists over independent pictures, of which errors are means.
struct SeedErrors {
  int pictures = 0, flip_pictures = 0;              // and of them those of which FLIP was measured
  ImageError deviation;                             // per measure of the total, from picture to picture
  double bias_mse_rel = 0, bias_mse_rel_error = 0;  // over the brightest channel squared (BiasOfPictures)
};

// Frames of each sequence that count.
inline constexpr int frames_of_sequence = 64;

// One sequence: its frames as they are drawn, and their mean over frames (FlickerMeter).
struct SequenceError {
  SequenceFigures plain, filtered;
};

// From the scene's first view, against the truth's frames (docs/details/frontier.md#sequences).
struct SequenceErrors {
  int frames = frames_of_sequence;
  SequenceError still;          // other random numbers in each frame
  SequenceError dolly;          // the camera moves forward
  SequenceError moving_lights;  // each light on an orbit
};

// Errors kept apart (docs/frontier.md#errors), in the measures of the frontier (frontier_error). Truth: every
// light, no range window.
struct PointErrors {
  // `displayed`: of model and total.
  ImageError model;  // meaning of the settings (range, window, BRDF) against the truth, both by brute force
  ImageError precision;  // brute force in float against the oracle in double, at a sample of pixels
  ImageError technique;  // the picture against brute force of the same meaning
  ImageError total;      // the picture against the truth
  std::optional<SampledErrors> in_double;  // the same against the truth in double, at a sample of pixels
  std::optional<AuthoredErrors> authored;  // where the truth's lights have no ranges and those of settings do
  std::optional<SeedErrors> seeds;         // for random points; total and authored are then means over them
  // For these points, root mean squares over pixels, relative like the others: of the expected picture's
  // error (random ranges: against the truth; lists: against what the settings mean), 0 where it is not above
  // the noise, and of the standard deviation of one frame.
  std::optional<double> bias_rmse_rel, deviation_rmse_rel;
  // Flicker: how much the picture's difference from the truth changes from frame to frame while the camera
  // turns by a quarter of a degree a frame; root mean square over pixels and frames.
  std::optional<double> temporal_rmse_rel;
  std::optional<SequenceErrors> sequences;  // for the first view, where requested
  // For points with surfaces of their own: the truth on these against the truth on OpenGL's, of the same
  // view. Smaller errors do not compare such points with those that draw with OpenGL. Empty: there is one
  // truth for both, of areas, or no OpenGL.
  std::optional<ImageError> surfaces;
};

// The lights of a truth that is not the usual one of every light without a range (docs/frontier.md#shadows),
// or the mean over pixels' areas (docs/frontier.md#samples).
struct FrontierTruth {
  bool own_ranges = false;      // the ranges of the sweep's settings
  double source_m = 0;          // lights that cast are spheres of this radius, in metres; 0: points
  int shadow_rays = 1;          // for each pixel and light that casts
  std::optional<int> places{};  // places per pixel, whose area's mean it is; empty: pixels' centres

  bool operator==(const FrontierTruth&) const = default;
};

// A point of another renderer (frontier/external.h).
struct ExternalPoint {
  std::string note;    // its author's note
  bool paired = true;  // timed in the rounds, beside the baseline; otherwise by its author, elsewhere

  bool operator==(const ExternalPoint&) const = default;
};

struct FrontierRecord {
  FrontierPoint point;
  int view = 0;               // index on the scene's path
  int width = 0, height = 0;  // pixels
  int lights = 0;             // lights in the scene
  double radius_scale = 1;    // scale of the lights' ranges, in the series "radius"
  // Empty: a point of the front; "lights", "pixels", "radius": of a growth curve; "equal overlap", "overlap":
  // of a family of lights (families.h); "control 0", "control 1", …: the baseline, timed as a point.
  std::string series;
  // For a family: mean number of lights that reach a covered pixel, with their own ranges, by the oracle.
  std::optional<double> overlap;
  std::optional<uint64_t> pair_pixels;  // at which `pairs` were counted; empty: at all covered ones
  std::optional<FrontierTruth> truth;   // empty: every light without a range
  // For a point of another renderer. Its technique is the renderer's name; pairs, bytes and the errors of
  // model, precision and technique are unknown (NaN).
  std::optional<ExternalPoint> external;

  std::string refused;                        // why it did not run; the fields below are then empty
  std::vector<double> frame_ms, baseline_ms;  // equal length; entry i of both ran one after the other
  // By the devices' own clocks (DeviceTimes), of the same runs; empty, or fewer, where a device has none.
  std::vector<double> device_ms, hand_over_ms, copy_ms, read_back_ms, baseline_device_ms;
  std::vector<double> cpu_ms, baseline_cpu_ms;  // processor time of the process in the same runs; or empty
  std::vector<int> processes;                  // for each run: the number of the process that took it, from 0
  int frames_per_round = 1;                    // successive runs that are one round
  std::map<std::string, double> pass_ms;       // medians of profiled frames
  std::map<std::string, uint64_t> pass_bytes;  // read and written, where counted; of the same passes
  // Times of culling, one a round: entry i of points that differ in the cull test alone was taken in one
  // round. Empty: no such point, or another view than the first.
  std::vector<double> cull_ms;
  uint64_t bytes_moved = 0;  // sum of the passes' counted bytes, on the first view; otherwise 0
  uint64_t memory_bytes = 0;
  uint64_t covered_pixels = 0;  // with an opaque surface
  PairCounts pairs;             // shadows: where these are hard, for each pair (counts_shadow_pairs)
  uint64_t nan_pixels = 0, overflow = 0;
  PointErrors errors;
  std::optional<FlipExposures> flip;  // with which errors.total.flip_mean was measured
  std::optional<double> exposure_ev;  // the scene's pictures have it, and displayed FLIP
  std::string image;  // name of its picture among the part's pictures, without extension; empty: none
  // The shard of the part that holds it, set by RecordFile and read_part: its times are of that machine.
  // Times that are not paired belong to no round: they have their own number, unpaired_shard or more.
  int shard = 0;
};

// The circumstances of all records of one process.
struct FrontierMachine {
  std::string cl_device, gl_device, cl_driver, gl_driver;
  std::string cpu, governor;                  // governor: "unknown" where the system does not tell
  std::string cl_kind;                        // "CPU" or "GPU"; empty: unknown
  std::string picture = "float";              // that timed frames end with, as the setting has it
  double clock_mhz = 0;                       // at the start; 0: unknown
  int threads = 0;                            // compute units of the OpenCL device
  double load_at_start = 0, load_at_end = 0;  // the system's one-minute load average
  int shard = 0;                              // the measuring part's, set by RecordFile and read_part
};

inline constexpr int unpaired_shard = 1'000'000;

// Half of the 95 % interval of a relative time at which rounds end.
inline constexpr double default_half_width = 0.01;

// A part: one process's records. Deterministic: shard i of n of the same request holds the same points.
inline bool is_control(const FrontierRecord& r) { return r.series.starts_with("control"); }

inline bool is_unpaired(const FrontierRecord& r) { return r.external && !r.external->paired; }
inline constexpr const char* equal_overlap_series = "equal overlap";  // over the number of lights
inline constexpr const char* overlap_series = "overlap";              // at an equal number
inline bool is_of_family(const FrontierRecord& r) {
  return r.series == equal_overlap_series || r.series == overlap_series;
}

struct FrontierPart {
  std::string request;  // hash of scenes, points, views, size and seed: parts of one sweep agree in it
  std::string commit;
  uint64_t seed = 1;
  int shard = 0, shards = 1;
  std::string baseline;          // label of the baseline point
  std::string keep = "overlap";  // what growth over lights keeps (Kept); in parts of earlier versions that
  double half_width = default_half_width;   // that rounds end at, as a share of a relative time
  std::map<std::string, int> points_asked;  // by scene, of this shard; empty in parts of earlier versions
  FrontierMachine machine;
  int processes = 0;                           // that took times
  std::vector<FrontierConditions> conditions;  // one a round and process
  std::vector<Warning> warnings;               // that the run logged, when it finished
  bool finished = false;                       // nothing more was to be measured: RecordFile::finish
  std::vector<FrontierRecord> records;
};

}  // namespace lightgrid::lab
