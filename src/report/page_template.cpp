#include "report/page_template.h"

namespace lightgrid {

std::string script_json(const std::string& text) {
  std::string safe;
  safe.reserve(text.size());
  for (char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values) {
  std::string text;
  while (true) {
    const size_t open = page.find("{{"), close = page.find("}}", open);
    if (open == page.npos || close == page.npos) return text.append(page);
    text.append(page.substr(0, open));
    text.append(values.at(page.substr(open + 2, close - open - 2)));
    page.remove_prefix(close + 2);
  }
}

}  // namespace lightgrid
