#include "message.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "spark/predicates.h"

namespace spark::test {

namespace {
const std::vector<std::string> kMarks = {"G1L", "G2L", "G2R", "G1R", "F1L", "F2L", "F1R", "F2R", "B"};
const std::vector<std::string> kParts = {"head", "rlowerarm", "llowerarm", "rfoot", "lfoot"};

bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// Calls `each(begin, end)` for every number with decimals.
template <class F>
void forNumbers(std::string_view text, F each) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!isDigit(text[i]) || (i > 0 && text[i - 1] != ' ' && text[i - 1] != '-')) continue;
    const std::size_t begin = i > 0 && text[i - 1] == '-' ? i - 1 : i;
    while (i < text.size() && isDigit(text[i])) ++i;
    if (i >= text.size() || text[i] != '.') continue;
    ++i;
    while (i < text.size() && isDigit(text[i])) ++i;
    if (i == text.size() || text[i] == ' ' || text[i] == ')') each(begin, i);
  }
}

std::size_t rank(const std::vector<std::string>& names, std::string_view name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::string written(const Element& e) {
  if (!e.isList()) return std::string(e.text());
  std::string out = "(";
  for (const Element inner : e) out += (out.size() > 1 ? " " : "") + written(inner);
  return out + ")";
}

Seen point(const Element& pol) { return {pol.at(1).number(), pol.at(2).number(), pol.at(3).number()}; }

bool isPoint(const Element& e, int decimals) {
  if (!e.isList() || e.head() != "pol" || e.size() != 4) return false;
  const std::string number = "#" + std::to_string(decimals);
  return shape(written(e)) == "(pol " + number + " " + number + " " + number + ")";
}

/// A robot: `(P (team A) (id 3) (head (pol ...)) ...)`.
std::string robotFault(const Element& e, int decimals) {
  if (e.size() < 4 || e.at(1).head() != "team" || e.at(1).size() != 2 || e.at(2).head() != "id" || e.at(2).size() != 2)
    return "robot";
  if (e.at(2).at(1).integer() < 1 || e.at(2).at(1).integer() > 11) return "number";
  std::size_t last = 0;
  for (std::size_t i = 3; i < e.size(); ++i) {
    const Element part = e.at(i);
    const std::size_t at = rank(kParts, part.head());
    if (at == kParts.size() || (i > 3 && at <= last)) return "part " + std::string(part.head());
    if (part.size() != 2 || !isPoint(part.at(1), decimals)) return "part's point";
    last = at;
  }
  return {};
}
}  // namespace

std::vector<std::string> topLevel(const std::string& message) {
  std::vector<std::string> out;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < message.size(); ++i) {
    if (depth == 0 && message[i] != '(') return {};
    depth += (message[i] == '(') - (message[i] == ')');
    if (depth > 0) continue;
    out.push_back(message.substr(begin, i + 1 - begin));
    begin = i + 1;
  }
  return depth == 0 ? out : std::vector<std::string>();
}

std::string shape(std::string_view text) {
  std::string out;
  std::size_t done = 0;
  forNumbers(text, [&](std::size_t begin, std::size_t end) {
    out += text.substr(done, begin - done);
    out += "#" + std::to_string(end - text.find('.', begin) - 1);
    done = end;
  });
  return out += text.substr(done);
}

std::vector<double> decimals(std::string_view text) {
  std::vector<double> out;
  forNumbers(text, [&](std::size_t begin, std::size_t end) {
    out.push_back(std::atof(std::string(text.substr(begin, end - begin)).c_str()));
  });
  return out;
}

std::string label(const std::string& expression) {
  Predicates p;
  readSexp(expression, p);
  for (const Element e : p) {
    const Element name = e.named("n");
    return std::string(e.head()) + (name ? " " + std::string(name.at(1).text()) : "");
  }
  return {};
}

std::string withoutAnnouncement(std::string gs) {
  const std::size_t begin = gs.find("(unum "), end = gs.find("(sl ");
  return begin == std::string::npos || end == std::string::npos ? gs : gs.erase(begin, end - begin);
}

std::vector<Item> items(const std::string& see) {
  Predicates p;
  readSexp(see, p);
  std::vector<Item> out;
  for (const Element all : p)
    for (const Element e : all) {
      if (!e.isList()) continue;
      if (e.head() == "L") {
        out.push_back({"L", {point(e.at(1)), point(e.at(2))}});
      } else if (e.head() == "P") {
        const std::string who =
            "P " + std::string(e.at(1).at(1).text()) + " " + std::string(e.at(2).at(1).text()) + " ";
        for (std::size_t i = 3; i < e.size(); ++i)
          out.push_back({who + std::string(e.at(i).head()), {point(e.at(i).at(1))}});
      } else {
        out.push_back({std::string(e.head()), {point(e.at(1))}});
      }
    }
  return out;
}

std::string seeFault(const std::string& see, int decimals) {
  if (see == "(See )") return {};
  Predicates p;
  readSexp(see, p);
  std::string again;
  std::size_t last = 0;
  const std::size_t robots = kMarks.size(), lines = robots + 1;
  for (const Element all : p) {
    again += written(all);
    for (const Element e : all) {
      if (!e.isList()) continue;
      const std::size_t at = e.head() == "P" ? robots : e.head() == "L" ? lines : rank(kMarks, e.head());
      const bool mark = at < robots;
      if (mark && (at < last || e.size() != 2 || !isPoint(e.at(1), decimals))) return "mark " + written(e);
      if (!mark && e.head() != "P" && e.head() != "L") return "unknown item " + written(e);
      if (at < last) return "order of " + written(e);
      if (at == lines && (e.size() != 3 || !isPoint(e.at(1), decimals) || !isPoint(e.at(2), decimals)))
        return "line " + written(e);
      if (at == robots)
        if (const std::string fault = robotFault(e, decimals); !fault.empty()) return fault + " in " + written(e);
      last = mark ? at + 1 : at;  // each mark at most once
    }
  }
  return again == see ? std::string() : "spacing";
}

}  // namespace spark::test
