// lightgrid devices: the available OpenCL devices and OpenGL backends, and which of them would be used.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <memory>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bridge/shared_buffer.h"
#include "cl/tuned_sizes.h"
#include "command_line/commands.h"
#include "command_line/options.h"

namespace lightgrid::app {
namespace {

struct DevicesOptions {
  DeviceOptions devices;
  std::string json;
};

struct GlFound {
  std::string backend;
  std::unique_ptr<GlContext> context;  // null: `why` has the reason
  std::string why;
};

struct Found {
  std::vector<ClDeviceInfo> cl;
  std::vector<GlFound> gl;
  int chosen_cl = -1, chosen_gl = -1;  // -1: none is usable, for the reason in `problems`
  TunedSizes tuned;                    // sizes for the chosen OpenCL device
  std::string bridge;
  std::string why_staged;  // reason for the bridge "staged", else empty
  std::vector<std::string> problems;
};

GlFound try_gl(const char* name) {
  try {
    return {name, GlContext::create(parse_gl_backend(name)), ""};
  } catch (const Error& error) {
    return {name, nullptr, error.what()};
  }
}

void choose_gl(Found& found, GlBackend wanted) {
  try {
    const auto context = GlContext::create(wanted);
    for (size_t i = 0; i < found.gl.size(); ++i)
      if (found.gl[i].backend == context->backend) found.chosen_gl = int(i);
  } catch (const Error& error) {
    found.problems.push_back(error.what());
  }
}

void choose_bridge(Found& found, GlContext& gl) {
  ClDevice cl("#" + std::to_string(found.chosen_cl));
  gl.make_current();
  const BridgeKind kind = choose_bridge(cl, gl);
  found.bridge = to_string(kind);
  if (kind == BridgeKind::staged)
    found.why_staged = std::getenv("LIGHTGRID_BRIDGE") ? "LIGHTGRID_BRIDGE=staged" : why_not_imported(cl, gl);
}

Found find_devices(const DeviceOptions& o) {
  const GlBackend wanted = parse_gl_backend(o.gl);
  Found found;
  found.cl = list_cl_devices();
  try {
    found.chosen_cl = int(choose_cl_device(found.cl, o.device));
  } catch (const Error& error) {
    found.problems.push_back(error.what());
  }
  if (found.chosen_cl >= 0) found.tuned = read_tuned_sizes(found.cl[found.chosen_cl]);
  for (const char* name : {"osmesa", "egl"}) found.gl.push_back(try_gl(name));
  if (wanted != GlBackend::none) choose_gl(found, wanted);
  if (found.chosen_cl >= 0 && found.chosen_gl >= 0) {
    choose_bridge(found, *found.gl[found.chosen_gl].context);
  }
  return found;
}

void print(const Found& found) {
  auto mark = [](bool chosen) { return chosen ? '*' : ' '; };
  fmt::print("OpenCL devices\n");
  for (int i = 0; i < int(found.cl.size()); ++i) {
    const ClDeviceInfo& d = found.cl[i];
    fmt::print("{} #{} {} {}: {}, {} compute units, {:.1f} GiB, driver {}, {}\n", mark(i == found.chosen_cl),
               i, d.platform, d.name, d.cpu ? "CPU" : "GPU", d.compute_units,
               double(d.global_bytes) / (1 << 30), d.driver, d.version);
    if (const std::string why = why_not_the_same_bytes(d); !why.empty()) {
      fmt::print("    light grids may differ in some bytes from other devices': {}\n", why);
    }
    if (i != found.chosen_cl || found.tuned.empty()) continue;
    for (const auto& [key, value] : found.tuned) fmt::print("    tuned: {}={}\n", key, value);
    fmt::print("    in {}\n", tuned_sizes_file().string());
  }
  if (found.cl.empty()) fmt::print("  none\n");
  fmt::print("OpenGL backends\n");
  for (int i = 0; i < int(found.gl.size()); ++i) {
    const GlFound& g = found.gl[i];
    if (g.context) {
      fmt::print("{} {:<6} {}: {}, OpenGL {}, {}\n", mark(i == found.chosen_gl), g.backend,
                 g.context->software ? "software" : "hardware", g.context->renderer, g.context->version,
                 g.context->vendor);
    } else {
      fmt::print("  {:<6} not available: {}\n", g.backend, g.why);
    }
  }
  const std::string bridge = !found.bridge.empty() ? found.bridge
                             : found.cl.empty()    ? "none: every technique needs an OpenCL device"
                                                   : "none: visibility draws without OpenGL";
  fmt::print("Bridge\n  {}{}\n", bridge, found.why_staged.empty() ? "" : ": " + found.why_staged);
}

nlohmann::ordered_json to_json(const Found& found) {
  nlohmann::ordered_json json = {{"cl", nlohmann::ordered_json::array()},
                                 {"gl", nlohmann::ordered_json::array()},
                                 {"bridge", nullptr},
                                 {"problems", found.problems}};
  for (int i = 0; i < int(found.cl.size()); ++i) {
    const ClDeviceInfo& d = found.cl[i];
    json["cl"].push_back({{"name", d.name},
                          {"platform", d.platform},
                          {"vendor", d.vendor},
                          {"driver", d.driver},
                          {"version", d.version},
                          {"cpu", d.cpu},
                          {"compute_units", d.compute_units},
                          {"global_bytes", d.global_bytes},
                          {"local_bytes", d.local_bytes},
                          {"max_allocation_bytes", d.max_allocation_bytes},
                          {"chosen", i == found.chosen_cl}});
  }
  for (int i = 0; i < int(found.gl.size()); ++i) {
    const GlFound& g = found.gl[i];
    nlohmann::ordered_json row = {{"backend", g.backend}, {"available", g.context != nullptr}};
    if (g.context) {
      row["vendor"] = g.context->vendor;
      row["renderer"] = g.context->renderer;
      row["version"] = g.context->version;
      row["software"] = g.context->software;
    } else {
      row["why"] = g.why;
    }
    row["chosen"] = i == found.chosen_gl;
    json["gl"].push_back(row);
  }
  if (!found.bridge.empty()) json["bridge"] = found.bridge;
  if (!found.why_staged.empty()) json["why_staged"] = found.why_staged;
  json["tuned"] = {{"file", tuned_sizes_file().string()}, {"settings", found.tuned}};
  return json;
}

// Lists what is available, and reports on stderr what is missing; that is a failure only if the missing one
// was requested by name.
int list_devices(const DevicesOptions& o) {
  const Found found = find_devices(o.devices);
  if (o.json.empty()) {
    print(found);
  } else {
    write_json(o.json, to_json(found).dump(1));
  }
  for (const std::string& problem : found.problems) std::fprintf(stderr, "lightgrid: %s\n", problem.c_str());
  const bool asked = (!o.devices.device.empty() && found.chosen_cl < 0) ||
                     (o.devices.gl != "auto" && o.devices.gl != "none" && found.chosen_gl < 0);
  return asked ? int(ErrorKind::machine) : 0;
}

}  // namespace

void add_devices(CommandLine& line) {
  auto o = std::make_shared<DevicesOptions>();
  Subcommand command = line.add("devices", "the available OpenCL devices and OpenGL backends",
                                [o] { return list_devices(*o); });
  add_device_options(command, o->devices);
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
