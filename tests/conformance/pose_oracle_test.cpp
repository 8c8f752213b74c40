// The oracle of poses, on cases computed by hand.
#include "conformance/pose_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>

#include "support/animated_gltf.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using Bytes8 = std::vector<uint8_t>;

Bytes8 read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  return Bytes8(std::istreambuf_iterator<char>(file), {});
}

Bytes8 from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  Bytes8 out;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const size_t digit = digits.find(c);
    if (digit == std::string::npos) break;
    bits = bits << 6 | uint32_t(digit);
    count += 6;
    if (count >= 8) out.push_back(uint8_t(bits >> (count -= 8)));
  }
  return out;
}

double read_component(const uint8_t* from, int type, bool normalized) {
  const auto load = [from](auto value) {
    std::memcpy(&value, from, sizeof(value));
    return double(value);
  };
  switch (type) {
    case 5120:
      return normalized ? std::max(load(int8_t()) / 127, -1.0) : load(int8_t());
    case 5121:
      return load(uint8_t()) / (normalized ? 255 : 1);
    case 5122:
      return normalized ? std::max(load(int16_t()) / 32767, -1.0) : load(int16_t());
    case 5123:
      return load(uint16_t()) / (normalized ? 65535 : 1);
    case 5125:
      return load(uint32_t());
    default:
      return load(float());
  }
}

}  // namespace

Numbers transform(const Affine& m, const Numbers& p) {
  Numbers out(3);
  for (int row = 0; row < 3; ++row)
    out[row] = m[row * 4] * p[0] + m[row * 4 + 1] * p[1] + m[row * 4 + 2] * p[2] + m[row * 4 + 3];
  return out;
}

PoseOracle::PoseOracle(const std::filesystem::path& path) {
  const Bytes8 file = read_bytes(path);
  Bytes8 chunk;
  if (file.size() > 20 && std::memcmp(file.data(), "glTF", 4) == 0) {
    uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, 4);
    root_ = json::parse(file.begin() + 20, file.begin() + 20 + length);
    if (file.size() > 28 + length) chunk.assign(file.begin() + 28 + length, file.end());
  } else {
    root_ = json::parse(file);
  }
  for (const json& buffer : root_["buffers"]) {
    const std::string uri = buffer.value("uri", "");
    if (uri.empty()) {
      buffers_.push_back(chunk);
    } else if (uri.starts_with("data:")) {
      buffers_.push_back(from_base64(uri.substr(uri.find(',') + 1)));
    } else {
      buffers_.push_back(read_bytes(path.parent_path() / uri));
    }
  }
  for (size_t i = 0; i < root_["nodes"].size(); ++i) {
    for (const json& child : root_["nodes"][i].value("children", json::array()))
      parent_of_[child.get<int>()] = int(i);
  }
}

std::vector<Numbers> PoseOracle::elements(int index) const {
  const json& accessor = root_["accessors"][index];
  const json& view = root_["bufferViews"][accessor.at("bufferView").get<int>()];
  static const std::map<std::string, int> components_of = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  static const std::map<int, int> bytes_of_type = {{5120, 1}, {5121, 1}, {5122, 2},
                                                   {5123, 2}, {5125, 4}, {5126, 4}};
  const int components = components_of.at(accessor["type"]), type = accessor["componentType"];
  const int bytes = bytes_of_type.at(type);
  const size_t stride = view.value("byteStride", bytes * components);
  const uint8_t* first = buffers_.at(view["buffer"].get<int>()).data() + view.value("byteOffset", 0) +
                         accessor.value("byteOffset", 0);
  std::vector<Numbers> out(accessor["count"].get<size_t>(), Numbers(components));
  for (size_t i = 0; i < out.size(); ++i) {
    for (int c = 0; c < components; ++c) {
      out[i][c] = read_component(first + i * stride + c * bytes, type, accessor.value("normalized", false));
    }
  }
  return out;
}

std::map<PoseOracle::Key, Numbers> PoseOracle::animated(double seconds, int animation) const {
  std::map<Key, Numbers> out;
  if (seconds < 0) return out;
  const json animations = root_.value("animations", json::array());
  for (size_t a = 0; a < animations.size(); ++a) {
    if (animation >= 0 && size_t(animation) != a) continue;
    for (const json& channel : animations[a]["channels"]) {
      const json& sampler = animations[a]["samplers"][channel["sampler"].get<int>()];
      const std::vector<Numbers> times = elements(sampler["input"]), values = elements(sampler["output"]);
      const std::string interpolation = sampler.value("interpolation", "LINEAR"),
                        path = channel["target"]["path"];
      const size_t parts = interpolation == "CUBICSPLINE" ? 3 : 1, value = parts / 2;
      const double clamped = std::min(std::max(seconds, times.front()[0]), times.back()[0]);
      size_t k = 0;
      while (k + 2 < times.size() && times[k + 1][0] <= clamped) ++k;
      const double between = times.size() > 1 ? times[k + 1][0] - times[k][0] : 1;
      const double t = (clamped - times[k][0]) / between;
      Numbers result = values[k * parts + value];
      if (times.size() > 1 && interpolation == "STEP") {
        if (t >= 1) result = values[k + 1];
      } else if (times.size() > 1 && parts == 1) {
        const Numbers& next = values[k + 1];
        if (path == "rotation") {
          result = slerp(result, next, t);
        } else {
          for (size_t c = 0; c < result.size(); ++c) result[c] += (next[c] - result[c]) * t;
        }
      } else if (times.size() > 1) {
        for (size_t c = 0; c < result.size(); ++c) {
          result[c] = bezier(values[k * 3 + 1][c], values[k * 3 + 2][c], values[k * 3 + 4][c],
                             values[k * 3 + 3][c], between, t);
        }
      }
      out[{channel["target"]["node"].get<int>(), path}] = result;
    }
  }
  return out;
}

Affine PoseOracle::world(int index, const std::map<Key, Numbers>& values) const {
  const json& node = root_["nodes"][index];
  const auto property = [&](const char* name, const Numbers& absent) {
    const auto found = values.find({index, name});
    return found != values.end() ? found->second : node.value(name, absent);
  };
  const Affine local = node.contains("matrix")
                           ? from_columns(node["matrix"].get<Numbers>())
                           : from_transform(property("translation", {0, 0, 0}),
                                            property("rotation", {0, 0, 0, 1}), property("scale", {1, 1, 1}));
  const auto parent = parent_of_.find(index);
  return parent == parent_of_.end() ? local : product(world(parent->second, values), local);
}

Affine PoseOracle::world_of_node(int node, double seconds, int animation) const {
  return world(node, animated(seconds, animation));
}

PoseOracle::Vertices PoseOracle::skinned(const json& primitive, int skin_index, double seconds) const {
  const json& skin = root_["skins"][skin_index];
  const std::map<Key, Numbers> values = animated(seconds, -1);
  std::vector<Affine> joints;
  std::vector<Numbers> binds;
  if (skin.contains("inverseBindMatrices")) binds = elements(skin["inverseBindMatrices"]);
  for (const json& joint : skin["joints"]) {
    const Affine world_from_joint = world(joint, values);
    joints.push_back(binds.empty() ? world_from_joint
                                   : product(world_from_joint, from_columns(binds[joints.size()])));
  }
  const json& attributes = primitive["attributes"];
  const std::vector<Numbers> positions = elements(attributes["POSITION"]),
                             weights = elements(attributes["WEIGHTS_0"]),
                             indices = elements(attributes["JOINTS_0"]);
  std::vector<Numbers> normals;
  if (attributes.contains("NORMAL")) normals = elements(attributes["NORMAL"]);
  Vertices out;
  for (size_t i = 0; i < positions.size(); ++i) {
    const double sum = weights[i][0] + weights[i][1] + weights[i][2] + weights[i][3];
    Affine blend{};
    for (int k = 0; k < 4; ++k) {
      for (int e = 0; e < 12; ++e) blend[e] += joints[size_t(indices[i][k])][e] * weights[i][k] / sum;
    }
    out.positions.push_back(transform(blend, positions[i]));
    if (normals.empty()) continue;
    // The inverse transpose of three rows is their pairwise cross products, divided by the determinant
    // (positive here).
    Numbers normal(3);
    for (int row = 0; row < 3; ++row) {
      const Numbers cofactor = cross_product(row_of(blend, (row + 1) % 3), row_of(blend, (row + 2) % 3));
      for (int c = 0; c < 3; ++c) normal[row] += cofactor[c] * normals[i][c];
    }
    out.normals.push_back(to_unit(normal));
  }
  return out;
}

namespace {

PoseOracle oracle_of(const GltfBuilder& made) {
  const ModelFolder folder;
  return PoseOracle(folder.write("made.gltf", made.text()));
}

void expect_numbers(const Numbers& actual, const Numbers& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) EXPECT_NEAR(actual[i], expected[i], 1e-7);
}

TEST(PoseOracle, InterpolatesAsTheSpecificationSays) {
  GltfBuilder made = GltfBuilder::triangle();
  // 1/2 + 2 * 3 / 8 + 5/2 + 2 * 1 / 8 = 4: see scene/animation_nodes_test.cpp.
  animate(made, 0, "translation", {1, 3}, "VEC3", {9, 9, 9, 1, 0, 0, 3, 0, 0, -1, 0, 0, 5, 0, 0, 9, 9, 9},
          "CUBICSPLINE");
  animate(made, 0, "rotation", {1, 3}, "VEC4", {0, 0, 0, 1, 0, 0, -0.70710678f, -0.70710678f});
  animate(made, 0, "scale", {1, 2, 3}, "VEC3", {1, 1, 1, 2, 2, 2, 3, 3, 3}, "STEP");
  const PoseOracle oracle = oracle_of(made);
  const double angle = std::numbers::pi / 4;
  expect_numbers(transform(oracle.world_of_node(0, 2), {1, 0, 0}),
                 {4 + 2 * std::cos(angle), 2 * std::sin(angle), 0});
  expect_numbers(transform(oracle.world_of_node(0, 0), {1, 1, 0}), {2, 1, 0});
  expect_numbers(transform(oracle.world_of_node(0, 9), {1, 0, 0}), {5, 3, 0});
}

TEST(PoseOracle, MovesVerticesByTheirJoints) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  made.attribute("JOINTS_0", std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", u8, 3);
  made.attribute("WEIGHTS_0", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", f32, 3);
  made.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
  const std::vector<float> undo = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  made.root["skins"] = {{{"joints", {1, 2}},
                         {"inverseBindMatrices", made.accessor(made.view(bytes_of(undo)), "MAT4", f32, 2)}}};
  animate(made, 2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0.70710678f, 0, 0, 0.70710678f});
  const PoseOracle::Vertices out = oracle_of(made).skinned(made.primitive(), 0, 1);
  expect_numbers(out.positions[1], {1, 1, -1});
  expect_numbers(out.positions[2], {0, 1, 0});
  expect_numbers(out.normals[1], {0, -1, 0});
}

}  // namespace
}  // namespace lightgrid
