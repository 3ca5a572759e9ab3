#include "snowshed/io/xml_text.hpp"

#include <gtest/gtest.h>

namespace snowshed::io {
namespace {

TEST(XmlText, EscapesAndRestores) {
  const std::string text = "a<b> & \"c\" 'd' &amp; é";
  EXPECT_EQ(xml_escape("<&>"), "&lt;&amp;&gt;");
  EXPECT_EQ(xml_unescape(xml_escape(text)), text);
  EXPECT_EQ(xml_unescape("&amp;lt;"), "&lt;");
  EXPECT_EQ(xml_unescape("a & b &"), "a & b &");
}

}  // namespace
}  // namespace snowshed::io
