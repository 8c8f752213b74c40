#include "scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_file.h"
#include "base/text.h"

namespace lightgrid {
namespace {

constexpr int max_views = 100'000, max_path_depth = 8;
constexpr uintmax_t max_file_bytes = 64 << 20;

// `start` from another position, with its view space turned by `turn` (world from world).
View moved(const View& start, const glm::dvec3& eye, const glm::dmat3& turn) {
  View view = start;
  const glm::dmat3 rotation = glm::dmat3(start.view_from_world) * glm::transpose(turn);
  view.eye = eye;
  view.view_from_world = glm::dmat4(rotation);
  view.view_from_world[3] = glm::dvec4(-(rotation * eye), 1);
  return view;
}

std::vector<View> turn(const View& start, int count) {
  std::vector<View> views = {start};
  for (int i = 1; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    views.push_back(
        moved(start, start.eye, glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)))));
  }
  return views;
}

std::vector<View> dolly(const Scene& scene, const View& start, int count) {
  const WorldBox box = world_box(scene);
  const double size = box.empty() ? 4 : glm::length(box.max - box.min);
  const double length = 0.25 * (std::isfinite(size) ? size : 4);  // past 1e154 m squares overflow
  const glm::dvec3 forward = -glm::transpose(glm::dmat3(start.view_from_world))[2];
  std::vector<View> views = {start};
  for (int i = 1; i < count; ++i)
    views.push_back(moved(start, start.eye + forward * (length * i / count), glm::dmat3(1)));
  return views;
}

struct Key {
  glm::dvec3 eye, target;
  double fov_deg = 60;
};

class KeyFile {
 public:
  KeyFile(const std::string& path, const std::string& text) : path_(path) {
    json_ = parsed_json(text, max_path_depth, fmt::format("camera-path {}: ", path));
    if (!json_.is_object() || !json_.contains("keys") || !json_["keys"].is_array() || json_["keys"].empty()) {
      throw input_error("camera-path {}: has no \"keys\"", path);
    }
    JsonFields(json_, fmt::format("camera-path {}: ", path)).check_fields({"frames", "keys"});
    for (size_t i = 0; i < json_["keys"].size(); ++i) keys_.push_back(key(json_["keys"][i], i));
  }

  std::vector<Key> views() const {
    const size_t count = frames();
    std::vector<Key> along;
    for (size_t i = 0; i < count; ++i) {
      const double at = count > 1 ? double(i) * double(keys_.size() - 1) / double(count - 1) : 0;
      const size_t k = std::min(size_t(at), keys_.size() - 1), next = std::min(k + 1, keys_.size() - 1);
      const double t = at - double(k);
      along.push_back({glm::mix(keys_[k].eye, keys_[next].eye, t),
                       glm::mix(keys_[k].target, keys_[next].target, t),
                       glm::mix(keys_[k].fov_deg, keys_[next].fov_deg, t)});
    }
    return along;
  }

 private:
  size_t frames() const {
    if (!json_.contains("frames")) return keys_.size();
    const nlohmann::json& frames = json_["frames"];
    if (!frames.is_number_unsigned() || frames < 1u || frames > unsigned(max_views)) {
      throw input_error("camera-path {}: frames is {}, not a number from 1 to {}", path_, frames.dump(),
                        max_views);
    }
    return frames.get<size_t>();
  }

  Key key(const nlohmann::json& object, size_t index) const {
    JsonFields(object, fmt::format("camera-path {}: key {}: ", path_, index))
        .check_fields({"eye", "target", "fov"});
    Key key{place(object, index, "eye"), place(object, index, "target")};
    if (!object.contains("fov")) return key;
    if (!object["fov"].is_number())
      throw input_error("camera-path {}: key {}: fov is not a number", path_, index);
    key.fov_deg = object["fov"].get<double>();
    return key;
  }

  glm::dvec3 place(const nlohmann::json& object, size_t index, const char* name) const {
    const auto wrong = [&] {
      return input_error("camera-path {}: key {}: {} is not three finite numbers", path_, index, name);
    };
    if (!object.contains(name)) throw wrong();
    const nlohmann::json& values = object[name];
    if (!values.is_array() || values.size() != 3) throw wrong();
    glm::dvec3 out;
    for (int i = 0; i < 3; ++i) {
      if (!values[size_t(i)].is_number()) throw wrong();
      out[i] = values[size_t(i)].get<double>();
      if (!std::isfinite(out[i]) || std::abs(out[i]) > 1e12) throw wrong();
    }
    return out;
  }

  std::string path_;
  nlohmann::json json_;
  std::vector<Key> keys_;
};

// N of "NAME:N", or empty if the text has another form.
std::optional<int> count_of(const std::string& text, const std::string& name) {
  if (!text.starts_with(name + ":")) return {};
  const auto count = parse_number<int>(std::string_view(text).substr(name.size() + 1));
  if (!count || *count < 1 || *count > max_views)
    throw input_error("camera-path {}: not {}:N with N from 1 to {}", text, name, max_views);
  return count;
}

std::string key_file(const std::string& path) {
  try {
    return read_small_file(path, max_file_bytes, "a camera path");
  } catch (const Error& error) {
    throw input_error("camera-path {}; it is neither turn:N nor dolly:N, nor a file that can be read",
                      error.what());
  }
}

}  // namespace

std::vector<View> camera_path(const Scene& scene, const View& start, const std::string& path) {
  if (const auto count = count_of(path, "turn")) return turn(start, *count);
  if (const auto count = count_of(path, "dolly")) return dolly(scene, start, *count);
  return camera_path_of_keys(start, key_file(path), path);
}

std::vector<View> camera_path_of_keys(const View& start, const std::string& text, const std::string& path) {
  std::vector<View> views;
  for (const Key& key : KeyFile(path, text).views()) {
    if (key.eye == key.target) throw input_error("camera-path {}: a target is at its eye", path);
    Camera camera = look_at(key.eye, key.target);
    camera.name = path;
    camera.fov_y_rad = glm::radians(key.fov_deg);
    camera.near_m = start.orthographic ? camera.near_m : start.near_m;
    camera.far_m = start.orthographic ? camera.far_m : start.far_m;
    views.push_back(make_view(camera, start.width, start.height));
  }
  return views;
}

}  // namespace lightgrid
