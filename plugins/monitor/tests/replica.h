#pragma once
/// \file
/// The scene of a monitor: full messages replace it, diffs patch it.

#include <stdexcept>
#include <string>
#include <vector>

#include "spark/predicates.h"

namespace spark::test {

/// A monitor's copy of the scene and of the environment. Throws std::runtime_error if a message does not match it.
class Replica {
 public:
  struct Node {
    int depth = 0;
    std::string type;
    std::vector<double> matrix;
    bool visible = false;
    std::string rest;  ///< load, scale, materials
  };
  std::vector<Node> nodes;
  std::vector<std::string> events;   ///< every `foul`, as text
  std::vector<std::string> lastEnv;  ///< names of the last message's entries
  double score = -1, time = -1;
  int fulls = 0, diffs = 0;

  void take(const std::string& message) {
    Predicates p;
    const ReadResult result = readSexp(message, p);
    if (!result.message.empty()) throw std::runtime_error("unreadable: " + message);
    std::vector<Element> parts;
    for (const Element e : p) parts.push_back(e);
    if (parts.size() != 3) throw std::runtime_error("expected three parts: " + message);
    takeEnvironment(parts[0]);
    if (parts[1].head() == "RSG") {
      nodes.clear();
      ++fulls;
      for (const Element e : parts[2]) add(e, 0);
    } else {
      ++diffs;
      next_ = 0;
      for (const Element e : parts[2]) patch(e, 0);
      if (next_ != nodes.size()) throw std::runtime_error("the diff has fewer nodes");
    }
  }

 private:
  void takeEnvironment(const Element& env) {
    if (env.size() == 0) throw std::runtime_error("empty environment");
    lastEnv.clear();
    for (const Element e : env) {
      lastEnv.emplace_back(e.head());
      if (e.head() == "score") score = e.at(1).number();
      if (e.head() == "time") time = e.at(1).number();
      if (e.head() == "foul") events.emplace_back(e.at(1).text());
    }
  }
  void readItems(const Element& e, Node& node, bool full) {
    bool first = true;
    for (const Element inner : e) {
      if (first) {
        first = false;
        continue;  // nd
      }
      if (inner.isText()) {
        if (full) node.type = inner.text();
      } else if (inner.head() == "SLT") {
        node.matrix.clear();
        for (std::size_t i = 1; i < inner.size(); ++i) node.matrix.push_back(inner.at(i).number());
      } else if (inner.head() == "setVisible")
        node.visible = inner.at(1).number() == 1;
      else if (inner.head() != "nd")
        node.rest += std::string(inner.head()) + " ";
    }
  }
  void add(const Element& e, int depth) {
    nodes.push_back({depth, "", {}, false, ""});
    readItems(e, nodes.back(), true);
    for (const Element inner : e)
      if (inner.head() == "nd") add(inner, depth + 1);
  }
  void patch(const Element& e, int depth) {
    if (next_ >= nodes.size() || nodes[next_].depth != depth) throw std::runtime_error("the diff has another shape");
    readItems(e, nodes[next_++], false);
    for (const Element inner : e)
      if (inner.head() == "nd") patch(inner, depth + 1);
  }
  std::size_t next_ = 0;
};

}  // namespace spark::test
