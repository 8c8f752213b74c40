#include "study/bench/read_frame.h"

#include <cmath>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/lights_file.h"

namespace lightgrid {
namespace {

glm::dmat4 matrix_of(const std::filesystem::path& file, const nlohmann::json& view, const char* key) {
  if (!view.contains(key) || !view[key].is_array() || view[key].size() != 16) {
    throw input_error("{}: {}: not 16 numbers", file.string(), key);
  }
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) {
    if (!view[key][i].is_number()) throw input_error("{}: {}: not 16 numbers", file.string(), key);
    matrix[i % 4][i / 4] = view[key][i];  // written row by row
  }
  return matrix;
}

View view_of(const std::filesystem::path& file) {
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(file), nullptr, false);
  if (!json.is_object()) throw input_error("{}: no such file, or not a JSON object", file.string());
  const auto size = json.value("size", nlohmann::json());
  const auto side = [&](int i) { return size.is_array() && size.size() == 2 && size[i].is_number_integer() ? size[i].get<int>() : 0; };
  View view;
  view.width = side(0), view.height = side(1);
  if (view.width < 1 || view.height < 1 || view.width > 16384 || view.height > 16384) {
    throw input_error("{}: size: not two sides from 1 to 16384", file.string());
  }
  view.clip_from_view = matrix_of(file, json, "clip_from_view");
  view.view_from_world = matrix_of(file, json, "view_from_world");
  view.eye = glm::dvec3(glm::inverse(view.view_from_world)[3]);
  view.orthographic = view.clip_from_view[2][3] == 0;
  if (json.contains("near") && json["near"].is_number()) view.near_m = json["near"];
  if (json.contains("far") && json["far"].is_number()) view.far_m = json["far"];
  return view;
}

std::vector<float> depth_of(const std::filesystem::path& file, const View& view) {
  std::vector<float> depth(size_t(view.width) * view.height);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(depth.data()), std::streamsize(depth.size() * sizeof(float)));
  if (!stream || stream.peek() != std::ifstream::traits_type::eof()) {
    throw input_error("{}: not {} x {} floats", file.string(), view.width, view.height);
  }
  return depth;
}

}  // namespace

BenchFrame read_bench_frame(const std::filesystem::path& folder) {
  BenchFrame frame;
  frame.name = (folder.has_filename() ? folder : folder.parent_path()).filename().string();
  frame.view = view_of(folder / "view.json");
  frame.depth = depth_of(folder / "depth.f32", frame.view);
  frame.lights = load_lights_file(folder / "lights.json");
  std::erase_if(frame.lights, [](const Light& light) { return light.type == LightType::directional; });
  return frame;
}

}  // namespace lightgrid
