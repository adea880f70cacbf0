#include "../expression.h"

#include <catch2/catch.hpp>

#include "spark/error.h"

using namespace spark;
using rsg::evaluate;
using rsg::resultText;

namespace {

Value lookup(std::string_view group, std::string_view member) {
  if (group == "Soccer" && member == "FieldLength") return 30.0;
  if (group == "Soccer" && member == "Players") return 11;
  if (group == "Nao" && member == "UseTexture") return "true";
  if (group == "NaoType" && member.empty())
    return List{List{List{"UseToe", "false"}, List{"X", 0.055}}, List{List{"UseToe", "true"}, List{"X", 0.07295414}}};
  throw Error("no variable");
}

std::string text(std::string_view expression, bool integerDivision = false) {
  return resultText(evaluate(expression, lookup, integerDivision), true);
}

}  // namespace

TEST_CASE("expressions follow the usual precedence, with signs anywhere") {
  CHECK(text("1 + 2 * 3") == "7");
  CHECK(text("1.5 + 2 * 3 ") == "7.5");
  CHECK(text("10 - 2 - 3 - 0.05") == "4.95");
  CHECK(text("-1 * 0.5 + 0.0125") == "-0.4875");
  CHECK(text("-1*0.5") == "-0.5");
  CHECK(text("9 / - 2.0") == "-4.5");
  CHECK(text("- - 3") == "3");
  CHECK(text("+4") == "4");
  CHECK(text("(1 + 2) * (3 + 4)") == "21");
  CHECK(text("1e-05 * 2") == "2e-05");
  CHECK(text(".5 + 5.") == "5.5");
}

TEST_CASE("results that are not integers have single precision and six significant digits") {
  CHECK(text("3.14159265 * (351.77/180.0)") == "6.13954");
  CHECK(text("3.14159265 * " + text("351.77/180.0")) == "6.13955");
  CHECK(text("0.1 + 0.2") == "0.3");
  CHECK(text("1.0 / 3") == "0.333333");
  CHECK(text("Soccer.FieldLength") == "30");
  CHECK(text("1234567.0 * 1") == "1.23457e+06");
  CHECK(text("1234567 * 1") == "1234567");
  CHECK(resultText(1234567.5, false) == "1234567.5");
  CHECK(resultText(0.1 + 0.2, false) == "0.30000000000000004");
}

TEST_CASE("the quotient of two integers is real, or rounded down with integerDivision") {
  CHECK(text("30 / 4") == "7.5");
  CHECK(text("30 / 4", true) == "7");
  CHECK(text("-30 / 4", true) == "-8");
  CHECK(text("30 / 4.0", true) == "7.5");
  CHECK(text("-9223372036854775807 / -1", true) == "9.22337e+18");
  CHECK(text("9223372036854775807 + 1") == "9.22337e+18");
}

TEST_CASE("variables are read by group and name, lists by index from 0, and tables by key") {
  CHECK(text("Soccer.FieldLength / 2") == "15");
  CHECK(text("Soccer.Players * 2") == "22");
  CHECK(text("Nao.UseTexture ") == "true");
  CHECK(text("NaoType[ 0 ]['UseToe'] ") == "false");
  CHECK(text("NaoType[ 1 ]['UseToe'] ") == "true");
  CHECK(text("NaoType[1][\"X\"]") == "0.0729541");
}

TEST_CASE("malformed expressions are errors") {
  for (const char* wrong : {"",
                            " ",
                            "1 +",
                            "* 2",
                            "(1",
                            "1 2",
                            "1)",
                            "3m",
                            "1..2",
                            "Soccer.",
                            "a.b",
                            "NaoType[2]['X']",
                            "NaoType[0]['Y']",
                            "NaoType[0.5]",
                            "NaoType[-1]",
                            "NaoType[0]",
                            "Nao.UseTexture + 1",
                            "- Nao.UseTexture",
                            "'open",
                            "1 / 0",
                            "1.0 / 0",
                            "1e300 * 1e300",
                            "1e999",
                            "os.exit",
                            "system('x')",
                            "$x",
                            "1;2"}) {
    INFO(wrong);
    CHECK_THROWS_AS(text(wrong), Error);
  }
  CHECK_THROWS_AS(text("1e39"), Error);
  CHECK_THROWS_AS(text(std::string(10000, '(')), Error);
  CHECK_THROWS_AS(text(std::string(10000, '-')), Error);
}
