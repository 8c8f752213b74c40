#include "plan/settings.h"

#include <algorithm>
#include <functional>
#include <type_traits>

#include "base/error.h"
#include "shared/cull_tests.h"

namespace lightgrid {
namespace {

struct Choice {
  std::string value;
  std::function<void(Settings&)> set;
  std::function<bool(const Settings&)> is_set;
};

struct Setting {
  std::string key, meaning;
  std::vector<Choice> choices;  // the default first
};

template <typename T>
Choice choice(const char* value, T LightRanges::*member, T meant) {
  return {value, [=](Settings& s) { s.ranges.*member = meant; }, [=](const Settings& s) { return s.ranges.*member == meant; }};
}

// Numbers as they are written, the default first.
template <typename T>
std::vector<Choice> numbers(T LightRanges::*member, std::initializer_list<const char*> values) {
  std::vector<Choice> choices;
  for (const char* value : values) choices.push_back(choice(value, member, T(std::stod(value))));
  return choices;
}

template <typename T>
Choice choice(const char* value, T Settings::*member, std::type_identity_t<T> meant) {
  return {value, [=](Settings& s) { s.*member = meant; }, [=](const Settings& s) { return s.*member == meant; }};
}

// One choice a row of a table, the default first.
template <typename Row, size_t rows, typename T>
std::vector<Choice> choices_of(const Row (&table)[rows], T Settings::*member, T Row::*meant) {
  std::vector<Choice> choices;
  for (const Row& row : table) {
    const auto place = row.*meant == Settings().*member ? choices.begin() : choices.end();
    choices.insert(place, choice(row.name, member, row.*meant));
  }
  return choices;
}

const std::vector<Setting>& all_settings() {
  static const std::vector<Setting> settings = {
      {"brdf",
       "the specular lobe: GGX, Blinn-Phong of the same width, or none: base colour / pi",
       {choice("ggx", &Settings::brdf, Brdf::ggx), choice("blinn", &Settings::brdf, Brdf::blinn),
        choice("lambert", &Settings::brdf, Brdf::lambert)}},
      {"range",
       "where a light ends: at the range that the scene gives, where its irradiance falls to cutoff, at a random distance "
       "whose mean picture is that of no range (with alpha), or nowhere",
       {choice("scene", &LightRanges::range, LightRange::scene), choice("cutoff", &LightRanges::range, LightRange::cutoff),
        choice("stochastic", &LightRanges::range, LightRange::stochastic),
        choice("infinite", &LightRanges::range, LightRange::infinite)}},
      {"cutoff",
       "irradiance at which lights end with range=cutoff: intensity over squared distance",
       numbers(&LightRanges::cutoff, {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002", "0.001",
                                      "0.0005", "0.0002", "0.0001"})},
      {"window",
       "how a light fades towards its range: 1 - (d / range)^4, its square, or not at all",
       {choice("khr", &LightRanges::window, RangeWindow::khr), choice("smooth", &LightRanges::window, RangeWindow::smooth),
        choice("none", &LightRanges::window, RangeWindow::none)}},
      {"alpha",
       "irradiance below which a light reaches a point by chance, with range=stochastic",
       numbers(&LightRanges::alpha, {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002", "0.001", "0.0005",
                                     "0.0002", "0.0001"})},
      {"light-seed",
       "of the random ranges, with range=stochastic",
       numbers(&LightRanges::seed, {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"})},
      {"cull-test",
       "the test that decides whether a light may touch a cell",
       choices_of(cull_tests, &Settings::cull_test, &CullTestRow::test)},
      {"depth-bounds",
       "the interval of distances that a cell spans",
       choices_of(depth_bounds_modes, &Settings::depth_bounds, &DepthBoundsRow::mode)},
      {"tile",
       "tile size in pixels",
       {choice("16", &Settings::tile, 16), choice("8", &Settings::tile, 8), choice("32", &Settings::tile, 32),
        choice("64", &Settings::tile, 64)}},
      {"slices",
       "depth slices a tile, of clustered; of visibility where it is given",
       {choice("24", &Settings::slices, 24), choice("1", &Settings::slices, 1), choice("2", &Settings::slices, 2),
        choice("4", &Settings::slices, 4), choice("8", &Settings::slices, 8), choice("16", &Settings::slices, 16),
        choice("32", &Settings::slices, 32), choice("64", &Settings::slices, 64)}},
      {"slice-spacing",
       "slices and z-bins that grow with distance, or of equal depth",
       {choice("exponential", &Settings::slice_spacing, SliceSpacing::exponential),
        choice("linear", &Settings::slice_spacing, SliceSpacing::linear)}},
      {"z-bins",
       "ranges of distance by which shading skips lights of its tile's list",
       {choice("off", &Settings::z_bins, 1), choice("16", &Settings::z_bins, 16), choice("64", &Settings::z_bins, 64),
        choice("256", &Settings::z_bins, 256)}},
      {"grid-lists",
       "contents of a cell of the light grid: light indices, or a bit for each light",
       {choice("lists", &Settings::grid_lists, GridLists::lists), choice("masks", &Settings::grid_lists, GridLists::masks)}},
      {"buffer-bits",
       "bits of a channel of the geometry buffer: 32 is float, fewer are fixed point; of light_prepass its light buffer, with "
       "half floats in 16 bits",
       {choice("32", &Settings::buffer_bits, 32), choice("16", &Settings::buffer_bits, 16),
        choice("8", &Settings::buffer_bits, 8)}},
      {"volume-culling",
       "how deferred lights skip pixels that they do not reach",
       {choice("back-faces", &Settings::volume_culling, VolumeCulling::back_faces),
        choice("stencil", &Settings::volume_culling, VolumeCulling::stencil),
        choice("scissor", &Settings::volume_culling, VolumeCulling::scissor),
        choice("depth-bounds", &Settings::volume_culling, VolumeCulling::depth_bounds)}},
      {"prepass-lights",
       "who adds up the light buffer: OpenCL from lists of tiles, or OpenGL, a light's volume after the other",
       {choice("tiles", &Settings::prepass_lights, PrepassLights::tiles),
        choice("volumes", &Settings::prepass_lights, PrepassLights::volumes)}},
      {"prepass-specular",
       "the specular term of the light buffer: of the lights' shininess; or raised to the material's, after division by a "
       "fifth term, by the luminance of the diffuse ones, or as it is",
       {choice("plain", &Settings::prepass_specular, PrepassSpecular::plain),
        choice("fifth-term", &Settings::prepass_specular, PrepassSpecular::fifth_term),
        choice("luminance", &Settings::prepass_specular, PrepassSpecular::luminance),
        choice("bent", &Settings::prepass_specular, PrepassSpecular::bent)}},
      {"prepass-shininess",
       "the lights' specular exponent in the light buffer",
       {choice("32", &Settings::prepass_shininess, 32), choice("2", &Settings::prepass_shininess, 2),
        choice("8", &Settings::prepass_shininess, 8), choice("128", &Settings::prepass_shininess, 128),
        choice("512", &Settings::prepass_shininess, 512)}},
      {"normals",
       "the image of normals: floats, or 32 bits a pixel: two of 16 (octahedral, or a sphere map), or three of 8",
       {choice("float", &Settings::normals, NormalFormat::floats),
        choice("octahedral", &Settings::normals, NormalFormat::octahedral),
        choice("spheremap", &Settings::normals, NormalFormat::spheremap),
        choice("xyz8", &Settings::normals, NormalFormat::xyz8)}},
      {"kernel-shape",
       "lanes (vectors, for CPUs) or group (work-groups, for GPUs)",
       {choice("auto", &Settings::kernel_shape, KernelShape::automatic),
        choice("lanes", &Settings::kernel_shape, KernelShape::lanes),
        choice("group", &Settings::kernel_shape, KernelShape::group)}},
      {"lidr-packing",
       "how the light indices of a pixel share an image: shifted by blending, maximum and minimum, or a channel each",
       {choice("bitshift", &Settings::lidr_packing, LidrPacking::bitshift), choice("maxblend", &Settings::lidr_packing, LidrPacking::maxblend),
        choice("sort", &Settings::lidr_packing, LidrPacking::sort)}},
      {"lidr-overlap",
       "capacity of a pixel in light indices; auto: the most that the packing can hold for these lights",
       {choice("auto", &Settings::lidr_overlap, 0), choice("1", &Settings::lidr_overlap, 1), choice("2", &Settings::lidr_overlap, 2),
        choice("4", &Settings::lidr_overlap, 4), choice("8", &Settings::lidr_overlap, 8), choice("16", &Settings::lidr_overlap, 16)}},
      {"lidr-lights",
       "lights that an index can distinguish; auto: the least that suffices for the scene",
       {choice("auto", &Settings::lidr_lights, 0), choice("15", &Settings::lidr_lights, 15), choice("255", &Settings::lidr_lights, 255),
        choice("65535", &Settings::lidr_lights, 65535)}},
      {"lidr-volumes",
       "marks surfaces inside light volumes, by a stencil; or all behind their front faces, which serves blended surfaces too",
       {choice("stencil", &Settings::lidr_volumes, LidrVolumes::stencil),
        choice("front-faces", &Settings::lidr_volumes, LidrVolumes::front_faces)}},
      {"lidr-unpack",
       "light indices are unpacked with integers, or in float as the article does",
       {choice("integer", &Settings::lidr_unpack, LidrUnpack::integers), choice("float", &Settings::lidr_unpack, LidrUnpack::floats)}},
      {"lidr-order",
       "the lights kept if a pixel has too many: those of most influence, or the scene's first",
       {choice("priority", &Settings::lidr_order, LidrOrder::priority), choice("scene", &Settings::lidr_order, LidrOrder::scene)}},
      {"volume-mesh",
       "the mesh of a light's volume; auto: more faces if it is larger on screen",
       {choice("auto", &Settings::volume_mesh, VolumeMeshes::automatic),
        choice("icosahedron", &Settings::volume_mesh, VolumeMeshes::icosahedron), choice("box", &Settings::volume_mesh, VolumeMeshes::box)}},
      {"raster",
       "who draws triangles: OpenGL, or OpenCL alone, as visibility does",
       {choice("opengl", &Settings::raster, RasterApi::opengl), choice("opencl", &Settings::raster, RasterApi::opencl)}},
      {"texels",
       "textures in OpenCL: the maps of a material in one texel of 16 or 8 bytes where their sizes agree, or each its own",
       {choice("16", &Settings::texels, TexelLayout::packed), choice("8", &Settings::texels, TexelLayout::packed_8),
        choice("separate", &Settings::texels, TexelLayout::separate)}},
      {"lights",
       "point and spot lights that visibility adds up at a pixel: those of its tile's list, or every one",
       {choice("grid", &Settings::lights, ShadedLights::grid), choice("all", &Settings::lights, ShadedLights::all)}},
      {"voxel-size",
       "samples of the voxel light buffer: along x, z and y of the world, or across, up and away in the view",
       {choice("128x128x16", &Settings::voxel_size, VoxelSize::s128x128x16),
        choice("16x16x4", &Settings::voxel_size, VoxelSize::s16x16x4), choice("32x32x8", &Settings::voxel_size, VoxelSize::s32x32x8),
        choice("64x64x16", &Settings::voxel_size, VoxelSize::s64x64x16),
        choice("128x128x32", &Settings::voxel_size, VoxelSize::s128x128x32),
        choice("128x128x64", &Settings::voxel_size, VoxelSize::s128x128x64),
        choice("256x256x64", &Settings::voxel_size, VoxelSize::s256x256x64)}},
      {"voxel-space",
       "what the voxel light buffer divides: a box of the world around what is visible, or the view by distance",
       {choice("world", &Settings::voxel_space, VoxelSpace::world), choice("view", &Settings::voxel_space, VoxelSpace::view)}},
      {"voxel-bits",
       "bits of a value in the voxel light buffer, float in both cases",
       {choice("32", &Settings::voxel_bits, 32), choice("16", &Settings::voxel_bits, 16)}},
      {"voxel-lights-exact",
       "lights a pixel that are shaded by themselves, from a light grid: those that matter most. The rest is the volume's",
       {choice("0", &Settings::voxel_lights_exact, 0), choice("1", &Settings::voxel_lights_exact, 1),
        choice("2", &Settings::voxel_lights_exact, 2), choice("4", &Settings::voxel_lights_exact, 4),
        choice("8", &Settings::voxel_lights_exact, 8)}},
      {"voxel-reuse",
       "the voxel light buffer is filled in each frame, or only where its place or a light changed",
       {choice("off", &Settings::voxel_reuse, false), choice("on", &Settings::voxel_reuse, true)}},
      {"world-grid",
       "cells of world_grid: columns over the ground, cubes of one size, or cubes of sizes that suit each light, found by a hash",
       {choice("3d", &Settings::world_grid, WorldGridShape::cubes), choice("2d", &Settings::world_grid, WorldGridShape::columns),
        choice("hashed", &Settings::world_grid, WorldGridShape::hashed)}},
      {"world-cell",
       "edge of world_grid's cells over the lights' median radius; hashed: least edge of a light's cells over its own radius; "
       "auto: chosen by the lights' number and radii",
       {choice("auto", &Settings::world_cell, std::nullopt), choice("1", &Settings::world_cell, 1.0), choice("2", &Settings::world_cell, 2.0),
        choice("0.5", &Settings::world_cell, 0.5), choice("0.25", &Settings::world_cell, 0.25)}},
      {"portable",
       "plain OpenCL C, without builtins that only some CPUs have",
       {choice("off", &Settings::portable, false), choice("on", &Settings::portable, true)}},
      {"group-size",
       "work-items that cull a block of 4 x 4 tiles, in the group shape",
       {choice("auto", &Settings::group_size, 0), choice("64", &Settings::group_size, 64),
        choice("128", &Settings::group_size, 128), choice("256", &Settings::group_size, 256),
        choice("512", &Settings::group_size, 512), choice("1024", &Settings::group_size, 1024)}},
      {"everything-on",
       "build and run every effect's code, needed or not (to test plans)",
       {choice("off", &Settings::everything_on, false), choice("on", &Settings::everything_on, true)}},
  };
  return settings;
}

}  // namespace

void apply_setting(Settings& settings, const std::string& assignment) {
  const size_t equals = assignment.find('=');
  const std::string key = assignment.substr(0, equals);
  const auto& all = all_settings();
  const auto setting = std::find_if(all.begin(), all.end(), [&](const Setting& s) { return s.key == key; });
  if (equals == std::string::npos || setting == all.end()) {
    std::string keys;
    for (const Setting& s : all) keys += (keys.empty() ? "" : ", ") + s.key;
    throw input_error("set {}: not KEY=VALUE with a known key; keys are {}", assignment, keys);
  }
  const std::string value = assignment.substr(equals + 1);
  std::string values;
  for (const Choice& c : setting->choices) {
    if (c.value == value) {
      settings.given.insert(key);
      return c.set(settings);
    }
    values += (values.empty() ? "" : ", ") + c.value;
  }
  throw input_error("set {}: \"{}\" is not a value of {}; values are {}", assignment, value, key, values);
}

const std::vector<std::string>& model_settings() {
  static const std::vector<std::string> keys = {"brdf", "range", "cutoff", "window", "alpha", "light-seed"};
  return keys;
}

bool same_model(const Settings& a, const Settings& b) { return a.brdf == b.brdf && a.ranges == b.ranges; }

Settings with_model(Settings settings, const Settings& model) {
  settings.brdf = model.brdf;
  settings.ranges = model.ranges;
  return settings;
}

const std::vector<std::string>& tunable_settings() {
  static const std::vector<std::string> keys = {"kernel-shape", "portable", "group-size"};
  return keys;
}

Settings with_tuned(Settings settings, const std::map<std::string, std::string>& tuned) {
  for (const Setting& s : all_settings()) {
    const auto found = tuned.find(s.key);
    if (found == tuned.end() || settings.given.contains(s.key) || std::ranges::count(tunable_settings(), s.key) == 0) continue;
    for (const Choice& c : s.choices) {
      if (c.value == found->second) c.set(settings);
    }
  }
  return settings;
}

std::string json_key(std::string setting) {
  std::ranges::replace(setting, '-', '_');
  return setting;
}

std::map<std::string, std::string> to_strings(const Settings& settings) {
  std::map<std::string, std::string> strings;
  for (const Setting& s : all_settings()) {
    for (const Choice& c : s.choices) {
      if (c.is_set(settings)) strings[json_key(s.key)] = c.value;
    }
  }
  return strings;
}

const std::vector<SettingHelp>& setting_help() {
  static const auto help = [] {
    std::vector<SettingHelp> rows;
    for (const Setting& s : all_settings()) {
      SettingHelp& row = rows.emplace_back(SettingHelp{s.key, {}, s.meaning});
      for (const Choice& c : s.choices) row.values.push_back(c.value);
    }
    return rows;
  }();
  return help;
}

}  // namespace lightgrid
