// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "support/expect_error.hpp"

namespace nadir {
namespace {

TEST(JsonText, BytesThatAreNotUtf8BecomeTheReplacementCharacter) {
  EXPECT_EQ(json_text({{"name", "caf\xe9.jpg"}}), "{\"name\":\"caf\xef\xbf\xbd.jpg\"}");
  EXPECT_EQ(json_text({{"caf\xe9", 1}}), "{\"caf\xef\xbf\xbd\":1}");
}

TEST(JsonText, IsIndentedKeepsTheOrderAndKnowsNoInfinity) {
  const Json document{{"b", 1}, {"a", std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(json_text(document, 2), "{\n  \"b\": 1,\n  \"a\": null\n}");
}

TEST(JsonText, TellsUtf8FromOtherBytes) {
  for (const char* text :
       {"", "plain",
        "stra\xc3\x9f"
        "e",
        "\xe2\x82\xac", "\xf0\x9f\x9b\xb8", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_TRUE(is_utf8(text)) << text;
  }
  // Latin-1, cut off, overlong, half of a UTF-16 pair, beyond Unicode, a byte that begins nothing.
  for (const char* text : {"stra\xdf"
                           "e",
                           "\xe2\x82", "\xc0\xaf", "\xe0\x80\xaf", "\xf0\x80\x80\xaf",
                           "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\x80"}) {
    EXPECT_FALSE(is_utf8(text)) << json_text(text);
  }
}

/// What is written and read again as text.
std::string read_back(const std::string& name) {
  Json object = Json::object();
  set_name(object, "name", name);
  return name_at(Json::parse(json_text(object)), "name");
}

TEST(JsonNames, ComeBackByteByByte) {
  for (const std::string name :
       {"a.jpg", "caf\xe9.jpg", "caf\xe8.jpg", "\xef\xbf\xbd", "a\"\n\\b"}) {
    EXPECT_EQ(read_back(name), name);
  }
  Json plain = Json::object();
  set_name(plain, "name",
           "stra\xc3\x9f"
           "e.jpg");
  EXPECT_EQ(plain.size(), 1U) << "a name that JSON can hold stands alone";
  Json latin = Json::object();
  set_name(latin, "name", "\xe9.jpg");
  EXPECT_EQ(json_text(latin), "{\"name\":\"\xef\xbf\xbd.jpg\",\"name_hex\":\"e92e6a7067\"}");
}

TEST(JsonNames, DamagedBytesAreRefused) {
  for (const char* digits : {"e92", "e9zz", "+9", " 9"}) {
    test::expect_error(ErrorKind::kInput, {"name_hex", "is not hexadecimal"}, [&] {
      name_at({{"name", "x"}, {"name_hex", digits}}, "name");
    });
  }
  EXPECT_THROW(name_at(Json::object(), "name"), Json::exception);
  EXPECT_THROW(name_at({{"name", 3}}, "name"), Json::exception);
}

}  // namespace
}  // namespace nadir
