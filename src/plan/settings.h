// The settings that trade accuracy for time, by the names of the command line (docs/command_line.md#settings).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "shared/cull_settings.h"

namespace lightgrid {

enum class Brdf { ggx, blinn };  // the specular lobe: shared/brdf.h

struct Settings {
  Brdf brdf = Brdf::ggx;
  CullTest cull_test = CullTest::planes_aabb;
  DepthBoundsMode depth_bounds = DepthBoundsMode::minmax;
  int tile = 16;  // pixels a side: 8, 16, 32 or 64
  int slices = 24;  // depth slices of techniques that have some: 1, 2, 4, 8, 16, 24, 32 or 64
  SliceSpacing slice_spacing = SliceSpacing::exponential;
  int z_bins = 1;  // 1 (off), 16, 64 or 256
  GridLists grid_lists = GridLists::lists;
  int buffer_bits = 32;  // a channel of geometry buffers: 8, 16 or 32
  KernelShape kernel_shape = KernelShape::automatic;
  bool portable = false;       // kernels without the builtins of one kind of CPU
  bool everything_on = false;  // every effect's code and buffers, called for or not: what a plan is tested against
};

// Applies "key=value". Throws Error(input) that lists the keys, or the values of a key.
void apply_setting(Settings& settings, const std::string& assignment);

std::map<std::string, std::string> to_strings(const Settings& settings);

struct SettingHelp {
  std::string key;
  std::vector<std::string> values;  // the first is the default
  std::string meaning;
};
const std::vector<SettingHelp>& setting_help();

}  // namespace lightgrid
