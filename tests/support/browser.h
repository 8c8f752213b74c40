// A page in a real browser: a script appended to a copy of it operates the controls and records what it saw.
#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "support/paths.h"
#include "support/read_files.h"
#include "support/run_command.h"

namespace lightgrid {

// The command, or empty if there is none.
inline std::string browser() {
  std::string found =
      run_command("command -v chromium || command -v chromium-browser || command -v google-chrome").output;
  while (!found.empty() && found.back() == '\n') found.pop_back();
  return found;
}

inline std::string without_entities(std::string text) {
  for (const auto& [entity, character] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&nbsp;", "\u00a0"}, {"&amp;", "&"}}) {
    text = std::regex_replace(text, std::regex(entity), character);
  }
  return text;
}

// Returns what the script `controls` (a path below the source folder) writes as JSON into <pre id="outcome">
// of FOLDER/index.html, in a window of that size ("1280,900"); null and a failure if it writes nothing. The
// script finds errors in the array `faults`.
inline nlohmann::json seen_in_browser(const std::filesystem::path& folder, const std::string& controls,
                                      const std::string& window_size) {
  // Goes in first: errors are caught from the start of the page on.
  const std::string fault_recorder =
      "<script>window.faults = [];"
      "addEventListener('error', (event) => faults.push(event.message || 'a resource failed to load'), true);"
      "addEventListener('unhandledrejection', (event) => faults.push(String(event.reason)));"
      "for (const kind of ['error', 'warn']) console[kind] = (...words) => faults.push(words.join(' '));"
      "</script>";
  std::string page = file_bytes(folder / "index.html");
  page.insert(page.find("<style>"), fault_recorder);
  page.insert(page.rfind("</body>"),
              "<script>" + file_bytes(std::filesystem::path(source_folder) / controls) + "</script>");
  std::ofstream(folder / "tried.html") << page;
  const std::string command =
      "timeout 120 " + browser() +
      " --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking"
      " --disable-sync --disable-extensions --virtual-time-budget=5000 --dump-dom --window-size=" +
      window_size + " --user-data-dir=" + (folder / "profile").string() + " file://" +
      (folder / "tried.html").string() + " 2>" + (folder / "browser.log").string();
  const std::string dump = run_command(command).output;
  const std::string open = "<pre id=\"outcome\">";
  const size_t start = dump.rfind(open), end = dump.find("</pre>", start);
  if (start == dump.npos || end == dump.npos) {
    ADD_FAILURE() << "the page wrote no outcome; the browser said: " << file_bytes(folder / "browser.log");
    return nullptr;
  }
  return nlohmann::json::parse(without_entities(dump.substr(start + open.size(), end - start - open.size())));
}

// Fails where the page could load anything: the one http address in it may be the name of SVG.
inline void expect_no_other_place(const std::string& page) {
  const std::regex elsewhere(
      R"re((src|href)=["'](?!data:)[^"']|url\((?!data:)|@import|fetch\(|XMLHttpRequest|<iframe)re");
  std::smatch found;
  EXPECT_FALSE(std::regex_search(page, found, elsewhere)) << found.str();
  EXPECT_EQ(page.find("https://"), page.npos);
  const std::string svg = "http://www.w3.org/2000/svg";
  EXPECT_EQ(page.find("http://"), page.find(svg));
  EXPECT_EQ(page.rfind("http://"), page.find(svg));
}

}  // namespace lightgrid
