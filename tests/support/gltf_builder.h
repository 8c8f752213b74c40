// Small glTF files made in code.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load_gltf.h"
#include "support/temp_folder.h"

namespace lightgrid {

using Bytes = std::vector<uint8_t>;

template <typename T>
Bytes bytes_of(const std::vector<T>& values) {
  Bytes out(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
  return out;
}

struct ModelFolder : TempFolder {
  std::filesystem::path write(const std::string& name, const Bytes& bytes) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path / name;
  }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    return write(name, Bytes(text.begin(), text.end()));
  }
};

inline std::string base64(const Bytes& bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

enum ComponentType { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// One buffer, one mesh of one primitive, one node, one scene; tests change `root` as they like.
struct GltfBuilder {
  nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  Bytes bin;

  // A triangle with corners (0,0,0), (1,0,0), (0,1,0).
  static GltfBuilder triangle() {
    GltfBuilder out;
    out.root["scenes"] = {{{"nodes", {0}}}};
    out.root["nodes"] = {{{"mesh", 0}}};
    out.root["meshes"] = {{{"primitives", {{{"attributes", nlohmann::json::object()}}}}}};
    out.attribute("POSITION", std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", f32, 3);
    return out;
  }

  nlohmann::json& primitive() { return root["meshes"][0]["primitives"][0]; }
  nlohmann::json& node() { return root["nodes"][0]; }

  int view(const Bytes& bytes, int stride = 0) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", bytes.size()}};
    if (stride) view["byteStride"] = stride;
    bin.insert(bin.end(), bytes.begin(), bytes.end());
    root["bufferViews"].push_back(view);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }

  int accessor(int view, const char* type, ComponentType component, size_t count, bool normalized = false) {
    nlohmann::json accessor = {{"type", type}, {"componentType", int(component)}, {"count", count}};
    if (view >= 0) accessor["bufferView"] = view;
    if (normalized) accessor["normalized"] = true;
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  template <typename T>
  int attribute(const char* name, const std::vector<T>& values, const char* type, ComponentType component,
                size_t count, bool normalized = false, int stride = 0) {
    const int index = accessor(view(bytes_of(values), stride), type, component, count, normalized);
    primitive()["attributes"][name] = index;
    return index;
  }

  template <typename T>
  int indices(const std::vector<T>& values, ComponentType component) {
    const int index = accessor(view(bytes_of(values)), "SCALAR", component, values.size());
    primitive()["indices"] = index;
    return index;
  }

  // The buffer as a data URI.
  std::string text() const {
    nlohmann::json out = root;
    if (!bin.empty() && !out.contains("buffers"))
      out["buffers"] = {
          {{"byteLength", bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
    return out.dump();
  }

  Bytes glb() const {
    nlohmann::json with_buffer = root;
    if (!with_buffer.contains("buffers")) with_buffer["buffers"] = {{{"byteLength", bin.size()}}};
    std::string json = with_buffer.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    Bytes padded = bin;
    padded.resize((bin.size() + 3) / 4 * 4);
    std::vector<uint32_t> head = {0x46546c67, 2, uint32_t(28 + json.size() + padded.size()),
                                  uint32_t(json.size()), 0x4e4f534a};
    Bytes out = bytes_of(head);
    out.insert(out.end(), json.begin(), json.end());
    const Bytes chunk = bytes_of(std::vector<uint32_t>{uint32_t(padded.size()), 0x004e4942});
    out.insert(out.end(), chunk.begin(), chunk.end());
    out.insert(out.end(), padded.begin(), padded.end());
    return out;
  }

  Scene load(const GltfLimits& limits = {}, int scene = -1) const {
    const ModelFolder folder;
    return load_gltf(folder.write("made.gltf", text()), scene, limits);
  }

  // The warnings of loading about images that are replaced by a checkerboard, a line each.
  std::string broken_images(const GltfLimits& limits = {}) const {
    testing::internal::CaptureStderr();
    load(limits);
    const std::string lines = testing::internal::GetCapturedStderr();
    EXPECT_THAT(lines, testing::HasSubstr("a checkerboard is drawn in its place"));
    return lines;
  }

  // The message of the input error that loading must end in, without the folder.
  std::string refusal(const GltfLimits& limits = {}, int scene = -1) const {
    try {
      load(limits, scene);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      const std::string what = error.what();
      return what.substr(std::min(what.size(), what.find("made.gltf")));
    }
    ADD_FAILURE() << "loads, but must not";
    return {};
  }
};

// The message of the input error that loading `path` must end in.
inline std::string refusal_of(const std::filesystem::path& path) {
  try {
    load_gltf(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  ADD_FAILURE() << path << " loads, but must not";
  return {};
}

// The text that `work` writes to stderr.
template <typename Work>
std::string warnings_of(const Work& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

}  // namespace lightgrid
