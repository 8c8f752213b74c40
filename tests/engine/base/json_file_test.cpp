// JSON that is read field by field.
#include "base/json_file.h"

#include <gmock/gmock.h>

#include <ctime>
#include <fstream>

#include "support/error_of.h"
#include "support/temp_folder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

template <typename Work>
std::string fault_of(const Work& work) {
  return error_of([&] { work(); });
}

TEST(JsonFields, AnUnknownFieldIsRefusedWithTheNearestKnownOne) {
  const auto fault = [](const json& object) {
    return fault_of([&] { JsonFields(object, "file.json: ").check_fields({"size", "tile"}); });
  };
  EXPECT_EQ(fault({{"size", 1}, {"tile", nullptr}}), "no error");
  EXPECT_EQ(fault({{"tile", 1}, {"sise", 1}}),
            "file.json: sise: unknown field; did you mean size?; fields are size, tile");
  EXPECT_EQ(fault({{"colour", 1}}), "file.json: colour: unknown field; fields are size, tile");
  EXPECT_EQ(fault({{"", 1}}), "file.json: : unknown field; fields are size, tile");
}

TEST(JsonFields, AValueThatIsNoObjectIsNamedByItsPlace) {
  for (const char* place : {"file.json: ", "lights[3]."})
    EXPECT_THAT(
        fault_of([&] { JsonFields(json(3), place); }),
        std::string(place == std::string("lights[3].") ? "lights[3]" : "file.json") + ": 3 is not an object");
}

TEST(JsonFile, AFileThatIsNoObjectIsRefused) {
  const TempFolder folder;
  const std::string path = (folder.path / "a.json").string();
  const auto fault = [&](const std::string& text) {
    std::ofstream(path) << text;
    return fault_of([&] { const JsonFile file(path); });
  };
  EXPECT_EQ(fault("{}"), "no error");
  EXPECT_EQ(fault("[]"), path + ": is array, not an object");
  EXPECT_THAT(fault("{"), HasSubstr(path + ": is not JSON: parse error at line 1"));
  EXPECT_EQ(fault("{\"a\": " + std::string(16, '[') + std::string(16, ']') + "}"),
            path + ": is nested deeper than 16");
}

TEST(ParsedJson, BracketsInTextsAreNoNesting) {
  EXPECT_EQ(parsed_json(R"({"a": "[[[[", "b\"[[[": "\\"})", 1).size(), 2u);
  EXPECT_EQ(parsed_json("[[]]", 2).size(), 1u);
  EXPECT_EQ(fault_of([] { parsed_json("[[[]]]", 2, "line 3 "); }), "line 3 is nested deeper than 2");
}

double seconds_of_parse(int elements) {
  std::string text = "[";
  for (int i = 0; i < elements; ++i) text += i ? ",[1]" : "[1]";
  text += "]";
  const std::clock_t start = std::clock();
  EXPECT_EQ(parsed_json(text, 8).size(), size_t(elements));
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

// A scan of the array after each of its elements would take sixteen times the processor time.
TEST(ParsedJson, TakesTimeLinearInItsElements) {
  constexpr int few = 50'000;
  seconds_of_parse(few);
  EXPECT_LT(seconds_of_parse(4 * few), 8 * std::max(seconds_of_parse(few), 0.01));
}

}  // namespace
}  // namespace lightgrid
