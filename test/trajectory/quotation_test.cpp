#include "demo_logger/trajectory/quotation.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

TEST(QuotationTest, ShortTextIsRepeatedAsItIs) {
  EXPECT_EQ(shortened(""), "");
  EXPECT_EQ(inQuotes("Gerüst_2/tool0"), "\"Gerüst_2/tool0\"");
  EXPECT_EQ(shortened(std::string(80, 'x')), std::string(80, 'x'));
}

TEST(QuotationTest, OfALongTextTheBeginningIsEnough) {
  EXPECT_EQ(shortened(std::string(100000, 'x')), std::string(80, 'x') + "…");
  EXPECT_EQ(inQuotes(std::string(81, 'x')), "\"" + std::string(80, 'x') + "…\"");
}

TEST(QuotationTest, NoCharacterIsCutInTwo) {
  EXPECT_EQ(shortened(std::string(79, 'x') + "ü"), std::string(79, 'x') + "…") << "of its two bytes one would fit";
  EXPECT_EQ(shortened(std::string(78, 'x') + "üü"), std::string(78, 'x') + "ü…");
  EXPECT_EQ(shortened(std::string(100, '\x80')).size(), 77 + std::string("…").size()) << "no UTF-8, and bounded still";
}

TEST(QuotationTest, WhatCannotBePrintedIsAQuestionMark) { EXPECT_EQ(inQuotes("t\n\x1b[31m\x7f"), "\"t??[31m?\""); }

}  // namespace
}  // namespace demo_logger
