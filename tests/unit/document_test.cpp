// SPDX-License-Identifier: Apache-2.0
// A report's document: what its writers make of texts, numbers and states.
#include "host/report/document.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/base/errors.h"
#include "host/report/markup.h"

namespace turbid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

Table levels() {
  return {.id = "levels",
          .title = "Levels",
          .columns = {{"case"}, {"voxel size", "mm"}, {"iterations"}, {"met"}},
          .rows = {{{std::string("cosine"), 1.0 / 3, std::int64_t{12}, true}, RowState::pass},
                   {{std::string("point, \"bare\""), kNan, {}, false}, RowState::fail},
                   {{std::string("sphere"), -kInfinity, std::int64_t{-7}, {}}}}};
}

Document with(Part part) {
  return {.title = "t", .summary = "", .context = {}, .sections = {{"s", {std::move(part)}}}};
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

class DocumentFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "turbid_document_" + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
  }
  std::string folder_;
};

TEST(NumberText, KeepsTheAskedDigitsAlsoWhenRoundingCarries) {
  EXPECT_EQ(number_text(0.012345, 3), "0.0123");
  EXPECT_EQ(number_text(9.996, 3), "10.0");
  EXPECT_EQ(number_text(0.099996, 3), "0.100");
  EXPECT_EQ(number_text(123456.7, 3), "123457");
  EXPECT_EQ(number_text(999999.9, 3), "1.00e+06");
  EXPECT_EQ(number_text(0.0000999, 2), "0.00010");
  EXPECT_EQ(number_text(0.00001234, 3), "1.23e-05");
  EXPECT_EQ(number_text(0, 3), "0");
  EXPECT_EQ(number_text(-2.5, 1, NumberStyle::fixed), "-2.5");
  EXPECT_EQ(number_text(2, 3, NumberStyle::scientific), "2.00e+00");
  EXPECT_EQ(number_text(kNan, 3), "nan");
  EXPECT_EQ(number_text(-kInfinity, 3), "-inf");
}

TEST(Html, ShowsHostileTextAsText) {
  const std::string hostile = "<script>alert(\"x\")</script>&'\x01\xff</title>";
  Table table{.id = "t", .title = hostile, .caption = hostile, .columns = {{hostile, hostile}}, .rows = {{{hostile}}}};
  Plot plot{.id = "p", .title = hostile, .x = {hostile}, .y = {hostile}};
  plot.series = {{.name = hostile, .x = {1}, .y = {1}, .point_labels = {hostile}}};
  plot.lines = {{true, 1, hostile}};
  BarChart bars{.id = "b", .title = hostile, .value = {hostile}, .groups = {hostile}, .series = {{hostile, {1}}}};
  Timeline timeline{.id = "q", .title = hostile, .unit = hostile, .tracks = {{hostile, {{hostile, 0, 1}}}}};
  Pictures pictures{.id = "pics", .title = hostile, .pictures = {{hostile, hostile, 1, 1, {1, 2, 3}}}};
  const std::string html =
      document_html({hostile,
                     hostile,
                     {{hostile, hostile}},
                     {{hostile, {Paragraph{hostile}, Code{hostile, hostile}, table, plot, bars, timeline, pictures}}}});
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("\"x\""), std::string::npos);
  EXPECT_EQ(html.find('\x01'), std::string::npos);
  EXPECT_EQ(html.find('\xff'), std::string::npos);
  EXPECT_EQ(html.find("</title>"), html.rfind("</title>", html.find("<style>")));  // the page's own is the first
  EXPECT_NE(html.find("&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt;&amp;&#39;\xEF\xBF\xBD\xEF\xBF\xBD"),
            std::string::npos);
}

TEST(Html, ReplacesWhatIsNoUtf8AndKeepsWhatIs) {
  EXPECT_EQ(escaped("\xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80"), "\xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80");
  EXPECT_EQ(escaped("\xC0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD");          // an overlong NUL
  EXPECT_EQ(escaped("\xED\xA0\x80").find('\xED'), std::string::npos);  // a surrogate
  EXPECT_EQ(escaped("a\xE2\x82"), "a\xEF\xBF\xBD\xEF\xBF\xBD");        // cut short
}

TEST(Html, SaysTheVerdictAtTheTopAndNamesWhatFailed) {
  const std::string html = document_html(with(levels()));
  EXPECT_NE(html.find("1 of 2 checks failed"), std::string::npos);
  EXPECT_NE(html.find("<a href=\"#levels\">point, &quot;bare&quot; (Levels)</a>"), std::string::npos);
  Table plain = levels();
  for (Row& row : plain.rows) row.state = RowState::plain;
  EXPECT_EQ(document_html(with(plain)).find("checks"), std::string::npos);
}

TEST(Html, NeedsNothingFromTheNetwork) {
  Pictures pictures{.id = "p", .pictures = {{"", "", 1, 1, {'M', 'a', 'n', 'y'}}}};
  const std::string html = document_html(with(pictures));
  EXPECT_NE(html.find("src=\"data:image/png;base64,TWFueQ==\""), std::string::npos);
  for (const char* const outside : {"http:", "https:", "url(", "@import", "<link"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
}

TEST(Json, HoldsTheTablesNumbersInFullPrecision) {
  const auto json = nlohmann::json::parse(document_json(with(levels())));
  const auto& table = json["sections"][0]["parts"][0];
  const auto& rows = table["rows"];
  EXPECT_EQ(rows[0][1].get<double>(), 1.0 / 3);
  EXPECT_TRUE(rows[0][2].is_number_integer());
  EXPECT_EQ(rows[0][2], 12);
  EXPECT_EQ(rows[0][3], true);
  EXPECT_EQ(rows[1][1], "nan");
  EXPECT_EQ(rows[2][1], "-inf");
  EXPECT_TRUE(rows[1][2].is_null());
  EXPECT_EQ(table["columns"][1]["unit"], "mm");
  EXPECT_EQ(table["states"], (nlohmann::json{"pass", "fail", ""}));
  EXPECT_EQ(json["checks"]["failed"], 1);
}

TEST(Csv, QuotesWhatRfc4180AsksForAndKeepsUnitsInTheHeader) {
  EXPECT_EQ(table_csv(levels()),
            "case,voxel size [mm],iterations,met,state\r\n"
            "cosine,0.3333333333333333,12,true,pass\r\n"
            "\"point, \"\"bare\"\"\",nan,,false,fail\r\n"
            "sphere,-inf,-7,,\r\n");
  const Table two_lines{.id = "t", .columns = {{"a\nb"}}, .rows = {{{std::string("c\r\nd")}}}};
  EXPECT_EQ(table_csv(two_lines), "\"a\nb\"\r\n\"c\r\nd\"\r\n");
}

TEST(Text, AlignsColumnsByCharactersNotBytes) {
  const Table table{.id = "t",
                    .columns = {{"name"}, {"value"}},
                    .rows = {{{std::string("\xCE\xB7\xC2\xB2"), 1.5}}, {{std::string("long name"), 12.25}}}};
  const std::string text = document_text(with(table));
  EXPECT_NE(text.find("name       value\n\xCE\xB7\xC2\xB2          1.50\nlong name   12.2\n"), std::string::npos)
      << text;
}

TEST_F(DocumentFiles, AreAllWrittenFromOneDocument) {
  const NamedTexts written = write_document(with(levels()), folder_ + "/deep/report");
  ASSERT_EQ(written.size(), 3u);
  EXPECT_EQ(contents(folder_ + "/deep/report.html"), document_html(with(levels())));
  EXPECT_EQ(contents(folder_ + "/deep/report.json"), document_json(with(levels())));
  EXPECT_EQ(contents(folder_ + "/deep/report.levels.csv"), table_csv(levels()));
}

TEST_F(DocumentFiles, AreNotWrittenAtAllIfOneOfThemCannotBe) {
  std::filesystem::create_directory(folder_ + "/report.levels.csv");  // the last file's place is taken by a folder
  EXPECT_THROW(write_document(with(levels()), folder_ + "/report"), InputError);
  EXPECT_EQ(files(), 1u);
}

TEST_F(DocumentFiles, RefuseIdsThatClashOrDoNotFitAFileName) {
  Document twice = with(levels());
  twice.sections[0].parts.push_back(levels());
  EXPECT_THROW(write_document(twice, folder_ + "/report"), std::invalid_argument);
  Table astray = levels();
  astray.id = "../levels";
  EXPECT_THROW(write_document(with(astray), folder_ + "/report"), std::invalid_argument);
  astray.id = identifier(astray.id);
  EXPECT_EQ(astray.id, "___levels");
  Table ragged = levels();
  ragged.rows[1].cells.pop_back();
  EXPECT_THROW(write_document(with(ragged), folder_ + "/report"), std::invalid_argument);
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace turbid
