// The libraries as other programs use them: installed, found by CMake, linked into an example of
// docs/examples.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/paths.h"
#include "support/run_command.h"

namespace lightgrid {

inline bool has_tool(const std::string& name) { return run_command("command -v " + name).status == 0; }

// The output of a command, which has to succeed.
inline std::string must_run(const std::string& command) {
  const CommandOutcome outcome = run_command(command + " 2>&1");
  EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.output;
  return outcome.output;
}

// Installs below `folder` and builds docs/examples/NAME against that. Returns the example's path.
inline std::string built_example(const std::string& name, const std::filesystem::path& folder) {
  const std::string prefix = folder / "prefix", build = folder / "build";
  must_run(fmt::format("{} --install {} --component library --prefix {}", LIGHTGRID_CMAKE,
                       LIGHTGRID_BUILD_DIR, prefix));
  must_run(fmt::format("{} -S {}/docs/examples/{} -B {} -DCMAKE_PREFIX_PATH={}", LIGHTGRID_CONFIGURE,
                       source_folder, name, build, prefix));
  must_run(fmt::format("{} --build {}", LIGHTGRID_CMAKE, build));
  return build + "/" + name;
}

}  // namespace lightgrid
