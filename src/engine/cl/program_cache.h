// OpenCL programs, built once: kept in memory and on disk.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "cl/device.h"

namespace lightgrid {

class KernelBuilder;
struct ProgramSource;

// Thrown where a kernel would be compiled (ProgramCache::throw_if_missing).
struct KernelMissing {};

// The programs of a device by their source and options.
class ProgramCache {
 public:
  // Binaries are stored in `folder` (default: $XDG_CACHE_HOME/lightgrid/cl or ~/.cache/lightgrid/cl), keyed
  // by source, options, device and driver. Files are written whole and renamed, so that two processes may
  // share the folder; a file that does not load is rebuilt and replaced. LIGHTGRID_CL_CACHE=off disables the
  // disk cache; "driver" does the same but keeps the driver's own cache. PoCL compiles each kernel a second
  // time to return its binary: without our cache a first build took less than half as long, and each later
  // start 35 ms a kernel more (measured with `verify --filter depth/all_sky$`, empty and warm caches).
  // With LIGHTGRID_CL_QUICK_BUILD=gpu a CPU compiles the kernels of kernels/*/gpu without optimisation, with
  // "all" every kernel: optimisation is most of a kernel's build time. For tests only (docs/testing.md).
  explicit ProgramCache(ClDevice& device, std::filesystem::path folder = default_folder());
  ~ProgramCache();

  // The kernel of the embedded file "kernels/<file>.cl" (e.g. "culling/cpu/depth_bounds") with its includes,
  // built with the options that all kernels share (no contraction, no fast-math) and `defines` (e.g.
  // "-DLANES=16 -DTILE=16"). It has the file's own name, without the folder.
  cl::Kernel kernel(const std::string& file, const std::string& defines);

  // The same for a source that is not embedded; `file` names it in messages (tests, tools).
  cl::Kernel kernel_of_source(const std::string& file, const std::string& source, const std::string& defines);

  // In a dry run of the device: begins to compile this kernel on another thread if it is neither in memory
  // nor on disk, and returns true. Else returns false.
  bool request(const std::string& file, const std::string& defines);
  void finish_requests();  // waits for them
  // While true, kernel() throws KernelMissing instead of compiling an embedded kernel that would be stored on
  // disk.
  void throw_if_missing(bool enabled) { throws_if_missing_ = enabled; }

  // Kernels that were asked for, by where they came from.
  struct Counts {
    int built = 0;        // compiled from source
    int from_disk = 0;    // loaded from a binary
    int from_memory = 0;  // built or loaded before
  };
  const Counts& counts() const { return counts_; }  // so far

  // Changes the text of each embedded kernel before it is built, from now on. For tests, which plant faults.
  using Alter = std::function<std::string(std::string text)>;
  void alter(Alter alter) { alter_ = std::move(alter); }

  // From now on the set receives the file and the defines of each embedded kernel in use; null: no longer.
  void note_kernels(std::set<std::string>* asked) { asked_ = asked; }

  // Where binaries are stored; empty if neither variable is set. Nothing is created.
  static std::filesystem::path default_folder();

 private:
  // `key` is a key of programs_; `source` returns the text if it is not in memory.
  cl::Kernel kernel_of(const std::string& key, const std::string& file, const std::string& defines,
                       const std::function<std::string()>& source);
  // The source of an embedded file, with what options() adds.
  std::string text_of(const std::string& file) const;
  std::string defines_of(const std::string& defines) const;
  ProgramSource source_of(const std::string& file, const std::string& defines, const std::string& text) const;
  cl::Program load_or_build(const std::string& file, const ProgramSource& source);
  cl::Program load(const std::string& file, const ProgramSource& source);

  ClDevice& device_;
  std::filesystem::path folder_;
  std::map<std::string, cl::Program> programs_;
  Counts counts_;
  std::set<std::string>* asked_ = nullptr;
  Alter alter_;
  bool throws_if_missing_ = false;
  std::unique_ptr<KernelBuilder> builder_;  // null until the first request
};

}  // namespace lightgrid
