// Fuzz inputs as files: every number is stored by its bits, independent of the code that makes inputs from
// bytes.
//
// Text, one word after another: options (cull test, depth bounds, depth format, tile, samples, index bits,
// lists, portable, blend), width, height, clip_from_view, view_from_world, eye, then with a count before
// each: slice edges, z-bin edges, bounds, lights, depth. Floats and doubles are their bits in hexadecimal.
#pragma once

#include <bit>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "hard_cases/cull_fuzz.h"

namespace lightgrid::verify {

class FuzzFile {
 public:
  FuzzFile(const std::filesystem::path& path, bool write) : path_(path), write_(write) {
    stream_.open(path, write ? std::ios::out | std::ios::trunc : std::ios::in);
    stream_ >> std::hex;
    stream_ << std::hex;
  }

  void input(FuzzInput& in) {
    CullerOptions& o = in.options;
    number(o.cull_test), number(o.depth_bounds), number(o.depth_format), number(o.tile), number(o.samples);
    number(o.index_bits), number(o.lists), number(o.portable), number(o.blend);
    in.depth.samples = o.samples;
    number(in.view.width), number(in.view.height);
    matrix(in.view.clip_from_view), matrix(in.view.view_from_world), vector(in.view.eye);
    items(in.view.slice_edges, [&](float& v) { bits(v); });
    items(in.view.z_bin_edges, [&](float& v) { bits(v); });
    items(in.bounds, [&](DepthInterval& b) { bits(b.near), bits(b.far); });
    items(in.lights, [&](CullLight& l) {
      vector(l.position), bits(l.radius_m), vector(l.direction), bits(l.cos_outer);
    });
    items(in.depth.values, [&](float& v) { bits(v); });
    if (write_) stream_ << '\n';
    if (!stream_) throw std::runtime_error(path_.string() + ": cut short, or cannot be read or written");
  }

 private:
  template <typename T>
  void number(T& value) {
    uint64_t word = uint64_t(value);
    if (write_)
      stream_ << word << ' ';
    else
      stream_ >> word;
    value = T(word);
  }
  void bits(float& value) {
    uint32_t word = std::bit_cast<uint32_t>(value);
    number(word);
    value = std::bit_cast<float>(word);
  }
  void bits(double& value) {
    uint64_t word = std::bit_cast<uint64_t>(value);
    number(word);
    value = std::bit_cast<double>(word);
  }
  void vector(glm::dvec3& v) { bits(v.x), bits(v.y), bits(v.z); }
  void matrix(glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) bits(m[c][r]);
  }
  template <typename T, typename Each>
  void items(std::vector<T>& all, const Each& each) {
    size_t count = all.size();
    number(count);
    if (!stream_ || count > 10'000'000) throw std::runtime_error(path_.string() + ": a count that cannot be");
    all.resize(count);
    for (T& item : all) each(item);
    if (write_) stream_ << '\n';
  }

  std::filesystem::path path_;
  bool write_;
  std::fstream stream_;
};

inline FuzzInput read_fuzz_input(const std::filesystem::path& path) {
  FuzzInput in;
  FuzzFile(path, false).input(in);
  return in;
}

inline void write_fuzz_input(const std::filesystem::path& path, FuzzInput in) {
  FuzzFile(path, true).input(in);
}

}  // namespace lightgrid::verify
