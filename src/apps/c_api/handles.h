// The contents of the handles of lightgrid.h.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "raster/raster_view.h"
#include "run/scene_choice.h"
#include "run/technique_run.h"

namespace lightgrid::app::c {

// A scene that may change between frames. Its counters tell what changed since a device or a view last read
// it.
class LoadedScene {
 public:
  // view: of a choice that was already applied to the scene.
  LoadedScene(Scene loaded, SceneChoice chosen, std::optional<View> view = {})
      : scene(std::move(loaded)), choice(std::move(chosen)), view_(std::move(view)) {}

  Scene scene;
  const SceneChoice choice;
  std::vector<Warning> warnings;  // warnings of loading, and of choosing the view

  // The view that the fields choose, and with it their lights, at the first call. May be called from two
  // threads.
  const View& view();
  // The fields' camera for an image of this width over height.
  Camera camera(double aspect) const;
  // Another number of meshes, instances or lights: everything on devices is then made anew.
  void rebuilt() { ++shape_; }
  void moved_instance(size_t i) { moved(instances_, scene.instances.size(), i); }
  void moved_light(size_t i) { moved(lights_, scene.lights.size(), i); }

  uint64_t shape() const { return shape_; }
  uint64_t time() const { return time_; }
  // The changes since time() was `time`.
  SceneChanges changes_since(uint64_t time) const;

 private:
  void moved(std::vector<uint64_t>& times, size_t count, size_t i) {
    times.resize(count);
    times[i] = ++time_;
  }

  std::mutex choosing_;
  std::optional<View> view_;
  uint64_t shape_ = 0, time_ = 0;
  std::vector<uint64_t> instances_, lights_;  // when each moved last; missing: never
};

// A scene on a device.
struct DeviceScene {
  std::shared_ptr<LoadedScene> scene;
  std::shared_ptr<GpuScene> gpu{};  // another one after the scene's shape changed
  uint64_t shape = 0, time = 0;     // the scene's when `gpu` last read it

  struct Raster {
    std::shared_ptr<RasterScene> scene;
    RasterView view;
    uint64_t shape = ~uint64_t(0), time = 0;  // when its instances were set
  };
  std::unique_ptr<Raster> raster{};
};

class OpenDevice {
 public:
  OpenDevice(const std::string& name, GlBackend backend);
  ~OpenDevice();

  Renderer& renderer() { return *renderer_; }
  std::recursive_mutex& turn();
  std::string name, opengl;

  // The scene as it now is.
  std::shared_ptr<DeviceScene> follow(const std::shared_ptr<LoadedScene>& scene);
  // Keeps what lightgrid_rasterize made, for the next call with the same scene.
  std::shared_ptr<DeviceScene> last_rasterized;

 private:
  std::recursive_mutex own_turn_;
  std::unique_ptr<Renderer> renderer_;
  std::map<const LoadedScene*, std::weak_ptr<DeviceScene>> scenes_;
};

// While a call uses a device: calls on one take turns. OpenGL's functions and some of the program's records
// of it belong to the process, so that all calls that have it take turns. They leave their thread without its
// context.
class Turn {
 public:
  explicit Turn(OpenDevice& device);
  ~Turn();
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  GlContext *context_, *outer_ = nullptr;  // outer_: of the call from whose callback this one comes
};

// Runs `work` on a device that the handle holds, and then lets go of what the handle held.
template <typename Handle>
void close(Handle* handle) noexcept {
  if (!handle) return;
  const std::shared_ptr<OpenDevice> device = handle->device;
  try {
    const Turn turn(*device);
    delete handle;
  } catch (...) {  // the context is lost
    delete handle;
  }
}

std::vector<Light> lights_of(const lightgrid_light* lights, size_t count);
Camera camera_of(const lightgrid_camera& camera);
lightgrid_projection projection_of(const View& view);
glm::dmat4 matrix_of(const double* values, const char* name);

}  // namespace lightgrid::app::c

struct lightgrid_device {
  std::shared_ptr<lightgrid::app::c::OpenDevice> device;
};

struct lightgrid_scene {
  std::shared_ptr<lightgrid::app::c::LoadedScene> loaded;
};

struct lightgrid_view {
  std::shared_ptr<lightgrid::app::c::OpenDevice> device;
  std::shared_ptr<lightgrid::app::c::DeviceScene> scene;
  const lightgrid::Technique* technique = nullptr;
  lightgrid::Settings settings;
  lightgrid::View view;
  std::shared_ptr<lightgrid::GpuScene> gpu;  // that the run reads
  std::shared_ptr<lightgrid::TechniqueRun> run;
  uint64_t shape = 0, time = 0;  // the scene's when `run` last read it
  bool drawn = false;            // a frame of this camera and this scene
};

// Keeps the memory of a frame's image, and what that needs.
struct lightgrid_frame {
  std::shared_ptr<lightgrid::app::c::OpenDevice> device;
  std::shared_ptr<lightgrid::app::c::DeviceScene> scene;
  std::shared_ptr<lightgrid::GpuScene> gpu;
  std::shared_ptr<lightgrid::TechniqueRun> run;
};
