// Writes the texts of kernels and shaders with their includes, as the program compiles them, into a folder.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/embedded.h"

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_texts FOLDER\n", stderr);
    return 2;
  }
  for (const auto& [path, text] : lightgrid::embedded_files()) {
    const std::filesystem::path file(path), to = std::filesystem::path(arguments[1]) / file;
    const auto kind = file.extension();
    if (kind != ".cl" && kind != ".frag" && kind != ".vert" && kind != ".comp") continue;
    std::filesystem::create_directories(to.parent_path());
    std::ofstream(to) << lightgrid::with_includes(path);
  }
}
