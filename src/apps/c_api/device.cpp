#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/compiling.h"
#include "base/log.h"
#include "base/version.h"
#include "c_api/call.h"
#include "c_api/handles.h"
#include "measures/error_measures.h"
#include "run/tables.h"
#include "scenes/builtin.h"

namespace lightgrid::app::c {
using namespace lab;
namespace {

struct OpenGlTurn {
  std::recursive_mutex mutex;
  GlContext* current = nullptr;  // context of the calls that hold it
};

OpenGlTurn& opengl_turn() {
  static OpenGlTurn* const turn = new OpenGlTurn;  // outlives every thread
  return *turn;
}

// Libraries print nothing.
const bool log_is_off = [] {
  set_log_sink([](bool, const std::string&) {});
  return true;
}();

nlohmann::ordered_json table(const std::string& name) {
  auto rows = nlohmann::ordered_json::array();
  if (name == "techniques") return techniques_json();
  if (name == "scenes") {
    for (const BuiltinScene& s : builtin_scenes()) rows.push_back({{"name", s.name}, {"summary", s.summary}});
  } else if (name == "fields") {
    for (const ChoiceField& f : choice_fields()) rows.push_back({{"name", f.name}, {"help", f.help}});
  } else if (name == "measures") {
    for (const auto measures : {error_measures(), frontier_error_measures()})
      for (const ErrorMeasure& m : measures)
        if (std::ranges::find(rows, nlohmann::ordered_json(m.key)) == rows.end()) rows.push_back(m.key);
    for (const char* flip : {"flip_mean", "displayed_flip"}) rows.push_back(flip);
  } else if (name == "devices") {
    for (const ClDeviceInfo& d : list_cl_devices())
      rows.push_back({{"name", d.name},
                      {"platform", d.platform},
                      {"driver", d.driver},
                      {"version", d.version},
                      {"cpu", d.cpu},
                      {"compute_units", d.compute_units},
                      {"global_bytes", d.global_bytes}});
  } else {
    throw wrong("table", "there is no {}; tables are techniques, scenes, fields, measures and devices", name);
  }
  return rows;
}

}  // namespace

OpenDevice::OpenDevice(const std::string& device, GlBackend backend) {
  const auto lock = backend == GlBackend::none ? std::unique_lock<std::recursive_mutex>()
                                               : std::unique_lock(opengl_turn().mutex);
  renderer_ = std::make_unique<Renderer>(device, backend);
  name = renderer_->cl->info().name;
  if (!renderer_->gl) return;
  opengl = renderer_->gl->renderer;
  renderer_->gl->leave();
}

OpenDevice::~OpenDevice() {
  const std::lock_guard lock(turn());
  try {
    const Turn in_context(*this);
    last_rasterized.reset();
  } catch (const Error&) {  // the context is lost
  }
  renderer_.reset();  // makes its own context current where it has to
}

std::recursive_mutex& OpenDevice::turn() { return renderer_->gl ? opengl_turn().mutex : own_turn_; }

std::shared_ptr<DeviceScene> OpenDevice::follow(const std::shared_ptr<LoadedScene>& scene) {
  std::erase_if(scenes_, [](const auto& held) { return held.second.expired(); });
  std::weak_ptr<DeviceScene>& known = scenes_[scene.get()];
  std::shared_ptr<DeviceScene> held = known.lock();
  if (!held) known = held = std::make_shared<DeviceScene>(DeviceScene{.scene = scene});
  if (!held->gpu || held->shape != scene->shape()) {
    held->gpu = std::make_shared<GpuScene>(renderer(), scene->scene);
    held->raster.reset();
  } else if (held->time != scene->time()) {
    held->gpu->update(scene->changes_since(held->time));
  }
  held->shape = scene->shape();
  held->time = scene->time();
  return held;
}

Turn::Turn(OpenDevice& device) : lock_(device.turn()), context_(device.renderer().gl.get()) {
  if (!context_) return;
  context_->make_current();
  outer_ = std::exchange(opengl_turn().current, context_);
}

Turn::~Turn() {
  if (!context_) return;
  opengl_turn().current = outer_;
  try {
    outer_ ? outer_->make_current() : context_->leave();
  } catch (const Error&) {  // the outer call's next OpenGL call tells
  }
}

}  // namespace lightgrid::app::c

using namespace lightgrid;
using namespace lightgrid::app::c;

extern "C" {

const char* lightgrid_version(void) {
  static const std::string text = version_of_build() + ", commit " + commit_of_build();
  return text.c_str();
}

void lightgrid_set_log(lightgrid_log_function function, void* user) {
  set_log_sink([function, user](bool warning, const std::string& line) {
    if (function) function(warning, line.c_str(), user);
  });
}

void lightgrid_set_compiling(lightgrid_compiling_function function, void* user) {
  if (!function) return set_first_compilation_function({});
  set_first_compilation_function(
      [function, user](int kernels, int total) { function(kernels, total, user); });
}

lightgrid_status lightgrid_describe(const char* name, char** json) {
  const std::vector<Warning> warnings = last_warnings();
  const lightgrid_status status = call([&] {
    char*& out = needed(json, "json");
    const std::string of = &needed(name, "table");
    out = text_for_caller(of == "warnings" ? warnings_json(warnings).dump(1) : table(of).dump(1));
  });
  last_warnings() = warnings;  // a call for a table is none of those that they are of
  return status;
}

lightgrid_status lightgrid_device_open(const char* name, const char* opengl, lightgrid_device** device) {
  return call([&] {
    lightgrid_device*& out = needed(device, "device");
    const GlBackend backend = parse_gl_backend(&needed(opengl, "opengl"));
    out = new lightgrid_device{std::make_shared<OpenDevice>(name ? name : "", backend)};
  });
}

void lightgrid_device_close(lightgrid_device* device) { delete device; }

const char* lightgrid_device_name(const lightgrid_device* device) {
  return device ? device->device->name.c_str() : nullptr;
}

const char* lightgrid_device_opengl(const lightgrid_device* device) {
  return device ? device->device->opengl.c_str() : nullptr;
}

}  // extern "C"
