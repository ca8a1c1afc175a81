// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <random>

#include "ergotic/scene/text/read_scene.hpp"
#include "scene/bad_text.hpp"
#include "support/test.hpp"

namespace ergotic::scene {
namespace {

#define TABLE_HEAD                  \
  "ergotic: 1\nsections: {a: {}}\n" \
  "mats: {m: {type: mass, mass: 1}, n: {type: mass, mass: 1}}\n"
#define BOW TABLE_HEAD "lias: {x: {type: bow, between: [m, n], table: "

std::string exactly(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a", value);
  return text;
}

std::string pointsText(const Table& table) {
  std::string text = table.smooth ? "smooth" : "straight";
  for (const auto& [x, y] : table.points) {
    text += " " + exactly(x) + "," + exactly(y);
  }
  return text;
}

/// A folder with tables, `t.csv` as given.
class YamlTablesTest : public testing::Test {
 protected:
  YamlTablesTest() { std::filesystem::create_directories(folder_); }
  ~YamlTablesTest() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + name, std::ios::binary) << text;
  }
  Table tableOf(const std::string& csv) const {
    write("t.csv", csv);
    return readYaml(BOW "{file: t.csv}}}\n", folder_ + "scene.yaml").lias[0].law->table;
  }
  void expectCsvRefused(const std::string& csv, const std::string& message) const {
    write("t.csv", csv);
    EXPECT_THAT(
        complaintOf<TextError>([&] { readYaml(BOW "{file: t.csv}}}\n", folder_ + "scene.yaml"); }),
        StartsWith(folder_ + "t.csv:" + message))
        << csv;
  }

  std::string folder_ = testing::TempDir() + "ergotic_tables_" + std::to_string(::getpid()) + "/";
};

TEST_F(YamlTablesTest, InlinePointsAreStraightUnlessToldOtherwise) {
  const auto read = [](const std::string& table) {
    return readYaml(BOW + table + "}}\n", "a.yaml").lias[0].law->table;
  };
  const Table plain = read("[[0, 1], [2, 3]]");
  EXPECT_FALSE(plain.smooth);
  EXPECT_EQ(pointsText(read("{points: [[0, 1], [2, 3]]}")), pointsText(plain));
  EXPECT_EQ(pointsText(read("{points: [[0, 1], [2, 3]], interpolation: linear}")),
            pointsText(plain));
  const Table smooth = read("{points: [[0, 1], [2, 3]], interpolation: monotone}");
  EXPECT_TRUE(smooth.smooth);
  EXPECT_EQ(smooth.points, plain.points);
}

TEST_F(YamlTablesTest, ColumnsOfAFileAreSplitAtCommaOrBlanks) {
  const Table table = tableOf(
      "\xEF\xBB\xBF# v, force\r\n"
      "-1,-2\r\n"
      "\n"
      "  0 , 0.5   # the middle\n"
      "1e-1\t+3\n"
      "7 8 ");
  EXPECT_EQ(table.points, (std::vector<std::pair<double, double>>{
                              {-1.0, -2.0}, {0.0, 0.5}, {0.1, 3.0}, {7.0, 8.0}}));
  EXPECT_FALSE(table.smooth);
}

TEST_F(YamlTablesTest, TextStaysAsItWasWhereNoFileIsRead) {
  const std::string text = BOW "[[0, 1], [2, 3]]}}\n";
  EXPECT_EQ(readYaml(text, folder_ + "scene.yaml").text, text);
}

TEST_F(YamlTablesTest, TablesOfFilesAreAppendedToTheText) {
  write("t.csv", "-0.1 1\n2 3e10\n");
  const std::string text = BOW "{file: t.csv}}}";
  EXPECT_EQ(readYaml(text, folder_ + "scene.yaml").text,
            text + "\n---\ntables: {\"t.csv\": [[-0.1, 1], [2, 3e+10]]}\n");
}

TEST_F(YamlTablesTest, KeptTextGivesTheSameSceneInAnyFolder) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> step(1e-9, 1.0);
  std::string csv;
  double x = -5.0;
  for (int i = 0; i < 500; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%.17g, %.17g\n", x, std::ldexp(step(random), (i - 250) / 3));
    csv += line;
    x += step(random);
  }
  write("t.csv", csv);
  write("odd \"na\\me.csv", "0 -0.0\n1 4.9e-324\n2 1e30\n");
  const std::string text = TABLE_HEAD
      "lias:\n"
      "  x: {type: bow, between: [m, n], table: {file: t.csv, interpolation: monotone}}\n"
      "  y: {type: table, between: [m, n], elastic: {file: t.csv},\n"
      "      viscous: {file: 'odd \"na\\me.csv'}, rest_length: 1}\n"
      "  z: {type: pluck, between: [m, n], table: {points: [[0, 0], [1, 1]]}}\n";
  const Scene first = readYaml(text, folder_ + "scene.yaml");
  ASSERT_EQ(first.lias.size(), 3U);
  ASSERT_EQ(first.lias[0].law->table.points.size(), 500U);
  std::remove((folder_ + "t.csv").c_str());

  const Scene again = readYaml(first.text, "/nonexistent/elsewhere.yaml");
  EXPECT_EQ(again.text, first.text);
  ASSERT_EQ(again.lias.size(), first.lias.size());
  for (std::size_t i = 0; i < first.lias.size(); ++i) {
    const Lia& a = first.lias[i];
    const Lia& b = again.lias[i];
    EXPECT_EQ(pointsText(b.law->table), pointsText(a.law->table));
    EXPECT_EQ(pointsText(b.law->viscous_table), pointsText(a.law->viscous_table));
    EXPECT_EQ(b.name, a.name);
    EXPECT_EQ(b.type, a.type);
    EXPECT_EQ(b.a, a.a);
    EXPECT_EQ(b.b, a.b);
    EXPECT_EQ(b.rest_length, a.rest_length);
    EXPECT_EQ(b.scheme, a.scheme);
    EXPECT_EQ(b.place.line, a.place.line);
    EXPECT_EQ(b.place.column, a.place.column);
  }
  EXPECT_EQ(again.mats.size(), first.mats.size());
}

TEST_F(YamlTablesTest, KeptTextWinsOverTheFile) {
  write("t.csv", "0 1\n1 2\n");
  const Scene first = readYaml(BOW "{file: t.csv}}}\n", folder_ + "scene.yaml");
  write("t.csv", "0 5\n1 6\n");
  EXPECT_EQ(readYaml(first.text, folder_ + "scene.yaml").lias[0].law->table.points[0].second, 1.0);
}

TEST_F(YamlTablesTest, PathsBeginAtTheFolderOfTheScene) {
  std::filesystem::create_directories(folder_ + "sub");
  write("sub/t.csv", "0 1\n1 2\n");
  EXPECT_EQ(
      readYaml(BOW "{file: sub/t.csv}}}\n", folder_ + "a.yaml").lias[0].law->table.points.size(),
      2U);
  EXPECT_EQ(readYaml(BOW "{file: ../sub/t.csv}}}\n", folder_ + "sub/a.yaml")
                .lias[0]
                .law->table.points.size(),
            2U);
}

TEST_F(YamlTablesTest, FilesMayHaveAHeaderAndEmptyFieldsAtTheEnd) {
  const Table table = tableOf("\xEF\xBB\xBF\"compression m\",force_N,,\r\n0,+1,,\r\n1e0,2,,\r\n");
  EXPECT_EQ(table.points, (std::vector<std::pair<double, double>>{{0.0, 1.0}, {1.0, 2.0}}));
}

TEST_F(YamlTablesTest, ErrorsInAFileAreToldWithItsPlace) {
  expectCsvRefused("# nothing\n", "1:1: error: the table has 0 points, allowed: 2...4096");
  expectCsvRefused("", "1:1: error: the table has 0 points, allowed: 2...4096");
  expectCsvRefused("0 1\n# end\n", "2:1: error: the table has 1 points, allowed: 2...4096");
  expectCsvRefused("nan, 0\n0, 1\n",
                   "1:1: error: first number of a point = 'nan' is not a finite number");
  expectCsvRefused("0, 1\nx, y\n",
                   "2:1: error: first number of a point = 'x' is not a finite number");
  expectCsvRefused("0 1\n 1 nan\n",
                   "2:4: error: force of a point = 'nan' is not a finite number, allowed: any "
                   "finite number of N");
  expectCsvRefused("0 1\n1\n", "2:2: error: force of a point is missing");
  expectCsvRefused("0 1\n1, # 2\n", "2:4: error: force of a point is missing");
  expectCsvRefused("0 1\n,1 2\n", "2:1: error: first number of a point is missing");
  expectCsvRefused("0 1\n1 2 3\n",
                   "2:5: error: more than 2 fields in a line, allowed: two numbers");
  expectCsvRefused("0 1\n0 2\n",
                   "2:1: error: first number of a point = 0 is out of range, allowed: > 0");
  expectCsvRefused(std::string("0 1\n1 2\0", 8), "2:4: error: control character 0x00");
  expectCsvRefused("0 1\n1 \xE9 # 2\n", "2:3: error: byte 0xE9 is not UTF-8");
  expectCsvRefused("0;1\n1;2\n", "1:2: error: a semicolon separates the fields");
  expectCsvRefused("0\t0,5\n", "1:4: error: a comma between digits, where blanks separate");
  std::string many;
  for (int i = 0; i <= 4096; ++i) {
    many += std::to_string(i) + " 0\n";
  }
  expectCsvRefused(many, "4097:1: error: too many points, allowed: 2...4096");
}

TEST_F(YamlTablesTest, UnreadableFilesAreToldAtTheirPlaceInTheScene) {
  const std::string name = folder_ + "scene.yaml";
  expectRefused({BOW "{file: <!>none.csv}}}\n", "none.csv: cannot be read: No such file"}, name);
  expectRefused({BOW "{file: <!>.}}}\n", "cannot be read: Is a directory"}, name);
}

TEST_F(YamlTablesTest, FilesElsewhereAreNotOpened) {
  const std::string name = folder_ + "scene.yaml";
  const char elsewhere[] = "is elsewhere, allowed: below the scene's folder";
  expectRefused({BOW "{file: <!>../../../etc/passwd}}}\n", elsewhere}, name);
  ASSERT_EQ(::symlink("/etc/passwd", (folder_ + "link.csv").c_str()), 0);
  expectRefused({BOW "{file: <!>link.csv}}}\n", elsewhere}, name);
}

TEST_F(YamlTablesTest, OfATextThatIsNoFileAreNotLookedForWhereTheProcessIs) {
  write("t.csv", "0 0\n1 1\n");
  write("lib.yaml", "let: {x: 1}\n");
  const auto here = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  const std::string bow = std::string(BOW "{file: t.csv}}}\n");
  const std::string head = "ergotic: 1\nsections: {a: {rate: audio}}\n";
  for (const std::string& text :
       {bow, head + "include: [lib.yaml]\n",
        std::string(TABLE_HEAD "outputs: {o: {at: m, quantity: velocity, pan: 0, "
                               "speakers: {file: t.csv}}}\n")}) {
    const Choice alone = {"", false};
    EXPECT_THAT(complaintOf([&] { readYaml(text, "inline.yaml", {}, alone); }),
                HasSubstr("is nowhere, for this text is no file and has no folder"))
        << text;
  }
  EXPECT_NO_THROW(readYaml(bow, "scene.yaml"));
  const std::string kept = readYaml(bow, "scene.yaml").text;
  EXPECT_NO_THROW(readYaml(kept, "inline.yaml", {}, {"", false})) << "it has all that it needs";
  std::filesystem::current_path(here);
}

TEST_F(YamlTablesTest, TextAndTablesTogetherAreNoLongerThanATextMayBe) {
  write("t.csv", "0 0\n1 1\n");
  std::string text = BOW "{file: t.csv}}}\n";
  text += std::string((std::size_t{64} << 20U) - 10 - text.size(), '#');
  EXPECT_THAT(complaintOf<TextError>([&] { readYaml(text, folder_ + "scene.yaml"); }),
              testing::EndsWith("the text has 67108854 bytes and its tables 41, "
                                "allowed: at most 67108864 in all"));
}

}  // namespace
}  // namespace ergotic::scene
