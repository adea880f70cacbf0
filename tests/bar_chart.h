#pragma once
/// \file
/// Horizontal bars as SVG, for the charts of docs/.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace spark::test {

struct Bar {
  std::string label;
  double value = 0;       ///< length of the bar, at least 0
  std::string text;       ///< behind the bar
  bool baseline = false;  ///< grey: what the other bars are compared with
};

/// Bars with one scale.
struct BarGroup {
  std::string title;
  std::vector<Bar> bars;
};

/// `text` with the characters escaped that XML reserves.
inline std::string escapedXml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// An SVG document, 760 units wide: a title, the groups one below the other, and a line of small print. Each group
/// has a scale of its own; its longest bar has the full length.
inline std::string barChart(std::string_view title, const std::vector<BarGroup>& groups, std::string_view smallPrint) {
  constexpr int kWidth = 760, kLabel = 190, kLongest = 400, kBar = 18, kRow = 24;
  std::string body;
  int y = 34;
  const auto text = [&](int x, int base, int size, const char* style, std::string_view what) {
    body +=
        fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" {}>{}</text>\n", x, base, size, style, escapedXml(what));
  };
  text(16, y, 18, "font-weight=\"bold\"", title);
  for (const BarGroup& g : groups) {
    y += 36;
    text(16, y, 14, "font-weight=\"bold\"", g.title);
    y += 8;
    double longest = 0;
    for (const Bar& b : g.bars) longest = std::max(longest, b.value);
    for (const Bar& b : g.bars) {
      const int length = longest > 0 ? std::max(1, static_cast<int>(kLongest * b.value / longest + 0.5)) : 1;
      text(16, y + 14, 13, "", b.label);
      body += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"2\" fill=\"{}\"/>\n", kLabel, y,
                          length, kBar, b.baseline ? "#9aa4b0" : "#2f6fd0");
      text(kLabel + length + 8, y + 14, 13, "", b.text);
      y += kRow;
    }
  }
  y += 22;
  text(16, y, 11, "fill=\"#5a6470\"", smallPrint);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\" fill=\"#1c232b\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"#ffffff\"/>\n{2}</svg>\n",
      kWidth, y + 14, body);
}

}  // namespace spark::test
