// The checks of hard cases, with their counts. Each check is a sandwich: what is certainly in must be listed,
// and what is listed must be possibly in. For the library, bytes must also be equal in both kernel shapes and
// in every run.
#pragma once

#include <fmt/format.h>

#include "verify/hard_case.h"
#include "verify/views.h"

namespace lightgrid::verify {

class Check {
 public:
  Check(CullEngine& engine, uint64_t adversarial_lights)
      : engine(engine), adversarial_lights(adversarial_lights) {}

  CullEngine& engine;
  const uint64_t adversarial_lights;  // number of tangent lights in the bulk case

  // Every cull test at one tile size.
  std::vector<CullerOptions> every_test(int tile = 16) const;  // the default first
  // The default cull test in every tile size.
  std::vector<CullerOptions> every_tile() const;

  // The lists of these lights over given bounds (one a tile, or one for all), under each of `settings`;
  // returns the first.
  HostGrid grid(const CullView& view, const std::vector<CullLight>& lights, std::vector<DepthInterval> bounds,
                const std::vector<CullerOptions>& settings);
  HostGrid grid(const CullView& view, const std::vector<CullLight>& lights,
                std::vector<DepthInterval> bounds) {
    return grid(view, lights, std::move(bounds), every_test());
  }

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

  // The kernels' raw bounds and grid equal the float twin's (float_twin.h) byte for byte, in both shapes.
  // Skipped for engines other than the library.
  void same_as_twin(const CullView& view, const std::vector<CullLight>& lights, const DepthImage& depth,
                    const CullerOptions& options, bool blend = false);

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
  void fail(const std::string& why);
  void skip(const std::string& why);

  Outcome outcome() const;

 private:
  std::vector<CullerOptions> in_both_shapes(const CullerOptions& options) const;
  HostGrid same_in_every_way(const CullView& view, const std::vector<CullLight>& lights,
                             const std::vector<DepthInterval>& bounds, const CullerOptions& options);
  void hold_between(const CullView& view, std::span<const OracleLight> lights,
                    std::span<const DepthInterval> bounds, const Touching& touching,
                    const CullerOptions& options, const HostGrid& grid, bool counts);

  Outcome outcome_;
  uint64_t listed_ = 0, touching_ = 0;  // under the first settings
};

std::string to_string(const CullerOptions& options);
std::span<const uint32_t> list_of(const HostGrid& grid, size_t cell);

// Empty, or a fault: lists must be adjacent without gap or overlap, sorted, and contain valid indices.
std::string malformed(const HostGrid& grid, size_t lights);

}  // namespace lightgrid::verify
