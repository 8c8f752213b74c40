// Results of one technique on one view, as in `render --json` and `compare`'s results.json
// (docs/results_json.md).
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/image.h"
#include "base/log.h"
#include "plan/plan_changes.h"
#include "run/frame_figures.h"

namespace lightgrid::lab {

// The frame's shadows at the same pairs, according to the oracle (docs/oracle.md#seen-and-hidden).
struct ShadowPairs {
  uint64_t leaked = 0, acned = 0, either = 0;
  uint64_t pixels = 0;     // at which they were decided
  uint64_t pairs = 0;      // pairs of these pixels and casting lights in range, directional ones too
  bool says_exact = true;  // the technique and its settings: leaked and acned must be 0

  ShadowPairs& operator+=(const ShadowPairs& other);

  uint64_t faults() const { return says_exact ? leaked + acned : 0; }
};

// The same, for pairs of a fragment of a blended surface and a light.
struct BlendedPairs {
  uint64_t lit = 0, leaked = 0, acned = 0, either = 0;
  bool says_exact = true;

  uint64_t faults() const { return says_exact ? leaked + acned : 0; }
};

// (pixel, light) pairs over the image. lit: according to the oracle.
struct PairCounts {
  uint64_t listed = 0, lit = 0, lost = 0, wrong = 0;
  std::optional<ShadowPairs> shadows = {};   // where some light casts
  std::optional<BlendedPairs> blended = {};  // likewise, and where a blended surface is in view

  PairCounts& operator+=(const PairCounts& other);  // shadows: of those that have them; blended stay
};

// This image and the reference's, each compared with the oracle at the same pixels: a sample of the view and
// the pixels at which the two differ most. Relative to the reference's brightest channel.
struct OracleError {
  double max_rel = 0, rmse_rel = 0;
  double of_reference_max_rel = 0;
};

// A technique that rasterises by its own code shows another opaque triangle than OpenGL at some pixels. The
// difference is measured at the others, relative to the reference's brightest channel.
struct SilhouetteError {
  uint64_t silhouettes = 0;
  uint64_t blended = 0;  // further pixels that are not compared: a blended surface covers them or a neighbour
  uint64_t inside = 0;   // compared
  double max_rel = 0, rmse_rel = 0, p99_rel = 0;
};

// An image against light and surfaces both in double, textures included (oracle/scene_surfaces.h), at a
// sample of pixels. Relative to the brightest channel of the reference's image, but for the sums.
struct SurfacesError {
  uint64_t pixels = 0;
  double sum_rel = 0;  // the image's sum of all channels over that in double, less 1
  double max_rel = 0, rmse_rel = 0, p99_rel = 0;
};

// An image against the mean over each pixel's area in double (oracle/pixel_area.h), at a sample of pixels,
// apart where those have edges and where not. Relative to the brightest channel of the reference's image;
// shown: to what a display shows as white, and light above that counts as white.
struct AreaError {
  struct Part {
    uint64_t pixels = 0;
    double max_rel = 0, rmse_rel = 0, rmse_shown = 0;
  };
  Part edges, inside;
};

// FLIP between two pictures as they are displayed, the bytes of their PNG files. `visible`: of the pixels,
// the share whose FLIP is above visible_flip. A uniform difference of one unit of CIELAB, which is about what
// an eye can notice, has 0.06.
inline constexpr double visible_flip = 0.05;
struct DisplayedFlip {
  double mean = 0, visible = 0;
};

inline constexpr double unknown_error = std::numeric_limits<double>::quiet_NaN();

// Linear light, over all pixels and the three colour channels; if the reference is a sample, over its pixels.
struct ImageError {
  double max_abs = 0;
  double max_rel = 0;  // max_abs relative to the reference's brightest channel
  double rmse = 0;
  double p99 = 0;  // 99th percentile of each pixel's largest absolute error
  std::optional<double> flip_mean;
  bool bit_identical = true;
  std::optional<OracleError> oracle;  // absent if not requested
  // Absent where OpenGL draws the surfaces, and where the reference is a sample.
  std::optional<SilhouetteError> silhouettes;
  std::optional<SurfacesError> surfaces;  // absent if not requested
  // Relative to the brightest channel of the reference or, in the frontier, of the truth.
  double rmse_rel = 0;
  double p99_rel = 0;
  double relative_rmse = 0;  // in the frontier: over the truth's channel, at least 1e-3 of the brightest
  std::optional<DisplayedFlip> displayed;  // absent if not requested
  std::optional<AreaError> area;           // absent if no row has several samples a pixel
  // In the frontier, as in LightDifference. NaN: not measured, as of a sample of pixels the low-pass one.
  double rel_mse = unknown_error;
  double rel_mse_trimmed = unknown_error;
  double smape = unknown_error;
  double smape_trimmed = unknown_error;
  double energy_rel = unknown_error;
  double rmse_of_mean = unknown_error;
  double low_pass_rmse_of_mean = unknown_error;
};

// Over a camera path. Errors are against the reference's image of the same frame, relative to its brightest
// channel of all frames.
struct MovingResult {
  size_t frames = 0;
  Spread frame_ms;      // move and frame, without the first two
  Spread resting_ms;    // the same views again, nothing changed
  Spread over_resting;  // frame_ms over resting_ms, view by view
  double max_abs = 0, max_rel = 0, rmse_rel = 0;
  // Change of the difference from the reference between frames: flicker that the scene does not have.
  double temporal_max_rel = 0, temporal_rmse_rel = 0;
  PairCounts pairs;
  uint64_t nan_pixels = 0;
  // After the first two frames.
  int gl_programs = 0, cl_programs = 0;  // compiled
  size_t scene_bytes = 0;                // uploaded
  std::vector<PlanChange> plan_changes;  // by frame
};

// The whole process's memory along a camera path.
struct PathMemory {
  size_t frames = 0;  // after which `bytes` were resident: 100, or half of a short path
  size_t bytes = 0, bytes_at_end = 0;
};

// Half of a listed light is far more; 8-bit geometry buffers lose less.
inline constexpr double max_unshaded = 0.01;

// How much an image's error, the sum of its channels with their signs, changes from a pixel to the next one
// in its row or column: mean over pairs of pixels in two tiles, and in one, relative to the brightest
// channel. Equal where tiles are not to be seen in the image.
struct ErrorSteps {
  double at_borders = 0, inside = 0;
};

// The light that is lost because lists lack lights by design, against every light on the same surfaces.
struct LimitedLists {
  double lost_light = 0;  // the share of all radiance, over all channels and pixels; below 0: it has more
  ErrorSteps steps;
};

struct RunResult : FrameFigures {
  std::string refused;              // why the machine or the technique cannot do this; empty if it ran
  std::optional<PairCounts> pairs;  // absent without the oracle
  std::optional<ImageError> error;  // technique error: this image against the float image with every light
  // Set if surfaces are drawn in OpenCL. The light is then judged by `same_surfaces`: this image against
  // every light on these surfaces, relative to the brightest channel of `error`. Absent if that was not
  // drawn.
  bool own_surfaces = false;
  std::optional<ImageError> same_surfaces;
  // The share of every light's light that is not in the image although no list lacks a light: above
  // max_unshaded, its loop does not shade what it lists. Absent if lists may miss lights, where the
  // picture is not forward's by nature, and where every light was not drawn on these surfaces.
  std::optional<double> unshaded;
  uint64_t overflow = 0;
  std::optional<LimitedLists>
      limited;  // absent with lists of any length, and if `unshaded` could not be known
  std::optional<MovingResult> moving;  // absent without a camera path
};

// The technique that shades every light at every pixel, on OpenGL's surfaces or on those drawn in OpenCL.
const char* every_light_on(bool own_surfaces);

// The error of the row's light apart from its surfaces: against every light on the same ones. Null if
// unknown.
const ImageError* light_error(const RunResult& row);

// {"ev", "auto"}
nlohmann::json exposure_json(const Exposure& exposure);

// Settings by the keys of results.json, numbers as numbers.
nlohmann::json settings_json(const std::map<std::string, std::string>& settings);

// [{"text", "settings", "command"}]; command is null if there is none.
nlohmann::json warnings_json(const std::vector<Warning>& warnings);

nlohmann::json pairs_json(const PairCounts& pairs);
nlohmann::json to_json(const RunResult& result);

// Two spaces a level and a newline at the end; bytes that are not UTF-8 (possible in a path) become U+FFFD.
std::string json_text(const nlohmann::json& value);
std::string json_text(const RunResult& result);

// Errors that all techniques share (docs/conventions.md#errors).
struct ReferenceErrors {
  ImageError model;              // range window on against off, both in double
  ImageError precision;          // every light in float against every light in double
  uint64_t pixels_left_out = 0;  // covered by blended surfaces, which the oracle cannot shade
};

// Every light on the surfaces that rows draw in OpenCL, against the reference, which has OpenGL's: what the
// surfaces alone differ by (texture filters, edges).
struct OwnSurfaces {
  std::string why_not;              // it was not drawn; empty if it was
  std::optional<ImageError> error;  // with `surfaces`, `silhouettes` and `displayed`
  // Its times and passes, if no row shows what shorter lists save (measures/speedup.h).
  std::optional<RunResult> every_light = {};
};

// Everything that the report of one view shows.
struct CompareReport {
  std::string scene;
  int width = 0, height = 0;
  glm::vec3 ambient{0};  // the scene's
  std::string cl_device, gl_device, commit;
  std::string reference;  // the technique that the images are compared with: "forward", or with the setting
                          // that makes it one, "visibility:lights=all"
  uint64_t reference_pixels = 0;  // number of pixels compared: all, or a sample if all would take too long
  double brightest = 0;           // channel of the reference's image, which errors are relative to
  uint64_t covered_pixels = 0;    // with an opaque surface; 0 if not counted
  std::optional<SurfacesError> reference_surfaces;  // errors of the reference's image, at the rows' pixels
  std::optional<OwnSurfaces> own_surfaces;          // absent if no row has such, and if the reference has
  std::vector<RunResult> rows;
  std::vector<Image> images;                  // one a row, linear; read with image_of
  Image reference_image;                      // set only if no row is the reference
  std::vector<std::vector<uint32_t>> listed;  // one a row, lights listed per pixel, row 0 at the bottom
  std::vector<uint32_t> lit;                  // per pixel, by the oracle; empty without one
  std::optional<ReferenceErrors> reference_errors;
  std::optional<PathMemory> path_memory;  // absent without a camera path
  Exposure exposure;                      // exposure of every picture of this view
  std::vector<Warning> warnings;          // warnings of this view, those of its scene included
  // For views that differ in the number of lights: their common property, "range" or "overlap"; empty: a
  // single number. ranges_of: the number of scattered lights whose ranges all have; 0: ranges were given.
  std::string lights_kept;
  int ranges_of = 0;
};

// The row that is the reference, possibly refused; null if there is none.
const RunResult* reference_row(const CompareReport& report);
// The image that all are compared with: of its row, or reference_image. Empty if neither was kept.
const Image& reference_image(const CompareReport& report);
// The image of a row; empty if it has none. A row whose colours equal the reference's to the bit may keep no
// copy: its image is then the reference's.
const Image& image_of(const CompareReport& report, size_t row);

nlohmann::json to_json(const CompareReport& report);
std::string json_text(const CompareReport& report);  // the text of results.json for one view

}  // namespace lightgrid::lab
