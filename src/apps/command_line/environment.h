// Environment variables that drivers read at their first call, set by the program.
#pragma once

#include <filesystem>
#include <string>

namespace lightgrid::app {

// Sets the variables in docs/devices.md#environment, except those that the user has set. main calls it first,
// before other threads start and before any OpenCL or EGL call. The libraries do not change a host program's
// environment.
void prepare_environment();

// Sets POCL_CACHE_DIR to a new folder in the system's temporary one if PoCL's own is not writable, or its
// disk has less than 32 MB of room, and the user has set none. main creates it before other threads start and
// before the first OpenCL call; it removes the folder at the end. If no temporary folder can be created
// either, nothing is set, and ClDevice reports the fault.
class TemporaryCache {
 public:
  TemporaryCache();
  ~TemporaryCache();
  TemporaryCache(const TemporaryCache&) = delete;
  TemporaryCache& operator=(const TemporaryCache&) = delete;

  const std::filesystem::path& folder() const { return folder_; }  // empty: the usual one is used
  void tell() const;  // reports on stderr that compiled kernels are lost at the end, and why

 private:
  std::filesystem::path folder_;
  std::string why_;
};

}  // namespace lightgrid::app
