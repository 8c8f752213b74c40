// The settings that trade accuracy for time, by the names of the command line
// (docs/command_line.md#settings).
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/blended_casters.h"
#include "scene/light_ranges.h"
#include "scene/material_model.h"
#include "shared/cull_settings.h"
#include "shared/sample_masks.h"

namespace lightgrid {

// How deferred light volumes skip pixels out of a light's reach (passes/shade_light_volumes.cpp).
enum class VolumeCulling { back_faces, stencil, scissor, depth_bounds };

// Light-indexed deferred rendering (docs/techniques/lidr.md): how several light indices share a pixel, which
// surfaces of a light's volume are drawn, when lights are sorted into groups, and how their types are told
// apart.
enum class LidrPacking { bitshift, maxblend, sort, maxblend_sort };
enum class LidrVolumes { stencil, front_faces, no_prepass };
enum class LidrSort { view, still };
enum class LidrTypes { flag, passes };
// Who finds the shadows of point and spot lights: find_shadows, as for every technique; nobody; or lidr
// itself, by shadow volumes or shadow maps (docs/techniques/lidr.md#shadows).
enum class LidrShadows { pass, none, volumes, prepass, prepass_soft, final_pass };

// Who rasterises, in techniques that leave the choice: OpenGL, or OpenCL (raster/raster_view.h), which then
// needs no OpenGL.
enum class RasterApi { opengl, opencl };

// How the light of a pixel's samples is averaged (docs/samples.md#averages).
enum class SamplesShading { edges, all };
enum class SamplesResolve { linear, tonemapped, weighted };

// How the resolve passes keep a material's maps (upload/scene_surfaces.h), and which lights it adds up.
enum class TexelLayout { packed, packed_8, separate };
enum class ShadedLights { grid, all };

// How shadows are found: exactly, from shadow maps (docs/shadow_maps.md), whose pictures are approximate, or
// not at all: light then goes through what hides it.
enum class ShadowMethod { exact, map, none };

// What of a frame goes to the host: linear light, or the bytes that a display shows (passes/tone_map.h).
enum class PictureFormat { floats, bytes };

// Light pre-pass (docs/techniques/light_prepass.md): the specular term that the light buffer keeps, and the
// format of the image of normals.
enum class PrepassSpecular { plain, fifth_term, luminance, bent };
enum class NormalFormat { floats, octahedral, spheremap, xyz8 };

// Which lights a list keeps that is longer than list-cap (docs/capped_lists.md).
// sampled: at random, and each light counts so often that the expected sum is the longer list's
// (docs/sampled_lists.md). tree: the same of all lights, from a tree.
enum class ListCapOrder { index, distance, brightest, sampled, tree };

enum class VolumeMeshes {
  automatic,
  icosahedron,
  box
};  // what stands for a light's ball: docs/light_volumes.md

// The voxel light buffer (docs/techniques/voxel_lights.md): which space its samples divide, and when it is
// filled.
enum class VoxelSpace { world, view };
enum class VoxelSize { s16x16x4, s32x32x8, s64x64x16, s128x128x16, s128x128x32, s128x128x64, s256x256x64 };

struct Settings {
  Brdf brdf = Brdf::ggx;
  LightRanges ranges;
  CullTest cull_test = default_cull_test;
  DepthBoundsMode depth_bounds = DepthBoundsMode::minmax;
  int tile = 16;    // pixels a side: 8, 16, 32 or 64
  int slices = 24;  // depth slices, for techniques that use them (visibility: where it is
                    // given): 1, 2, 4, 8, 16, 24, 32 or 64
  SliceSpacing slice_spacing = SliceSpacing::exponential;
  int z_bins = 1;  // 1 (off), 16, 64 or 256
  GridLists grid_lists = GridLists::lists;
  int list_cap = 0;  // most lights of a tile's, a cell's or an object's list; 0: no limit
  ListCapOrder list_cap_order = ListCapOrder::index;
  uint32_t list_seed = 1;  // of ListCapOrder::sampled and tree
  int view_cap = 0;        // most lights of a view; 0: no limit
  int buffer_bits = 32;    // a channel of geometry buffers and of light buffers: 8, 16 or 32
  VolumeCulling volume_culling = VolumeCulling::back_faces;
  KernelShape kernel_shape = KernelShape::automatic;
  LidrPacking lidr_packing = LidrPacking::bitshift;
  int lidr_overlap = 0;  // capacity of a pixel in lights: 1, 2, 4, 8, 16, or 0: as many as the packing can
                         // hold
  int lidr_lights = 0;   // capacity of an index: 15, 255, 65535 lights, or 0: the least that suffices for the
                         // scene
  LidrVolumes lidr_volumes = LidrVolumes::stencil;
  LidrSort lidr_sort = LidrSort::view;
  LidrTypes lidr_types = LidrTypes::flag;
  int lidr_passes = 1;  // sorted packings: at most 1, 2, 4, 8 or 16 passes over the surfaces
  LidrShadows lidr_shadows = LidrShadows::pass;
  VolumeMeshes volume_mesh = VolumeMeshes::automatic;
  PrepassSpecular prepass_specular = PrepassSpecular::plain;
  int prepass_shininess = 32;  // the lights' specular exponent: 2, 8, 32, 128 or 512
  NormalFormat normals = NormalFormat::floats;
  RasterApi raster = RasterApi::opengl;
  int samples = 1;  // a pixel, at which triangles are drawn: 1, 2, 4 or 8
  SamplesShading samples_shading = SamplesShading::edges;
  SampleMasks samples_masks = SampleMasks::centre;
  SamplesResolve samples_resolve = SamplesResolve::linear;
  TexelLayout texels = TexelLayout::packed;
  ShadedLights lights = ShadedLights::grid;
  VoxelSize voxel_size = VoxelSize::s128x128x16;
  VoxelSpace voxel_space = VoxelSpace::world;
  int voxel_lights_exact = 0;  // lights a pixel that are shaded by themselves: 0, 1, 2, 4 or 8
  WorldGridShape world_grid = WorldGridShape::cubes;
  std::optional<double> world_cell;  // a cell's edge over the radius of lights; none: what suits the lights
  ShadowMethod shadows = ShadowMethod::exact;
  int shadow_size = 256;  // texels a side of the largest face of a shadow map: 16 to 2048
  int shadow_bits = 32;   // of a texel: 16, 24 or 32
  int shadow_taps = 1;    // texels a side that a pixel asks: 1, 3 or 5
  // Sphere lights: rays for each pixel and light, 1 (to the centre), 4, 16, 64 or 256, and the spheres'
  // radius.
  int shadow_rays = 1;
  double shadow_source_m = 0.05;
  int shadow_pick = 0;  // rays for each pixel to all its lights: 1, 4 or 16; 0: to each light
  BlendedCasters shadow_blended = BlendedCasters::none;
  int group_bits = 8;        // of the number of a mask of light groups beside a pixel's surface: 8 or 16
  bool group_tiles = true;   // tiles list lights only of groups that their surfaces have
  int group_stencil = 0;     // bits of the stencil that have light groups instead: 4, 6 or 8; 0: none has
  int shadow_threshold = 0;  // steps of the display below which lights have no shadow: 1 to 16; 0: off
  // Exposure of pictures, in stops, by which these steps are counted and pictures become bytes; none: it is
  // chosen from the picture.
  std::optional<double> display_ev = 0.0;
  PictureFormat picture = PictureFormat::floats;
  // Most bytes of a frame's shadow bits with their table, and as many again of its shadow maps.
  size_t shadow_memory = size_t(256) << 20;
  bool portable = false;  // kernels without the builtins of one kind of CPU
  int group_size = 0;  // work-items of the group shape that cull a block of tiles; 0: the culler's own choice
  // Every effect's code and buffers, called for or not: what a plan is tested against.
  bool everything_on = false;
  bool samples_lists() const {
    return list_cap > 0 && (list_cap_order == ListCapOrder::sampled || list_cap_order == ListCapOrder::tree);
  }
  // A share of a light may be hidden from a point.
  bool picks_shadows() const { return shadows == ShadowMethod::exact && shadow_pick > 0; }
  bool soft_shadows() const {
    return shadows == ShadowMethod::exact && shadow_rays > 1 && shadow_source_m > 0;
  }

  // A shadow map has no share of a light for alpha to hide.
  BlendedCasters blended_casters() const {
    const bool shares = shadow_blended == BlendedCasters::alpha && shadows == ShadowMethod::map;
    return shares ? BlendedCasters::none : shadow_blended;
  }

  std::set<std::string> given{};        // keys that apply_setting has set
  std::map<std::string, size_t> own{};  // by key, of OwnSettings: the number of the value; missing: the first
};

// How a setting affects pictures and other settings. Conditions are evaluated only for techniques that read
// the setting, with the defaults of all settings that they do not read.
struct SettingFlags {
  using Condition = std::function<bool(const Settings&)>;
  bool model = false;           // says which picture is meant: images with other values cannot be compared
  bool common = false;          // every technique reads it
  bool tunable = false;         // changes no result, only times: `lightgrid bench --tune` tries its values
  // An effect's, which changes how much of a light reaches surfaces. It is stored with the ranges, which all
  // code that reads lights is given.
  bool of_lights = false;
  bool shown_if_given = false;  // shown only where apply_setting has set it
  Condition shown{};            // without effect, and not shown, where this is false
  Condition approximate{};      // images are not meant to be exact
  Condition random{};           // images differ by a seed
  std::function<void(Settings&)> mean{};  // sets what the picture that is meant has in its place
};

void add_own_setting(const char* key, const char* before, const char* meaning,
                     const std::vector<std::string>& names, const SettingFlags& flags);

// A setting that is defined in the file of the technique, pass or effect that reads it, as a static object.
// Once it is constructed, the functions below include it, listed before the setting `before`. Its values are
// given with their names, the default first.
template <typename T>
class OwnSetting {
 public:
  OwnSetting(const char* key, const char* before, const char* meaning,
             std::initializer_list<std::pair<const char*, T>> values, const SettingFlags& flags = {})
      : key_(key), of_lights_(flags.of_lights) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.emplace_back(name), values_.push_back(value);
    add_own_setting(key, before, meaning, names, flags);
  }

  T of(const Settings& settings) const {
    return in(of_lights_ ? settings.ranges.effects : settings.own);
  }
  T of(const LightRanges& ranges) const { return in(ranges.effects); }  // of a setting with `of_lights`
  void set_default(Settings& settings) const {
    (of_lights_ ? settings.ranges.effects : settings.own).erase(key_);
  }

 private:
  T in(const std::map<std::string, size_t>& own) const {
    const auto chosen = own.find(key_);
    return values_[chosen == own.end() ? 0 : chosen->second];
  }

  const char* key_;
  bool of_lights_;
  std::vector<T> values_;
};

// Keys of the settings that say which picture is meant: images with other values cannot be compared.
const std::vector<std::string>& model_settings();
bool same_model(const Settings& a, const Settings& b);
// `settings` with the values that `model` has for those.
Settings with_model(Settings settings, const Settings& model);

// The settings of the picture that `settings` approximate, such as ranges without end in place of far light
// or exact shadows in place of shadow maps.
Settings meant_by(Settings settings);

// `settings`, with the default of every key for which `keeps` is false.
Settings only_with(Settings settings, const std::function<bool(const std::string& key)>& keeps);

// The most bits that group-stencil may use: counting faces needs one of the 8.
int most_stencil_groups(VolumeCulling culling);

// With so many samples a pixel, whatever the scene asks for.
Settings with_samples(Settings settings, int samples);

// With shadows found exactly: of a reference.
Settings with_exact_shadows(Settings settings);

// Keys of the settings that change no result, only times.
const std::vector<std::string>& tunable_settings();

// `settings` with the fastest values found for tunable settings (cl/tuned_sizes.h), except for keys that
// apply_setting has set. Other keys and unknown values are ignored.
Settings with_tuned(Settings settings, const std::map<std::string, std::string>& tuned);

// Applies "key=value". Throws Error(input) that lists the keys, or the values of a key.
void apply_setting(Settings& settings, const std::string& assignment);

// By the keys of results.json: "-" becomes "_".
std::map<std::string, std::string> to_strings(const Settings& settings);
std::string json_key(std::string setting);

struct SettingHelp {
  std::string key;
  std::vector<std::string> values;  // the first is the default
  std::string meaning;
  bool any_number = false;  // from 1e-9 to 1e9 besides; `values` are then those that sweeps and lists show
  SettingFlags flags{};
};
const std::vector<SettingHelp>& setting_help();

}  // namespace lightgrid
