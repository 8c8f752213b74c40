#include "report/limits_page.h"

#include <fmt/format.h>

#include "base/embedded.h"
#include "base/text.h"
#include "report/report.h"

namespace lightgrid::lab {

// Rings over a picture of this aspect.
static std::string rings(const std::vector<glm::vec2>& marks, double aspect) {
  if (marks.empty()) return "";
  constexpr int height = 1000;
  std::string text =
      fmt::format("<svg viewBox=\"0 0 {:.0f} {}\" aria-hidden=\"true\">", aspect * height, height);
  for (const glm::vec2& mark : marks)
    text += fmt::format("<circle cx=\"{:.0f}\" cy=\"{:.0f}\" r=\"13\"/>", mark.x * aspect * height,
                        mark.y * height);
  return text + "</svg>";
}

static std::string section_text(const LimitSection& section, double aspect) {
  std::string text =
      fmt::format("<section>\n<h2>{}: <span class=\"{}\">{}</span></h2>\n", xml_escaped(section.title),
                  section.holds ? "good" : "bad", section.holds ? "holds" : "drops lights");
  if (!section.pictures.empty()) text += "<div class=\"pair\">\n";
  for (const PagePicture& picture : section.pictures)
    text += fmt::format(
        "<figure><div><img alt=\"{0}\" data-picture=\"{1}\">{2}</div><figcaption>{0}</figcaption></figure>\n",
        xml_escaped(picture.caption), picture.number, rings(picture.marks, aspect));
  if (!section.pictures.empty()) text += "</div>\n";
  for (const std::string& sentence : section.sentences)
    text += fmt::format("<p>{}</p>\n", xml_escaped(sentence));
  return text + fmt::format("<p class=\"quiet\">Source: <a href=\"{0}\">{0}</a></p>\n</section>\n",
                            xml_escaped(section.source));
}

static std::string warnings_text(const std::vector<Warning>& warnings) {
  if (warnings.empty()) return "";
  std::string text = "<ul id=\"warnings\">\n";
  for (const Warning& warning : warnings) {
    text += "<li>" + xml_escaped(warning.text);
    if (!warning.command.empty()) text += "<div><code>" + xml_escaped(warning.command) + "</code></div>";
    text += "</li>\n";
  }
  return text + "</ul>\n";
}

std::string limits_page(const LimitsPage& page) {
  std::string sections;
  for (const bool holds : {false, true}) {
    for (const LimitSection& section : page.sections)
      if (section.holds == holds) sections += section_text(section, page.aspect);
  }
  std::string pictures;
  for (const std::vector<uint8_t>& png : page.pictures)
    pictures += fmt::format("{}\"data:image/png;base64,{}\"", pictures.empty() ? "" : ",\n", base64(png));
  return filled(embedded_file("report/page/limits.html"), {{"style", embedded_file("report/page/style.css")},
                                                           {"scene", xml_escaped(page.scene)},
                                                           {"view", xml_escaped(page.view)},
                                                           {"verdict", xml_escaped(page.verdict)},
                                                           {"warnings", warnings_text(page.warnings)},
                                                           {"sections", sections},
                                                           {"pictures", pictures}});
}

}  // namespace lightgrid::lab
