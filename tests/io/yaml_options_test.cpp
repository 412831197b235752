// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/options/yaml_options.hpp"

#include <gtest/gtest.h>

#include <array>

#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

enum class Form { kRound, kSquare };
constexpr std::array<std::pair<Form, const char*>, 2> kForms{
    {{Form::kRound, "round"}, {Form::kSquare, "square"}}};

struct Values {
  double radius_m = 2.5;
  int count = 10;
  bool adaptive = false;
  Form form = Form::kRound;
  double depth = 1.0;
  int threads = 0;
};

class YamlOptions : public ::testing::Test {
 protected:
  YamlOptions() { declare(table_, values_); }

  static void declare(OptionTable& table, Values& values) {
    table.number("search.radius_m", values.radius_m, {0.0, 50.0}, "How far to look.", "the paper");
    table.integer("search.count", values.count, {1, 100}, "How many to keep.");
    table.flag("filter.adaptive", values.adaptive, "Whether it adapts.");
    table.choice<Form>("filter.form", values.form, kForms, "Its form.");
    table.number("filter.deep.depth", values.depth, {}, "How deep.");
    table.integer("threads", values.threads, {0, 64}, "Processors to use.");
  }

  OptionOrigins read(const std::string& yaml) {
    test::write_text(folder_ / "run.yaml", yaml);
    return read_yaml_options(folder_ / "run.yaml", table_);
  }
  void refuse(const std::string& yaml, std::initializer_list<std::string> parts) {
    expect_error(ErrorKind::kUsage, parts, [&] { read(yaml); });
  }

  TemporaryFolder folder_;
  Values values_;
  OptionTable table_;
};

TEST_F(YamlOptions, ReadsNestedMapsAndDottedKeys) {
  const OptionOrigins origins = read(
      "# a comment\nsearch:\n  radius_m: 7\n  count: 3\nfilter: {adaptive: on, form: square}\n"
      "filter.deep.depth: -1e3\nthreads: 4\n");
  EXPECT_EQ(values_.radius_m, 7.0);
  EXPECT_EQ(values_.count, 3);
  EXPECT_TRUE(values_.adaptive);
  EXPECT_EQ(values_.form, Form::kSquare);
  EXPECT_EQ(values_.depth, -1000.0);
  EXPECT_EQ(values_.threads, 4);
  EXPECT_EQ(origins.size(), 6U);
  EXPECT_EQ(origins.at("search.count"), (folder_ / "run.yaml").string() + ":4");
}

TEST_F(YamlOptions, AFileOfCommentsSetsNothing) { EXPECT_TRUE(read("# nothing yet\n").empty()); }

TEST_F(YamlOptions, NamesTheLineOfEveryMistake) {
  refuse("search:\n  radius: 7\n",
         {"run.yaml:2", "search.radius", "did you mean 'search.radius_m'?"});
  refuse("search:\n  radius_m: 70\n", {"run.yaml:2", "search.radius_m", "0 .. 50"});
  refuse("search:\n  radius_m: wide\n", {"run.yaml:2", "'wide'"});
  refuse("search.count: 3\nsearch:\n  count: 4\n", {"run.yaml:3", "given twice", "run.yaml:1"});
  refuse("search:\n  count: [1, 2]\n", {"run.yaml:2", "search.count", "not a list"});
  refuse("search:\n  count:\n", {"run.yaml:2", "search.count", "no value"});
  refuse("serch:\n", {"run.yaml:1", "unknown option 'serch'"});
  refuse("- search\n", {"run.yaml:1", "`name: value`"});
  refuse("filter: {form: rond}\n", {"run.yaml:1", "nearest: round"});
  refuse("search: {count: 1\n", {"run.yaml:", "is not YAML"});
  expect_error(ErrorKind::kInput, {"none.yaml", "no such file"},
               [&] { read_yaml_options(folder_ / "none.yaml", table_); });
}

TEST_F(YamlOptions, DumpExplainsEveryValue) {
  const OptionOrigins origins = read("search: {radius_m: 0.1}\n");
  const std::string text = dump_yaml_options(table_, origins);
  const std::string place = (folder_ / "run.yaml").string();
  EXPECT_TRUE(
      text.starts_with("search:\n"
                       "  # How far to look.\n"
                       "  # allowed: 0 .. 50; default: 2.5 (the paper); value from: " +
                       place +
                       ":1\n"
                       "  radius_m: 0.1\n"))
      << text;
  EXPECT_NE(text.find("\nfilter:\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  deep.depth: 1\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nthreads: 0\n"), std::string::npos) << text;
}

TEST_F(YamlOptions, DumpReadsBackAsItWas) {
  read("search: {radius_m: 0.1, count: 99}\nfilter: {adaptive: yes, form: square}\nthreads: 7\n");
  test::write_text(folder_ / "dump.yaml", dump_yaml_options(table_, {}));
  Values values;
  OptionTable table;
  declare(table, values);
  const OptionOrigins origins = read_yaml_options(folder_ / "dump.yaml", table);
  EXPECT_EQ(origins.size(), table.options().size());
  EXPECT_EQ(dump_yaml_options(table, {}), dump_yaml_options(table_, {}));
}

}  // namespace
}  // namespace nadir
