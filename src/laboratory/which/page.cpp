// The page of an answer: one self-contained HTML file.
#include <nlohmann/json.hpp>

#include "base/embedded.h"
#include "base/text.h"
#include "measures/results.h"
#include "report/report.h"
#include "which/which.h"

namespace lightgrid::lab {

std::string which_page(const WhichAnswer& answer, const std::vector<WhichChange>& changes) {
  nlohmann::ordered_json page = to_json(answer);
  for (const WhichChange& change : changes)
    page["changes"].push_back({{"what", change.what}, {"verdict", in_words(change.answer)}});
  std::string script;
  for (const char* name : {"report/page/elements.js", "report/page/table.js", "which/page/which.js"})
    script += embedded_file(name);
  return filled(embedded_file("which/page/index.html"), {{"style", embedded_file("report/page/style.css")},
                                                         {"verdict", xml_escaped(in_words(answer))},
                                                         {"page", script_json(json_text(page))},
                                                         {"script", script}});
}

}  // namespace lightgrid::lab
