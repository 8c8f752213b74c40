// Hard cases of culling: inputs on which naive code loses lights, hangs or crashes, each with the property
// that must hold (src/laboratory/verify/catalogue.md), and their checks, with counts. Each check is a
// sandwich: what is certainly in must be listed, and what is listed must be possibly in. For the library,
// bytes must also be equal in both kernel shapes and in every run.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verify/inputs.h"

namespace lightgrid::lab::verify {

class Check;

// A row of the catalogue, and the function of its name.
struct HardCase {
  std::string group;  // depth, camera, lights, lists ...
  std::string name;
  std::string input;
  std::string breaks;     // the fault of naive code
  std::string invariant;  // the property that must hold
  std::function<void(Check&)> run;
};

// In the order of the catalogue.
const std::vector<HardCase>& hard_cases();

// The functions of these names, as CASES(all_sky, …) gives them.
struct CaseRun {
  std::string name;
  std::function<void(Check&)> run;
};
std::vector<CaseRun> named_cases(std::string_view names, std::initializer_list<void (*)(Check&)> runs);
#define CASES(...) named_cases(#__VA_ARGS__, {__VA_ARGS__})

std::vector<CaseRun> depth_cases();
std::vector<CaseRun> depth_bounds_cases();
std::vector<CaseRun> camera_cases();
std::vector<CaseRun> light_cases();
std::vector<CaseRun> list_cases();
std::vector<CaseRun> agreement_cases();
std::vector<CaseRun> raster_cases();
std::vector<CaseRun> sample_cases();
std::vector<CaseRun> shadow_cases();
std::vector<CaseRun> light_index_cases();
std::vector<CaseRun> group_cases();
std::vector<CaseRun> cap_cases();
std::vector<CaseRun> effect_cases();

enum class Verdict { pass, fail, skip };

struct Outcome {
  // Number of comparisons: for each setting the entries of its lists and the pairs that must be among them,
  // and each other condition. One pair counts once for each setting, so that trials measure the work of
  // comparison, not the number of inputs.
  uint64_t trials = 0;
  // Distinct inputs: (cell, light) pairs that certainly touch and (pixel, light) pairs that are certainly
  // lit, each once for a view, its lights and its depth, independent of the number of settings.
  uint64_t contacts = 0;
  uint64_t lost = 0;                   // certainly in but not listed, over all settings
  std::optional<double> excess_ratio;  // listed / certainly touching, default settings
  Verdict verdict = Verdict::pass;
  std::string why;       // the first fault, or why it was skipped
  bool unbuilt = false;  // skipped since the driver cannot build a kernel
};

// KEY=VALUE each, with spaces between.
Settings settings_with(const std::string& assignments);

// The default first: every cull test, or every kind of depth bounds, at one tile size; every tile size.
std::vector<CullerOptions> every_test(int tile = 16);
std::vector<CullerOptions> every_mode(int tile = 16);
std::vector<CullerOptions> every_tile();
std::string to_string(const CullerOptions& options);

class Check {
 public:
  Check(CullEngine& engine, uint64_t adversarial_lights, bool ends_at_failure = false)
      : engine(engine), adversarial_lights(adversarial_lights), ends_at_failure_(ends_at_failure) {}

  CullEngine& engine;
  const uint64_t adversarial_lights;  // number of tangent lights in the bulk case

  // The lists of these lights over given bounds (one a tile, or one for all), under each of `settings`;
  // returns the first.
  HostGrid grid(const CullView& view, const std::vector<CullLight>& lights, std::vector<DepthInterval> bounds,
                const std::vector<CullerOptions>& settings);
  HostGrid grid(const CullView& view, const std::vector<CullLight>& lights,
                std::vector<DepthInterval> bounds) {
    return grid(view, lights, std::move(bounds), every_test());
  }
  HostGrid grid(const CullView& view, const OverTiles& over) { return grid(view, over.lights, over.bounds); }

  // The same without the oracle: for sizes at which it would take minutes, with a known answer.
  HostGrid grid_of_known_answer(const CullView& view, const std::vector<CullLight>& lights,
                                std::vector<DepthInterval> bounds, const CullerOptions& options);

  // Compares depth bounds with a plain scan in double: they contain every surface and, with `tight`, little
  // more.
  std::vector<DepthInterval> bounds(const CullView& view, const DepthImage& depth,
                                    const CullerOptions& options, bool tight = true);

  // From depth to lists: every light that lights a pixel's surface, at the pixel's centre, is in the list
  // that shading reads for it (slice and z-bin found from the stored depth, as in shared/slices.h), and in
  // its z-bin if the view has any. If `depth` has the surfaces' distances, these are used instead of its
  // values. Returns the first setting's grid.
  HostGrid pixels(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                  const std::vector<CullerOptions>& settings);

  // The kernels' raw bounds and grid equal the float twin's byte for byte, in both shapes.
  // Skipped for engines other than the library.
  void same_as_twin(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                    const CullerOptions& options, bool blend = false);

  // Each cell lists so many lights.
  void each_cell_lists(const HostGrid& grid, uint32_t lights, const char* what = "lights");
  // Light i is at pixel i, y * width + x: the tile that shading finds for the pixel lists it.
  void pixels_find_lights(const HostGrid& grid, const CullView& view, int tile, const std::string& what);
  // The same with tiny lights 5 m away. Returns their number.
  size_t pixels_find_tiny_lights(const CullView& view, const CullerOptions& options);

  // Any other condition: one trial.
  template <typename... Args>
  bool that(bool holds, fmt::format_string<Args...> format, Args&&... args) {
    ++outcome_.trials;
    if (!holds) fail(fmt::format(format, std::forward<Args>(args)...));
    return holds;
  }
  template <typename... Args>
  void lost(fmt::format_string<Args...> format, Args&&... args) {
    lost_pairs(1, format, std::forward<Args>(args)...);
  }
  template <typename... Args>
  void lost_pairs(uint64_t pairs, fmt::format_string<Args...> format, Args&&... args) {
    outcome_.lost += pairs;
    fail(fmt::format(format, std::forward<Args>(args)...));
  }
  void contacts(uint64_t more) { outcome_.contacts += more; }
  void trials(uint64_t more) { outcome_.trials += more; }
  void fail(const std::string& why);  // throws Ended where that ends the case
  struct Ended {};
  void skip(const std::string& why);

  Outcome outcome() const;

 private:
  std::vector<CullerOptions> in_both_shapes(const CullerOptions& options) const;
  template <typename Make>
  auto same_in_every_shape(const CullerOptions& options, const Make& make);
  template <typename Cull>
  HostGrid well_formed_grid(const CullerOptions& options, size_t lights, const Cull& cull);
  void hold_between(const CullView& view, std::span<const OracleLight> lights,
                    std::span<const DepthInterval> bounds, const Touching& touching,
                    const CullerOptions& options, const HostGrid& grid, bool counts);

  const bool ends_at_failure_;
  Outcome outcome_;
  uint64_t listed_ = 0, touching_ = 0;  // under the first settings
};

std::span<const uint32_t> list_of(const HostGrid& grid, size_t cell);

// The place where a light is missing: its cell's list, the cell's mask, or the light's z-bins.
enum class LostFrom { list, mask, z_bins };
const char* name_of(LostFrom from);

// Finds a pixel's lights as shading does: by its tile, and by the slice and the z-bin of its stored depth.
class ListFinder {
 public:
  ListFinder(const CullView& view, int tile, const HostGrid& grid);
  // Empty if shading finds the light.
  std::optional<LostFrom> lost_from(uint x, uint y, float depth, uint32_t light) const;

 private:
  const CullView& view_;
  const int tile_;
  const HostGrid& grid_;
  const std::array<float, MOST_SLICES> slices_;
  const std::array<float, MOST_Z_BINS> z_bins_;
  const size_t mask_words_;
};

// Empty, or a fault: lists must be adjacent without gap or overlap, sorted, and contain valid indices.
std::string malformed(const HostGrid& grid, size_t lights);

// The float twin: a second program that computes the culling kernels' results, in their arithmetic but
// without their hierarchy: every light against every cell, lists one after the other; every depth value of a
// tile in turn. Both share the text of kernels/culling: the tests of one light and the intervals of depths.
// Regions, bins, blocks, lanes, counting, scanning and appending exist in the kernels alone.
HostGrid twin_grid(const CullInputs& inputs, CullTest test);
// `params` as the kernels got them for this depth (LightCuller::read_inputs); `blend`: bounds for blended
// surfaces.
std::vector<float> twin_bounds(const CullParams& params, DepthBoundsMode mode, bool blend, int samples,
                               std::span<const float> depth);
// Empty, or the first difference.
std::string difference(const HostGrid& twin, const HostGrid& grid);
std::string difference(std::span<const float> twin, std::span<const float> bounds);  // difference of bits

}  // namespace lightgrid::lab::verify
