#include "frontier/write_answer.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_file.h"
#include "frontier/frontier_page.h"
#include "frontier/page_pictures.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

// Into `to`, what records name and is not there yet.
void collect_pictures(const fs::path& to, const FrontierAnswer& answer,
                      const std::vector<fs::path>& folders) {
  for (const FrontierRecord& record : answer.part.records) {
    if (record.image.empty()) continue;
    for (const char* suffix : picture_suffixes) {
      const std::string name = record.image + suffix;
      for (const fs::path& folder : folders) {
        std::error_code failure, ignored;
        if (fs::exists(to / name, failure) || !fs::exists(folder / name, failure)) continue;
        make_folder(to);
        if (fs::copy_file(folder / name, to / name, failure)) continue;
        fs::remove(to / name, ignored);  // half a picture would stay for good
        throw write_error(to / name, failure.value());
      }
    }
  }
}

}  // namespace

void write_answer(const fs::path& folder, const FrontierAnswer& answer, const std::vector<fs::path>& pictures,
                  size_t page_bytes) {
  collect_pictures(folder / "pictures", answer, pictures);
  write_file(folder / "frontier.json", json_text(to_json(answer)));
  write_file(folder / "frontier.csv", csv_text(answer));
  write_file(folder / "samples.csv", samples_csv_text(answer));
  write_file(folder / "culling.csv", cull_csv_text(answer));
  write_file(folder / "index.html", page_text(answer, folder / "pictures", page_bytes));
}

}  // namespace lightgrid
