#include "frames/frame_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/json_file.h"
#include "base/write_file.h"
#include "frames/frame_view.h"
#include "measures/results.h"
#include "scene/lights_file.h"
#include "shared/slices.h"

namespace lightgrid::lab {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little, "frames are little-endian");

constexpr const char* grid_files[] = {"grid.json", "grid.u32",   "indices.u32",
                                      "masks.u32", "z_bins.u32", "cell_of_pixel.u32"};

// The file's size, checked before anything is allocated.
uintmax_t size_of(const fs::path& path) {
  std::error_code failure;
  if (!fs::is_regular_file(path, failure)) throw input_error("{}: no such file", path.string());
  const uintmax_t bytes = fs::file_size(path, failure);
  if (failure) throw input_error("{}: cannot be read: {}", path.string(), failure.message());
  return bytes;
}

template <typename T>
std::vector<T> read_values(const fs::path& path, size_t count) {
  std::vector<T> values(count);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(values.data()), std::streamsize(count * sizeof(T)));
  if (!file) throw input_error("{}: cannot be read", path.string());
  return values;
}

template <typename T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

void check_folder(const fs::path& folder) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw input_error(
        "{}: no such folder; a frame is a folder that holds view.json, lights.json and depth.f32",
        folder.string());
}

std::vector<float> read_depth_file(const fs::path& path, const View& view) {
  const uintmax_t expected = view.grid().values() * sizeof(float), found = size_of(path);
  if (found != expected) {
    throw input_error("{}: {} bytes are not the {} of {}x{} floats (size in view.json)", path.string(), found,
                      expected, view.width, view.height);
  }
  return read_values<float>(path, view.grid().values());
}

size_t local_count(const CapturedFrame& frame) {
  return size_t(std::count_if(frame.lights.begin(), frame.lights.end(),
                              [](const Light& l) { return !is_directional(l); }));
}

// Empty if the file lacks them.
std::vector<float> read_edges(const JsonFile& file, const char* field, size_t most) {
  std::vector<float> edges;
  if (!file.has(field)) return edges;
  for (const double edge : file.numbers(field, -1, -1e12, 1e12)) {
    if (!edges.empty() && !(float(edge) >= edges.back())) throw file.error(field, "is not ascending");
    edges.push_back(float(edge));
  }
  if (edges.size() >= most) throw file.error(field, fmt::format("holds more than {}", most - 1));
  return edges;
}

// A grid whose cells are no tiles: each pixel has the number of its own.
FrameGrid read_pixel_grid(const JsonFile& file, const CapturedFrame& frame) {
  constexpr int max_cells = 1 << 26;
  if (file.at("cell_of_pixel") != true)
    throw file.error("cell_of_pixel", file.at("cell_of_pixel"),
                     "is not true; leave it out if cells are tiles");
  file.check_fields({"cells", "cell_of_pixel", "settings"});
  const std::vector<int> cells = file.wholes("cells", 1, 1, max_cells);
  FrameGrid grid;
  grid.lists.cells_x = cells[0];
  grid.lists.cells_y = 1;
  grid.cell_of_pixel.assign(frame.view.grid().values(), no_cell);
  return grid;
}

// The fields of grid.json, each checked against the frame.
FrameGrid read_grid_header(const JsonFile& file, const CapturedFrame& frame) {
  file.check_fields({"cells", "cell_of_pixel", "tile", "slice_edges", "z_bin_edges", "settings"});
  FrameGrid grid;
  if (file.has("cell_of_pixel")) return read_pixel_grid(file, frame);
  grid.tile = file.whole("tile", 1, max_frame_side);
  const std::vector<int> cells = file.wholes("cells", 3, 1, max_frame_side);
  const auto across = [&](int pixels) { return (pixels + grid.tile - 1) / grid.tile; };
  if (cells[0] != across(frame.view.width) || cells[1] != across(frame.view.height)) {
    throw file.error("cells", fmt::format("does not begin with {}, {}, the tiles of {} pixels in {}x{}",
                                          across(frame.view.width), across(frame.view.height), grid.tile,
                                          frame.view.width, frame.view.height));
  }
  grid.lists.cells_x = cells[0];
  grid.lists.cells_y = cells[1];
  grid.lists.slices = cells[2];
  grid.slice_edges = read_edges(file, "slice_edges", MOST_SLICES);
  grid.z_bin_edges = read_edges(file, "z_bin_edges", MOST_Z_BINS);
  if (grid.slice_edges.size() + 1 != size_t(cells[2])) {
    throw input_error("{}: slice_edges has {} inner edges, not one fewer than the {} slices", file.path(),
                      grid.slice_edges.size(), cells[2]);
  }
  if (!file.has("settings")) return grid;
  if (!file.at("settings").is_object()) throw file.error("settings", "is not an object");
  for (const auto& [key, value] : file.at("settings").items()) {
    if (value.is_structured()) throw file.error("settings." + key, value, "is not a plain value");
    grid.settings[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return grid;
}

// Reads a file of exactly `expected` words; `of` describes them.
std::vector<uint32_t> read_words(const fs::path& path, uintmax_t expected, const char* of) {
  const uintmax_t found = size_of(path);
  if (found != expected * 4)
    throw input_error("{}: {} bytes are not the {} of {}", path.string(), found, expected * 4, of);
  return read_values<uint32_t>(path, size_t(expected));
}

void read_masks(const fs::path& path, HostGrid& lists, size_t lights) {
  const size_t words = (lights + 31) / 32;
  lists.masks =
      read_words(path, uintmax_t(lists.cells.size()) * words, "a bit a light, in words, for each cell");
  for (size_t i = words; lights % 32 != 0 && i <= lists.masks.size(); i += words) {
    if (lists.masks[i - 1] >> lights % 32)
      throw input_error("{}: word {} has bits past the {} lights", path.string(), i - 1, lights);
  }
}

void read_lists(const fs::path& folder, HostGrid& lists, size_t lights) {
  const fs::path cells_path = folder / "grid.u32", indices_path = folder / "indices.u32";
  const uintmax_t cells = uintmax_t(lists.cells_x) * lists.cells_y * lists.slices,
                  found = size_of(cells_path);
  if (found != cells * 8) {
    throw input_error("{}: {} bytes are not the {} of {} cells (cells in grid.json)", cells_path.string(),
                      found, cells * 8, cells);
  }
  const uintmax_t index_bytes = size_of(indices_path);
  if (index_bytes % 4 != 0 || index_bytes / 4 > 0xffffffffu) {
    throw input_error("{}: {} bytes are no whole number of indices below 2^32", indices_path.string(),
                      index_bytes);
  }
  const auto pairs = read_values<uint32_t>(cells_path, size_t(cells) * 2);
  lists.indices = read_values<uint32_t>(indices_path, size_t(index_bytes / 4));
  for (size_t i = 0; i < size_t(cells); ++i) {
    const uint32_t first = pairs[2 * i], count = pairs[2 * i + 1];
    if (uint64_t(first) + count > lists.indices.size()) {
      throw input_error("{}: cell {}: first {} and count {} reach past the {} indices", cells_path.string(),
                        i, first, count, lists.indices.size());
    }
    lists.cells.push_back({first, count});
  }
  for (size_t i = 0; i < lists.indices.size(); ++i) {
    if (lists.indices[i] >= lights) {
      throw input_error("{}: index {} is {}, and there are {} point and spot lights", indices_path.string(),
                        i, lists.indices[i], lights);
    }
  }
}

}  // namespace

CapturedFrame read_frame(const fs::path& folder) {
  check_folder(folder);
  CapturedFrame frame;
  frame.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  const FrameView view = read_view_file(folder / "view.json");
  frame.view = view.view;
  frame.tile = view.tile;
  frame.surfaces_far_m = view.surfaces_far_m;
  frame.depth = read_depth_file(folder / "depth.f32", frame.view);
  frame.lights = load_lights_file(folder / "lights.json");
  return frame;
}

std::optional<FrameGrid> read_frame_grid(const fs::path& folder, const CapturedFrame& frame) {
  std::error_code failure;
  if (!fs::exists(folder / "grid.json", failure)) return {};
  FrameGrid grid = read_grid_header(JsonFile(folder / "grid.json"), frame);
  const size_t lights = local_count(frame);
  read_lists(folder, grid.lists, lights);
  const auto kind = grid.settings.find("grid_lists");
  if (kind != grid.settings.end() && kind->second == "masks")
    read_masks(folder / "masks.u32", grid.lists, lights);
  if (!grid.cell_of_pixel.empty())
    grid.cell_of_pixel =
        read_words(folder / "cell_of_pixel.u32", grid.cell_of_pixel.size(), "a cell for each pixel");
  if (!grid.z_bin_edges.empty())
    grid.lists.z_bins = read_words(folder / "z_bins.u32", lights, "a word a light");
  return grid;
}

void write_frame(const fs::path& folder, const CapturedFrame& frame) {
  make_folder(folder);
  const std::string view = view_file_text({frame.view, frame.tile, frame.surfaces_far_m}),
                    lights = lights_file_text(frame.lights);
  const NamedBytes files[] = {
      {"view.json", view}, {"lights.json", lights}, {"depth.f32", bytes_of(frame.depth)}};
  // A grid that is there is an older frame's.
  write_files(folder, files, grid_files);
}

void write_frame_grid(const fs::path& folder, const FrameGrid& grid) {
  make_folder(folder);
  const HostGrid& lists = grid.lists;
  nlohmann::ordered_json header;
  header["cells"] = {lists.cells_x, lists.cells_y, lists.slices};
  header["tile"] = grid.tile;
  header["slice_edges"] = grid.slice_edges;
  if (!grid.z_bin_edges.empty()) header["z_bin_edges"] = grid.z_bin_edges;
  header["settings"] = settings_json(grid.settings);
  const std::string text = text_by_fields(header);
  std::vector<NamedBytes> files = {
      {"grid.json", text}, {"grid.u32", bytes_of(lists.cells)}, {"indices.u32", bytes_of(lists.indices)}};
  if (!lists.masks.empty()) files.push_back({"masks.u32", bytes_of(lists.masks)});
  if (!grid.z_bin_edges.empty()) files.push_back({"z_bins.u32", bytes_of(lists.z_bins)});
  write_files(folder, files, grid_files);
}

std::vector<Light> local_world_lights(const CapturedFrame& frame) {
  std::vector<Light> local;
  for (const Light& light : frame.lights) {
    if (!is_directional(light)) local.push_back(light);
  }
  return local;
}

std::vector<ViewLight> local_lights(const CapturedFrame& frame) {
  Scene scene;
  scene.lights = local_world_lights(frame);
  return lights_in_view(scene, frame.view);
}

bool depth_is_reversed(const View& view) {
  return (view.orthographic ? view.clip_from_view[2][2] : view.clip_from_view[3][2]) > 0;
}

std::vector<float> covered_depth(const CapturedFrame& frame) {
  std::vector<float> depth = frame.depth;
  if (depth_is_reversed(frame.view)) return depth;
  for (float& value : depth) {
    if (!(value < 1)) {
      value = 0;
    } else if (value <= 0) {
      value = std::numeric_limits<float>::denorm_min();  // at or before the near plane
    }
  }
  return depth;
}

}  // namespace lightgrid::lab
