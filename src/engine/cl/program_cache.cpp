#include "cl/program_cache.h"

#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/compiling.h"
#include "base/embedded.h"
#include "cl/build_error.h"
#include "cl/error.h"
#include "cl/program_file.h"

namespace lightgrid {
namespace {

// For measurement only: "contract" lets compilers fuse products and sums, "relaxed" also everything else that
// OpenCL allows. Otherwise neither: bytes are the same on every device (docs/devices.md#same-bits).
std::string_view freedom_of_compilers() {
  const char* maths = std::getenv("LIGHTGRID_CL_MATHS");
  return maths ? maths : "";
}

// -w: clang, in PoCL, prints the number of warnings to stderr.
std::string common_options(const ClDeviceInfo& device) {
  std::string options = "-cl-std=CL1.2 -w";
  if (freedom_of_compilers() == "relaxed") return options + " -cl-fast-relaxed-math";
  if (freedom_of_compilers() == "contract") options += " -cl-mad-enable";
  if (device.exact_division) options += " -cl-fp32-correctly-rounded-divide-sqrt";
  return options;
}

// Returns whether a CPU compiles this kernel without optimisation.
bool builds_quickly(const std::string& file) {
  const char* kernels = std::getenv("LIGHTGRID_CL_QUICK_BUILD");
  return kernels && (file.find("/gpu/") != file.npos || std::string_view(kernels) == "all");
}

// PoCL 3 includes clang's opencl-c.h before each program, where this macro is not defined yet (its
// _clang_opencl.h).
bool may_declare_builtins(const ClDeviceInfo& device) {
  return device.platform == "Portable Computing Language" && device.driver.starts_with("3.");
}

std::string prelude() {
  return fmt::format("#pragma OPENCL FP_CONTRACT {}\n", freedom_of_compilers().empty() ? "OFF" : "ON");
}

// "cull_lights" for "culling/cpu/cull_lights".
std::string entry_point(const std::string& file) { return file.substr(file.rfind('/') + 1); }

bool disk_is_off() {
  const char* setting = std::getenv("LIGHTGRID_CL_CACHE");
  return setting && (std::string_view(setting) == "off" || std::string_view(setting) == "driver");
}

// Empty if the driver rejects the binary, as after an update that kept its version.
cl::Program load_binary(ClDevice& device, const std::string& options,
                        const std::vector<unsigned char>& binary) {
  try {
    cl::Program program(device.context(), {device.device()}, {binary});
    program.build(device.device(), options.c_str());
    return program;
  } catch (const cl::Error&) {
    return {};
  }
}

KernelBuildError cannot_build(const ClDeviceInfo& device, const std::string& what, const cl::Error& error,
                              const std::string& log = "") {
  return KernelBuildError(
      fmt::format("kernels/{} on {}: {} failed with {}; update its driver ({} {}), or choose another device "
                  "with --device (lightgrid devices lists them){}{}",
                  what, device.name, error.what(), cl_error_name(error.err()), device.platform, device.driver,
                  log.empty() ? "" : "\n", log));
}

cl::Program build_source(ClDevice& device, const std::string& file, const std::string& options,
                         const std::string& source) {
  cl::Program program;
  try {
    program = cl::Program(device.context(), source);
    program.build(device.device(), options.c_str());
  } catch (const cl::Error& error) {
    std::string log;
    if (program()) program.getBuildInfo(device.device(), CL_PROGRAM_BUILD_LOG, &log);
    throw cannot_build(device.info(), fmt::format("{}.cl ({})", file, options), error, log);
  }
  return program;
}

// Oclgrind builds a program and then lacks one of its kernels.
bool lacks_kernel(const cl::Error& error) {
  return error.err() == CL_INVALID_KERNEL_NAME || error.err() == CL_INVALID_PROGRAM_EXECUTABLE;
}

}  // namespace

std::filesystem::path ProgramCache::default_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache) return std::filesystem::path(cache) / "lightgrid" / "cl";
  const char* home = std::getenv("HOME");
  if (home && *home) return std::filesystem::path(home) / ".cache" / "lightgrid" / "cl";
  return {};
}

ProgramCache::ProgramCache(ClDevice& device, std::filesystem::path folder)
    : device_(device), folder_(disk_is_off() ? std::filesystem::path() : std::move(folder)) {}

cl::Kernel ProgramCache::kernel(const std::string& file, const std::string& defines) {
  if (asked_) asked_->insert(file + ' ' + defines);
  const bool declared = may_declare_builtins(device_.info());
  return kernel_of(file + ' ' + defines, file, declared ? "-D_OPENCL_H_ " + defines : defines, [&] {
    std::string text = with_includes("kernels/" + file + ".cl");
    if (alter_) text = alter_(std::move(text));
    return declared ? with_includes("kernels/common/builtins.h") + text : text;
  });
}

cl::Kernel ProgramCache::kernel_of_source(const std::string& file, const std::string& source,
                                          const std::string& defines) {
  return kernel_of(defines + '\n' + source, file, defines, [&] { return source; });
}

cl::Kernel ProgramCache::kernel_of(const std::string& key, const std::string& file,
                                   const std::string& defines, const std::function<std::string()>& source) {
  try {
    cl::Program& program = programs_[key];
    if (program()) {
      ++counts_.from_memory;
    } else {
      std::string options = common_options(device_.info()) + (defines.empty() ? "" : " " + defines);
      if (device_.info().cpu && builds_quickly(file)) options += " -cl-opt-disable";
      program = load_or_build(file, options, prelude() + source());
    }
    return cl::Kernel(program, entry_point(file).c_str());
  } catch (const cl::Error& error) {
    if (lacks_kernel(error)) throw cannot_build(device_.info(), file + ".cl", error);
    throw cl_machine_error(error, "kernels/" + file + ".cl");
  }
}

cl::Program ProgramCache::load_or_build(const std::string& kernel_file, const std::string& options,
                                        const std::string& source) {
  const ClDeviceInfo& info = device_.info();
  const std::string key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}", info.platform, info.name, info.version,
                                      info.driver, options, source);
  const std::filesystem::path file =
      folder_.empty() ? "" : program_file_path(folder_, entry_point(kernel_file), key);
  if (!file.empty()) {
    const std::vector<unsigned char> binary = read_program_file(file, key);
    if (!binary.empty()) {
      if (cl::Program program = load_binary(device_, options, binary); program()) {
        ++counts_.from_disk;
        return program;
      }
    }
  }
  tell_compiling("kernels/" + kernel_file + ".cl");
  std::optional<FirstCompilation> first;
  if (!file.empty()) first.emplace();
  cl::Program program = build_source(device_, kernel_file, options, source);
  ++counts_.built;
  if (!file.empty()) {
    const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (!binaries.empty() && !binaries[0].empty()) write_program_file(file, key, binaries[0]);
  }
  return program;
}

}  // namespace lightgrid
