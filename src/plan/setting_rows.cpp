// The settings that several techniques or passes read, one row each.
#include "plan/setting_rows.h"
#include "shared/cull_tests.h"

namespace lightgrid {
namespace {

// A member of Settings, or of what it holds.
template <typename T>
auto& at(auto& settings, T Settings::*member) {
  return settings.*member;
}
template <typename T>
auto& at(auto& settings, T LightRanges::*member) {
  return settings.ranges.*member;
}

// The values of a setting that is a member, without names yet.
template <typename Owner, typename T>
SettingValues values_of(T Owner::*member) {
  return {.copy = [=](Settings& to, const Settings& from) { at(to, member) = at(from, member); },
          .same = [=](const Settings& a, const Settings& b) { return at(a, member) == at(b, member); }};
}

template <typename Owner, typename T>
SettingChoice choice(const char* value, T Owner::*member, const T& meant) {
  return {value, [=](Settings& s) { at(s, member) = meant; },
          [=](const Settings& s) { return at(s, member) == meant; }};
}

template <typename T>
struct Named {
  const char* name;
  T meant;
};

template <typename Owner, typename T>
SettingValues named(T Owner::*member, std::initializer_list<Named<std::type_identity_t<T>>> values) {
  SettingValues all = values_of(member);
  for (const auto& value : values) all.choices.push_back(choice(value.name, member, value.meant));
  return all;
}

// Numbers as they are written, the default first.
template <typename Owner, typename T>
SettingValues numbers(T Owner::*member, std::initializer_list<const char*> values) {
  SettingValues all = values_of(member);
  for (const char* value : values) all.choices.push_back(choice(value, member, T(std::stod(value))));
  return all;
}

SettingValues any_number(double LightRanges::*member, std::initializer_list<const char*> values) {
  SettingValues all = numbers(member, values);
  all.number = member;
  return all;
}

// One choice per row of a table, the default first.
template <typename Row, size_t rows, typename T>
SettingValues choices_of(const Row (&table)[rows], T Settings::*member, T Row::*meant) {
  SettingValues all = values_of(member);
  for (const Row& row : table) {
    const auto place = row.*meant == Settings().*member ? all.choices.begin() : all.choices.end();
    all.choices.insert(place, choice(row.name, member, row.*meant));
  }
  return all;
}

bool ranges_are_random(const Settings& s) { return s.ranges.range == LightRange::stochastic; }
bool ranges_are_cut(const Settings& s) { return s.ranges.range == LightRange::cutoff; }
bool ranges_have_windows(const Settings& s) {
  return s.ranges.range == LightRange::scene || s.ranges.range == LightRange::cutoff;
}
bool several_samples(const Settings& s) { return s.samples > 1; }

// LidrShadows::prepass has no filter: one texel decides.
bool filters_maps(const Settings& s) {
  return s.shadows == ShadowMethod::map || s.lidr_shadows == LidrShadows::prepass_soft ||
         s.lidr_shadows == LidrShadows::final_pass;
}
bool has_maps(const Settings& s) { return filters_maps(s) || s.lidr_shadows == LidrShadows::prepass; }

}  // namespace

std::vector<SettingRow>& all_settings() {
  static std::vector<SettingRow> settings = {
      {"brdf",
       "the specular lobe: GGX, Blinn-Phong of the same width, or none: base colour / pi",
       named(&Settings::brdf, {{"ggx", Brdf::ggx}, {"blinn", Brdf::blinn}, {"lambert", Brdf::lambert}}),
       {.model = true}},
      {"range",
       "where a light ends: at the range that the scene gives, where its irradiance falls to cutoff, at a "
       "random distance whose mean picture is that of no range (with alpha), or nowhere",
       named(&LightRanges::range, {{"scene", LightRange::scene},
                                   {"cutoff", LightRange::cutoff},
                                   {"stochastic", LightRange::stochastic},
                                   {"infinite", LightRange::infinite}}),
       {.model = true, .common = true, .random = ranges_are_random}},
      {"cutoff",
       "irradiance at which lights end with range=cutoff: intensity over squared distance",
       any_number(&LightRanges::cutoff, {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002",
                                         "0.001", "0.0005", "0.0002", "0.0001"}),
       {.model = true, .common = true, .shown = ranges_are_cut}},
      {"window",
       "how a light fades towards its range: 1 - (d / range)^4, its square, or not at all",
       named(&LightRanges::window,
             {{"khr", RangeWindow::khr}, {"smooth", RangeWindow::smooth}, {"none", RangeWindow::none}}),
       {.model = true, .common = true, .shown = ranges_have_windows}},
      {"alpha",
       "irradiance below which a light reaches a point by chance, with range=stochastic",
       any_number(&LightRanges::alpha, {"0.01", "1", "0.5", "0.2", "0.1", "0.05", "0.02", "0.005", "0.002",
                                        "0.001", "0.0005", "0.0002", "0.0001"}),
       {.model = true, .common = true, .shown = ranges_are_random}},
      {"light-seed",
       "of the random ranges, with range=stochastic",
       numbers(&LightRanges::seed,
               {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"}),
       {.model = true, .common = true, .shown = ranges_are_random}},
      {"cull-test", "the test that decides whether a light may touch a cell",
       choices_of(cull_tests, &Settings::cull_test, &CullTestRow::test)},
      {"depth-bounds", "the interval of distances that a cell spans",
       choices_of(depth_bounds_modes, &Settings::depth_bounds, &DepthBoundsRow::mode)},
      {"tile", "tile size in pixels", numbers(&Settings::tile, {"16", "8", "32", "64"})},
      {"slices", "depth slices a tile, of clustered; of visibility where it is given",
       numbers(&Settings::slices, {"24", "1", "2", "4", "8", "16", "32", "64"})},
      {"slice-spacing", "slices and z-bins that grow with distance, or of equal depth",
       named(&Settings::slice_spacing,
             {{"exponential", SliceSpacing::exponential}, {"linear", SliceSpacing::linear}})},
      {"z-bins", "ranges of distance by which shading skips lights of its tile's list",
       named(&Settings::z_bins, {{"off", 1}, {"16", 16}, {"64", 64}, {"256", 256}})},
      {"grid-lists", "contents of a cell of the light grid: light indices, or a bit for each light",
       named(&Settings::grid_lists, {{"lists", GridLists::lists}, {"masks", GridLists::masks}})},
      {"list-cap",
       "the most lights of a list, as engines have it: of a tile, of a cell of clustered, of an object in "
       "forward techniques. Further ones are left out",
       named(&Settings::list_cap, {{"off", 0},
                                   {"1", 1},
                                   {"2", 2},
                                   {"4", 4},
                                   {"8", 8},
                                   {"16", 16},
                                   {"32", 32},
                                   {"64", 64},
                                   {"128", 128},
                                   {"256", 256}})},
      {"list-cap-order",
       "the lights that a longer list keeps: the scene's first, the nearest to the eye or to the object's "
       "middle, those that add the most to the cell's or the object's middle; or lights drawn at random, "
       "from "
       "the list or a tree of all lights, which count so often that the expected picture is that of whole "
       "lists",
       named(&Settings::list_cap_order, {{"index", ListCapOrder::index},
                                         {"distance", ListCapOrder::distance},
                                         {"brightest", ListCapOrder::brightest},
                                         {"sampled", ListCapOrder::sampled},
                                         {"tree", ListCapOrder::tree}}),
       {.shown = [](const Settings& s) { return s.list_cap > 0; }}},
      {"list-seed",
       "of the lights drawn, with list-cap-order=sampled or tree",
       numbers(&Settings::list_seed,
               {"1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16"}),
       {.shown = &Settings::samples_lists,
        .approximate = &Settings::samples_lists,
        .random = &Settings::samples_lists}},
      {"view-cap", "the most lights of a view: those nearest to the eye of the lights whose range it sees",
       named(&Settings::view_cap, {{"off", 0},
                                   {"1", 1},
                                   {"8", 8},
                                   {"16", 16},
                                   {"32", 32},
                                   {"64", 64},
                                   {"128", 128},
                                   {"256", 256},
                                   {"512", 512},
                                   {"1024", 1024}})},
      {"buffer-bits",
       "bits of a channel of the geometry buffer: 32 is float, fewer are fixed point; of light_prepass its "
       "light buffer, with half floats in 16 bits",
       numbers(&Settings::buffer_bits, {"32", "16", "8"})},
      {"volume-culling", "how deferred lights skip pixels that they do not reach",
       named(&Settings::volume_culling, {{"back-faces", VolumeCulling::back_faces},
                                         {"stencil", VolumeCulling::stencil},
                                         {"scissor", VolumeCulling::scissor},
                                         {"depth-bounds", VolumeCulling::depth_bounds}})},
      {"group-ids", "bits of the number that a pixel's mask of light groups has beside its surface",
       numbers(&Settings::group_bits, {"8", "16"})},
      {"group-stencil", "bits of the stencil that have the light groups of a pixel in place of that number",
       named(&Settings::group_stencil, {{"off", 0}, {"4", 4}, {"6", 6}, {"8", 8}})},
      {"group-tiles", "tiles list only lights of groups that a surface in them has",
       named(&Settings::group_tiles, {{"on", true}, {"off", false}})},
      {"prepass-specular",
       "the specular term of the light buffer: of the lights' shininess; or raised to the material's, after "
       "division by a fifth term, by the luminance of the diffuse ones, or as it is",
       named(&Settings::prepass_specular, {{"plain", PrepassSpecular::plain},
                                           {"fifth-term", PrepassSpecular::fifth_term},
                                           {"luminance", PrepassSpecular::luminance},
                                           {"bent", PrepassSpecular::bent}})},
      {"prepass-shininess", "the lights' specular exponent in the light buffer",
       numbers(&Settings::prepass_shininess, {"32", "2", "8", "128", "512"})},
      {"normals",
       "the image of normals: floats, or 32 bits a pixel: two of 16 (octahedral, or a sphere map), or three "
       "of 8",
       named(&Settings::normals, {{"float", NormalFormat::floats},
                                  {"octahedral", NormalFormat::octahedral},
                                  {"spheremap", NormalFormat::spheremap},
                                  {"xyz8", NormalFormat::xyz8}})},
      {"kernel-shape",
       "lanes (vectors, for CPUs) or group (work-groups, for GPUs)",
       named(
           &Settings::kernel_shape,
           {{"auto", KernelShape::automatic}, {"lanes", KernelShape::lanes}, {"group", KernelShape::group}}),
       {.tunable = true}},
      {"lidr-packing",
       "how the light indices of a pixel share an image: shifted by blending, maximum and minimum, or a "
       "channel each",
       named(&Settings::lidr_packing, {{"bitshift", LidrPacking::bitshift},
                                       {"maxblend", LidrPacking::maxblend},
                                       {"sort", LidrPacking::sort},
                                       {"maxblend-sort", LidrPacking::maxblend_sort}})},
      {"lidr-overlap",
       "capacity of a pixel in light indices; auto: the most that the packing can hold for these lights",
       named(&Settings::lidr_overlap, {{"auto", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}})},
      {"lidr-lights", "lights that an index can distinguish; auto: the least that suffices for the scene",
       named(&Settings::lidr_lights, {{"auto", 0}, {"15", 15}, {"255", 255}, {"65535", 65535}})},
      {"lidr-volumes",
       "marks surfaces inside light volumes, by a stencil; or all behind their front faces, which serves "
       "blended surfaces too, also without a depth prepass: whatever is behind",
       named(&Settings::lidr_volumes, {{"stencil", LidrVolumes::stencil},
                                       {"front-faces", LidrVolumes::front_faces},
                                       {"no-prepass", LidrVolumes::no_prepass}})},
      {"lidr-types",
       "point and spot lights: in the same images, told apart by the light's data; or a pass over the "
       "surfaces "
       "for each, with images and a light loop of its own",
       named(&Settings::lidr_types, {{"flag", LidrTypes::flag}, {"passes", LidrTypes::passes}})},
      {"lidr-sort",
       "sorted packings: lights in view are put into groups for each view, or all lights once, while they "
       "are "
       "at rest",
       named(&Settings::lidr_sort, {{"view", LidrSort::view}, {"still", LidrSort::still}})},
      {"lidr-passes",
       "sorted packings: the most passes over the surfaces; lights that find no group are drawn in the next, "
       "after the last they are left out",
       numbers(&Settings::lidr_passes, {"1", "2", "4", "8", "16"})},
      {"lidr-shadows",
       "shadows of point and spot lights: exact, by the pass of all techniques; none; or where light volumes "
       "are drawn by shadow volumes or shadow maps, hard or as a share beside each index, or by shadow maps "
       "of a few lights where surfaces are shaded",
       named(&Settings::lidr_shadows, {{"pass", LidrShadows::pass},
                                       {"none", LidrShadows::none},
                                       {"volumes", LidrShadows::volumes},
                                       {"prepass", LidrShadows::prepass},
                                       {"prepass-soft", LidrShadows::prepass_soft},
                                       {"final", LidrShadows::final_pass}}),
       {.approximate = [](const Settings& s) { return s.lidr_shadows != LidrShadows::pass; }}},
      {"volume-mesh", "the mesh of a light's volume; auto: more faces if it is larger on screen",
       named(&Settings::volume_mesh, {{"auto", VolumeMeshes::automatic},
                                      {"icosahedron", VolumeMeshes::icosahedron},
                                      {"box", VolumeMeshes::box}})},
      {"raster", "who draws triangles: OpenGL, or OpenCL alone, as visibility does",
       named(&Settings::raster, {{"opengl", RasterApi::opengl}, {"opencl", RasterApi::opencl}})},
      {"samples",
       "a pixel, at which triangles are drawn: 1 is its centre; of more, each surface that they see is "
       "shaded "
       "once and counts by its share of them",
       numbers(&Settings::samples, {"1", "2", "4", "8"})},
      {"samples-shading",
       "of surfaces that are stored for each sample: samples are shaded apart at edges alone, or everywhere",
       named(&Settings::samples_shading, {{"edges", SamplesShading::edges}, {"all", SamplesShading::all}}),
       {.shown = several_samples}},
      {"samples-masks",
       "alpha masks of several samples: tested at the pixel's centre, at each sample, or by coverage, from "
       "alpha at the centre and its slope",
       named(&Settings::samples_masks, {{"centre", SampleMasks::centre},
                                        {"samples", SampleMasks::samples},
                                        {"coverage", SampleMasks::coverage}}),
       {.shown = several_samples}},
      {"samples-resolve",
       "average of a pixel's samples: of their light, of their light after the tone map, or of their light "
       "weighted by the tone map's derivative",
       named(&Settings::samples_resolve, {{"linear", SamplesResolve::linear},
                                          {"tonemapped", SamplesResolve::tonemapped},
                                          {"weighted", SamplesResolve::weighted}}),
       {.shown = several_samples}},
      {"texels",
       "textures in OpenCL: the maps of a material in one texel of 16 or 8 bytes where their sizes agree, or "
       "each its own",
       named(
           &Settings::texels,
           {{"16", TexelLayout::packed}, {"8", TexelLayout::packed_8}, {"separate", TexelLayout::separate}})},
      {"lights",
       "point and spot lights that visibility adds up at a pixel: those of its tile's list, or every one",
       named(&Settings::lights, {{"grid", ShadedLights::grid}, {"all", ShadedLights::all}})},
      {"voxel-size",
       "samples of the voxel light buffer: along x, z and y of the world, or across, up and away in the view",
       named(&Settings::voxel_size, {{"128x128x16", VoxelSize::s128x128x16},
                                     {"16x16x4", VoxelSize::s16x16x4},
                                     {"32x32x8", VoxelSize::s32x32x8},
                                     {"64x64x16", VoxelSize::s64x64x16},
                                     {"128x128x32", VoxelSize::s128x128x32},
                                     {"128x128x64", VoxelSize::s128x128x64},
                                     {"256x256x64", VoxelSize::s256x256x64}})},
      {"voxel-space",
       "what the voxel light buffer divides: a box of the world around what is visible, or the view by "
       "distance",
       named(&Settings::voxel_space, {{"world", VoxelSpace::world}, {"view", VoxelSpace::view}})},
      {"voxel-lights-exact",
       "lights a pixel that are shaded by themselves, from a light grid: those that matter most. The rest is "
       "the volume's",
       numbers(&Settings::voxel_lights_exact, {"0", "1", "2", "4", "8"})},
      {"world-grid",
       "cells of world_grid: columns over the ground, cubes of one size, or cubes of sizes that suit each "
       "light, found by a hash",
       named(&Settings::world_grid, {{"3d", WorldGridShape::cubes},
                                     {"2d", WorldGridShape::columns},
                                     {"hashed", WorldGridShape::hashed}})},
      {"world-cell",
       "edge of world_grid's cells over the lights' median radius; hashed: least edge of a light's cells "
       "over its own radius; auto: chosen by the lights' number and radii",
       named(&Settings::world_cell,
             {{"auto", std::nullopt}, {"1", 1.0}, {"2", 2.0}, {"0.5", 0.5}, {"0.25", 0.25}})},
      {"shadows",
       "shadows by exact rays, from shadow maps, which are an approximation, or none",
       named(&Settings::shadows,
             {{"exact", ShadowMethod::exact}, {"map", ShadowMethod::map}, {"none", ShadowMethod::none}}),
       {.common = true,
        .approximate = [](const Settings& s) { return s.shadows != ShadowMethod::exact; },
        .mean = [](Settings& s) { s = with_exact_shadows(std::move(s)); }}},
      {"shadow-size",
       "texels a side of a shadow map's faces, of the light with the largest share of the screen",
       numbers(&Settings::shadow_size, {"256", "16", "32", "64", "128", "512", "1024", "2048"}),
       {.common = true, .shown = has_maps}},
      {"shadow-bits",
       "of a shadow map's texel: 32 is float",
       numbers(&Settings::shadow_bits, {"32", "16", "24"}),
       {.common = true, .shown = has_maps}},
      {"shadow-filter",
       "texels that a pixel looks up: its own, or the mean of 3 x 3 or 5 x 5",
       named(&Settings::shadow_taps, {{"none", 1}, {"pcf3", 3}, {"pcf5", 5}}),
       {.common = true, .shown = filters_maps}},
      {"shadow-rays",
       "rays for each pixel and light that casts a shadow: one to its centre, or so many to a sphere around "
       "it, for soft shadows",
       numbers(&Settings::shadow_rays, {"1", "4", "16", "64", "256"}),
       {.common = true, .approximate = &Settings::soft_shadows}},
      {"shadow-source",
       "radius of these spheres in metres",
       numbers(&Settings::shadow_source_m, {"0.05", "0", "0.01", "0.02", "0.1", "0.2", "0.5"}),
       {.common = true,
        .shown = [](const Settings& s) { return s.shadows == ShadowMethod::exact && s.shadow_rays > 1; }}},
      {"shadow-pick",
       "rays for each pixel to lights drawn from its list, in place of those to each light: one estimate of "
       "the hidden share of all its light",
       named(&Settings::shadow_pick, {{"off", 0}, {"1", 1}, {"4", 4}, {"16", 16}}),
       {.common = true,
        .approximate = &Settings::picks_shadows,
        .mean = [](Settings& s) { s.shadow_pick = 0; }}},
      {"shadow-blended",
       "what blended surfaces hide of a light: nothing, all of it, or what their alpha says",
       named(&Settings::shadow_blended, {{"none", BlendedCasters::none},
                                         {"opaque", BlendedCasters::opaque},
                                         {"alpha", BlendedCasters::alpha}}),
       {.model = true, .common = true}},
      {"shadow-threshold",
       "lights that together add less than so many steps of the 8-bit display to any surface have no shadow "
       "there",
       named(&Settings::shadow_threshold, {{"off", 0}, {"1", 1}, {"2", 2}, {"4", 4}, {"8", 8}, {"16", 16}}),
       {.common = true,
        .shown_if_given = true,
        .approximate = [](const Settings& s) { return s.shadow_threshold > 0; }}},
      {"shadow-memory",
       "most memory of a frame's shadows, and as much again of shadow maps or light cells: where bits take "
       "more, the frame is shaded in bands; maps get smaller",
       named(&Settings::shadow_memory, {{"256M", size_t(256) << 20},
                                        {"1M", size_t(1) << 20},
                                        {"4M", size_t(4) << 20},
                                        {"16M", size_t(16) << 20},
                                        {"64M", size_t(64) << 20},
                                        {"1G", size_t(1) << 30}}),
       {.common = true, .shown_if_given = true}},
      {"picture",
       "what goes to the host, where a frame's time ends: the image as floats, or the bytes of a display, "
       "tone-mapped at its exposure",
       named(&Settings::picture, {{"float", PictureFormat::floats}, {"bytes", PictureFormat::bytes}}),
       {.common = true, .shown = [](const Settings& s) { return s.picture == PictureFormat::bytes; }}},
      {"portable",
       "plain OpenCL C, without builtins that only some CPUs have",
       named(&Settings::portable, {{"off", false}, {"on", true}}),
       {.tunable = true}},
      {"group-size",
       "work-items that cull a block of 4 x 4 tiles, in the group shape",
       named(&Settings::group_size,
             {{"auto", 0}, {"64", 64}, {"128", 128}, {"256", 256}, {"512", 512}, {"1024", 1024}}),
       {.tunable = true}},
      {"everything-on",
       "build and run every effect's code, needed or not (to test plans)",
       named(&Settings::everything_on, {{"off", false}, {"on", true}}),
       {.common = true}},
  };
  return settings;
}

}  // namespace lightgrid
