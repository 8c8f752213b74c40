// The catalogue of hard cases of culling: inputs on which naive code loses lights, hangs or crashes, each
// with the property that must hold. docs/hard_cases.md has the same table, and a test compares the two.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lightgrid::verify {

class Check;

struct HardCase {
  const char* group;  // depth, camera, lights, lists, agreement, raster
  const char* name;
  const char* input;
  const char* breaks;     // the fault of naive code
  const char* invariant;  // the property that must hold
  void (*run)(Check&);
};

// A row of a group's table (`group` there is the group's name); a case is named as its function.
#define CASE(name, input, breaks, invariant) \
  { group, #name, input, breaks, invariant, name }

// In the order of the groups and of the catalogue.
const std::vector<HardCase>& hard_cases();

std::vector<HardCase> depth_cases();
std::vector<HardCase> depth_bounds_cases();
std::vector<HardCase> depth_format_cases();
std::vector<HardCase> camera_cases();
std::vector<HardCase> projection_cases();
std::vector<HardCase> light_cases();
std::vector<HardCase> light_place_cases();
std::vector<HardCase> list_cases();
std::vector<HardCase> agreement_cases();
std::vector<HardCase> raster_cases();

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
  std::string why;  // the first fault, or why it was skipped
};

}  // namespace lightgrid::verify
