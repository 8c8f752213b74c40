// Objects of the C interface for tests: opened or failing loudly, and freed.
#pragma once

#include <gmock/gmock.h>

#include <memory>
#include <string>
#include <vector>

#include "c_api/lightgrid.h"

namespace lightgrid::app {

template <auto free>
struct Freed {
  template <typename T>
  void operator()(T* handle) const {
    free(handle);
  }
};
using OwnedDevice = std::unique_ptr<lightgrid_device, Freed<lightgrid_device_close>>;
using OwnedScene = std::unique_ptr<lightgrid_scene, Freed<lightgrid_scene_free>>;
using OwnedView = std::unique_ptr<lightgrid_view, Freed<lightgrid_view_close>>;
using OwnedFrame = std::unique_ptr<lightgrid_frame, Freed<lightgrid_frame_free>>;
using OwnedLists = std::unique_ptr<lightgrid_lists, Freed<lightgrid_lists_free>>;
using OwnedReport = std::unique_ptr<lightgrid_report, Freed<lightgrid_report_free>>;

inline void must(lightgrid_status status) {
  ASSERT_EQ(status, LIGHTGRID_OK) << lightgrid_error_message() << " (" << lightgrid_error_field() << ")";
}

// For fields and settings: null-terminated.
class Words {
 public:
  Words(std::initializer_list<const char*> words) : words_(words) { words_.push_back(nullptr); }
  operator const char* const*() const { return words_.data(); }

 private:
  std::vector<const char*> words_;
};

inline OwnedDevice open_device(const char* opengl) {
  lightgrid_device* device = nullptr;
  must(lightgrid_device_open(nullptr, opengl, &device));
  return OwnedDevice(device);
}

inline OwnedScene load_scene(const char* name, const Words& fields) {
  lightgrid_scene* scene = nullptr;
  must(lightgrid_scene_load(name, fields, &scene));
  return OwnedScene(scene);
}

inline OwnedView open_view(const OwnedDevice& device, const OwnedScene& scene, const char* technique,
                           const Words& settings = {}) {
  lightgrid_view* view = nullptr;
  must(lightgrid_view_open(device.get(), scene.get(), technique, settings, &view));
  return OwnedView(view);
}

template <typename T>
struct PixelsOf;
template <>
struct PixelsOf<float[4]> {
  using Value = float;
  static constexpr int values = 4;
  static constexpr lightgrid_format format = LIGHTGRID_RGBA_F32;
};
template <>
struct PixelsOf<float> {
  using Value = float;
  static constexpr int values = 1;
  static constexpr lightgrid_format format = LIGHTGRID_R_F32;
};
template <>
struct PixelsOf<uint32_t> {
  using Value = uint32_t;
  static constexpr int values = 1;
  static constexpr lightgrid_format format = LIGHTGRID_R_U32;
};

// Pixels with their lightgrid_image, row 0 at the bottom.
template <typename T>
struct Pixels {
  std::vector<typename PixelsOf<T>::Value> values;
  lightgrid_image image{};

  Pixels(int width, int height) : values(size_t(width) * size_t(height) * PixelsOf<T>::values) {
    image = {values.data(), width, height, PixelsOf<T>::format,
             ptrdiff_t(sizeof(values[0])) * width * PixelsOf<T>::values};
  }
  Pixels(Pixels&& other) noexcept : values(std::move(other.values)), image(other.image) {}
};
using Radiance = Pixels<float[4]>;
using Floats = Pixels<float>;
using Counts = Pixels<uint32_t>;

inline Radiance rendered(const OwnedView& view) {
  int32_t width = 0, height = 0;
  must(lightgrid_view_size(view.get(), &width, &height));
  Radiance image(width, height);
  must(lightgrid_view_render(view.get(), &image.image));
  return image;
}

// One device for tests that need no other, opened once a process and never closed.
inline const OwnedDevice& opencl_device() {
  static OwnedDevice* const device = new OwnedDevice(open_device("none"));
  return *device;
}

}  // namespace lightgrid::app
