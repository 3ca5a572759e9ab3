#include "snowshed/core/message_format.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "snowshed/methods/range.hpp"

namespace snowshed {
namespace {

TEST(MessageFormat, NumbersAreShort) {
  EXPECT_EQ(show(210), "210");
  EXPECT_EQ(show(0.1), "0.1");
  EXPECT_EQ(show(-1e-7), "-1e-07");
  EXPECT_EQ(show(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(show(std::numeric_limits<double>::quiet_NaN()), "NaN");
  EXPECT_EQ(show(-std::numeric_limits<double>::infinity()), "-Infinity");
}

TEST(MessageFormat, PointersAreEscaped) {
  EXPECT_EQ(pointer("", "snow"), "/snow");
  EXPECT_EQ(pointer("/a", "b/c~d"), "/a/b~1c~0d");
  EXPECT_EQ(pointer("", "a\nb\x1b"), "/a?b?");
  EXPECT_EQ(pointer("", std::string(1000, 'x')), "/" + std::string(100, 'x') + "...");
  EXPECT_EQ(pointer("", std::string(99, 'x') + "\xc3\xa9y"),
            "/" + std::string(99, 'x') + "\xc3\xa9...");
}

TEST(MessageFormat, QuotesArePrintableAndShort) {
  EXPECT_EQ(quote("a\"\n"), "\"a\\\"\\n\"");
  EXPECT_EQ(quote("\xff"), "\"\\ufffd\"");
  EXPECT_EQ(quote(std::string(100, 'a')), "\"" + std::string(60, 'a') + "\"...");
}

TEST(MessageFormat, SuggestsOnlySimilarNames) {
  EXPECT_EQ(suggestion("densty", {"cohesion", "density"}), "; did you mean \"density\"?");
  EXPECT_EQ(suggestion("Density", {"cohesion", "density"}), "; did you mean \"density\"?");
  EXPECT_EQ(suggestion("colour", {"cohesion", "density"}), "");
  EXPECT_EQ(suggestion("", {"dx"}), "");
  EXPECT_EQ(suggestion(std::string(1 << 20, 'a'), {"dx"}), "");
}

TEST(Range, ReadsAsAnInequality) {
  EXPECT_EQ(methods::non_negative.below(0.5).text(), "0 <= value < 0.5");
  EXPECT_EQ(methods::positive.up_to(1000).text("kg/m3"), "0 < value <= 1000 kg/m3");
  EXPECT_EQ(methods::anything.text("m"), "any finite number");
  EXPECT_EQ(methods::positive.text(), "0 < value");
}

TEST(Range, ContainsItsClosedEndsOnly) {
  const methods::Range range = methods::non_negative.below(0.5);
  EXPECT_TRUE(range.contains(0.0));
  EXPECT_FALSE(range.contains(0.5));
  EXPECT_FALSE(methods::positive.contains(0.0));
  EXPECT_TRUE(methods::fraction.contains(1.0));
  EXPECT_FALSE(methods::anything.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(methods::anything.contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(MessageFormat, TerminalCommandsAreReplaced) {
  EXPECT_EQ(printable("a\x1b[31mb\xc2\x9b"
                      "c\xe2\x80\xae"
                      "d\xff\n\x7f"),
            "a?[31mb?c?d? ?");
  EXPECT_EQ(printable("Sägen 雪 \xf0\x9f\x98\x80"), "Sägen 雪 \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("cut \xe2\x80"), "cut ??");
}

}  // namespace
}  // namespace snowshed
