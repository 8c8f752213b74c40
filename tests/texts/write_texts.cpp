// Writes the texts of kernels and shaders with their includes, as the program compiles them, into a folder. In
// FOLDER/without/NAME are those of a program without the effect NAME.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/embedded.h"

namespace {

void write_texts(const std::filesystem::path& folder, const lightgrid::EmbeddedFiles& files) {
  for (const auto& [path, text] : files) {
    const std::filesystem::path file(path), to = folder / file;
    const auto kind = file.extension();
    if (kind != ".cl" && kind != ".frag" && kind != ".vert" && kind != ".comp") continue;
    std::filesystem::create_directories(to.parent_path());
    std::ofstream(to) << lightgrid::with_includes(path, files);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_texts FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::remove_all(folder);
  const lightgrid::EmbeddedFiles& all = lightgrid::embedded_files();
  write_texts(folder, all);
  for (const auto& [path, text] : all) {
    if (!path.starts_with("shared/effects/")) continue;
    lightgrid::EmbeddedFiles others = all;
    others.erase(path);
    std::erase_if(others, [&](const auto& file) {  // the effect's own kernels
      return file.first.starts_with("kernels/") &&
             file.second.find("#include \"" + path + '"') != std::string::npos;
    });
    write_texts(folder / "without" / std::filesystem::path(path).stem(), others);
  }
}
