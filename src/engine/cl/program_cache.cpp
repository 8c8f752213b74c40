#include "cl/program_cache.h"

#include <cstdlib>
#include <optional>
#include <string_view>

#include "base/compiling.h"
#include "base/embedded.h"
#include "cl/build_error.h"
#include "cl/error.h"
#include "cl/kernel_builder.h"
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

ProgramCache::~ProgramCache() = default;

std::string ProgramCache::text_of(const std::string& file) const {
  std::string text = with_includes("kernels/" + file + ".cl");
  if (alter_) text = alter_(std::move(text));
  return may_declare_builtins(device_.info()) ? with_includes("kernels/common/builtins.h") + text : text;
}

std::string ProgramCache::defines_of(const std::string& defines) const {
  return may_declare_builtins(device_.info()) ? "-D_OPENCL_H_ " + defines : defines;
}

ProgramSource ProgramCache::source_of(const std::string& file, const std::string& defines,
                                      const std::string& text) const {
  const ClDeviceInfo& info = device_.info();
  ProgramSource source{
      common_options(info) + (defines.empty() ? "" : " " + defines), prelude() + text, {}, {}};
  if (info.cpu && builds_quickly(file)) source.options += " -cl-opt-disable";
  source.key = fmt::format("{}\n{}\n{}\n{}\n{}\n{}", info.platform, info.name, info.version, info.driver,
                           source.options, source.text);
  if (!folder_.empty()) source.path = program_file_path(folder_, entry_point(file), source.key);
  return source;
}

bool ProgramCache::request(const std::string& file, const std::string& defines) {
  if (!device_.dry_run) return false;
  const auto known = programs_.find(file + ' ' + defines);
  if (folder_.empty() || (known != programs_.end() && known->second())) return true;
  const ProgramSource source = source_of(file, defines_of(defines), text_of(file));
  std::error_code unknown;
  if (std::filesystem::exists(source.path, unknown)) return true;
  if (!builder_) builder_ = std::make_unique<KernelBuilder>(device_);
  builder_->add(source);
  return true;
}

void ProgramCache::finish_requests() {
  if (builder_) builder_->finish();
}

cl::Kernel ProgramCache::kernel(const std::string& file, const std::string& defines) {
  if (asked_) asked_->insert(file + ' ' + defines);
  return kernel_of(file + ' ' + defines, file, defines_of(defines), [&] { return text_of(file); });
}

cl::Kernel ProgramCache::kernel_of_source(const std::string& file, const std::string& source,
                                          const std::string& defines) {
  return kernel_of(defines + '\n' + source, file, defines, [&] { return source; });
}

cl::Kernel ProgramCache::kernel_of(const std::string& key, const std::string& file,
                                   const std::string& defines, const std::function<std::string()>& source) {
  try {
    cl::Program& program = programs_[key];
    if (program())
      ++counts_.from_memory;
    else
      program = load_or_build(file, source_of(file, defines, source()));
    return cl::Kernel(program, entry_point(file).c_str());
  } catch (const cl::Error& error) {
    if (lacks_kernel(error)) throw cannot_build(device_.info(), file + ".cl", error);
    throw cl_machine_error(error, "kernels/" + file + ".cl");
  }
}

// Empty if it is neither requested nor on disk.
cl::Program ProgramCache::load(const std::string& file, const ProgramSource& source) {
  if (source.path.empty()) return {};
  std::vector<unsigned char> binary;
  if (builder_) binary = builder_->take(source.key);
  int& count = binary.empty() ? counts_.from_disk : counts_.built;
  if (binary.empty()) {
    binary = read_program_file(source.path, source.key);
  } else {
    tell_compiling("kernels/" + file + ".cl");
  }
  if (binary.empty()) return {};
  cl::Program program = load_binary(device_, source.options, binary);
  if (program()) ++count;
  return program;
}

cl::Program ProgramCache::load_or_build(const std::string& file, const ProgramSource& source) {
  if (cl::Program program = load(file, source); program()) return program;
  if (throws_if_missing_ && !source.path.empty()) throw KernelMissing();
  tell_compiling("kernels/" + file + ".cl");
  std::optional<FirstCompilation> first;
  if (!source.path.empty()) first.emplace().begin();
  cl::Program program = build_source(device_, file, source.options, source.text);
  ++counts_.built;
  if (source.path.empty()) return program;
  const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
  if (!binaries.empty() && !binaries[0].empty()) write_program_file(source.path, source.key, binaries[0]);
  return program;
}

}  // namespace lightgrid
