// `lightgrid verify`: runs the catalogue of hard cases on this machine's devices, or a captured frame, whose
// bytes are compared with the float twin's and whose lists with the oracle.
#pragma once

#include <functional>

#include <nlohmann/json_fwd.hpp>

#include "frames/frame_file.h"
#include "verify/check.h"

namespace lightgrid::lab::verify {

struct CaseResult {
  const HardCase* hard_case = nullptr;
  std::string device;
  Outcome outcome;
  double wall_ms = 0;
};

struct VerifyReport {
  std::vector<std::string> devices;
  std::vector<CaseResult> cases;
  int failed = 0;
  int unbuilt = 0;  // skipped since the driver cannot build a kernel
};

using CaseFunction = std::function<void(const CaseResult&)>;

struct VerifyOptions {
  std::string filter;  // a regular expression searched in "group/name"; empty: all
  uint64_t adversarial_lights = 100'000;
  CaseFunction found = nullptr;  // receives each case when it has ended
  std::function<void(double done, const std::string& step)> progress;
};

// Throws Error(input) if the filter is no regular expression or matches no case.
std::vector<const HardCase*> chosen_cases(const std::string& filter);

Outcome run_case(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights);

// Returns whether the case fails. Ends at the first failure, so that later comparisons are not made.
bool fails(const HardCase& hard_case, CullEngine& engine, uint64_t adversarial_lights);

VerifyReport run_cases(const std::vector<std::unique_ptr<CullEngine>>& engines, const VerifyOptions& options);

// The outcome of `run` on the engine. An exception of the engine fails the case, except
// that a kernel that its driver cannot build skips it.
Outcome outcome_of(const std::function<void(Check&)>& run, CullEngine& engine, uint64_t adversarial_lights);

nlohmann::ordered_json to_json(const VerifyReport& report);

// The catalogue as the table of docs/hard_cases.md: a row a case.
std::vector<std::string> catalogue_rows(const std::vector<const HardCase*>& cases);

struct ReplayOptions {
  // Further views. The frame's view without slices and z-bins is always replayed.
  std::vector<CullView> more_views;
  std::optional<FrameGrid> own;    // the lists that came with the frame, from whatever made them
  bool every_combination = false;  // cull tests x depth bounds; else each test with the default bounds,
                                   // and each kind of bounds with the default test
  CaseFunction found = nullptr;    // receives each case when it has ended
  std::function<void(double done, const std::string& step)> progress;
};

// With the frame's own lists, a case first that compares them with the oracle. Then one case per device.
// Under the chosen settings, which include every cull test and every kind of depth bounds, on each view:
// - bounds and lists have the float twin's bytes in both kernel shapes (twin/twin.h; the library only);
// - no pixel loses a light that the oracle in double (oracle/lit_set.h) says is lit there. `lost` of the
//   outcome counts such (pixel, light) pairs, over all settings; one lost pair fails the case.
VerifyReport replay_frame(const std::vector<std::unique_ptr<CullEngine>>& engines, const CapturedFrame& frame,
                          const ReplayOptions& options = {});

// The frame's view with the slices and z-bins of its own grid, if the folder has one with any; and with those
// that `set` (KEY=VALUE: slices, z-bins, slice-spacing) selects. Throws Error(input) for any other key.
std::vector<CullView> replayed_views(const CapturedFrame& frame, const std::optional<FrameGrid>& own,
                                     const std::vector<std::string>& set);

}  // namespace lightgrid::lab::verify
