#pragma once
/// \file
/// A monitor as strict as RoboViz, the most widely used one: it throws where RoboViz throws, and it omits what RoboViz
/// would not draw.

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "spark/predicates.h"

namespace spark::test {

/// Reads messages like RoboViz. Throws std::runtime_error where its receiver would end.
class StrictMonitor {
 public:
  struct Node {
    std::string type;
    std::vector<Node> children;
    std::array<double, 16> matrix{};
    std::string mesh;
    std::vector<std::string> materials;
    std::array<double, 3> scale{};
    bool visible = false;  ///< true only after (setVisible 1)
  };
  std::vector<Node> scene;  ///< top level
  std::map<std::string, std::string> env;
  std::vector<std::string> playModes;
  std::vector<std::array<int, 4>> fouls;
  int fulls = 0, diffs = 0;

  void read(const std::string& message) {
    check(!message.empty(), "an empty message ends the connection");
    Predicates p;
    const ReadResult result = readSexp(message, p);
    check(result.message.empty(), result.message);
    std::vector<Element> parts;
    for (const Element e : p) parts.push_back(e);
    check(parts.size() == 3, "three expressions");
    check(parts[0].isList() && parts[0].size() > 0 && parts[0].at(0).isList(), "the first expression has a child list");
    check(parts[0].at(0).head() != "RSMP", "the old protocol");
    readEnvironment(parts[0]);
    check(parts[1].head() == "RSG" || parts[1].head() == "RDS", "RSG or RDS");
    if (parts[1].head() == "RSG") {
      ++fulls;
      scene.clear();
      for (const Element e : parts[2]) scene.push_back(readNode(e));
    } else {
      ++diffs;
      patchChildren(parts[2], scene, true);
    }
  }

  /// The first mesh whose name has this ending, depth first; nullptr if there is none.
  const Node* mesh(const std::string& ending) const {
    return find(scene, [&](const Node& n) { return isMesh(n) && n.mesh.ends_with(ending); });
  }
  /// The top-level node of a player.
  const Node* player(bool left, int unum) const {
    const Node* found = nullptr;
    for (const Node& top : scene) {
      if (!find({top}, [&](const Node& n) { return wears(n, left, unum); })) continue;
      check(!found, "a player's meshes are below one top-level node");
      found = &top;
    }
    return found;
  }
  /// The sides and numbers of the players below one top-level node.
  static std::set<std::pair<bool, int>> playersBelow(const Node& top) {
    std::set<std::pair<bool, int>> out;
    for (const bool left : {true, false})
      for (int unum = 1; unum <= 11; ++unum)
        if (find({top}, [&](const Node& n) { return wears(n, left, unum); })) out.emplace(left, unum);
    return out;
  }
  template <class F>
  static const Node* find(const std::vector<Node>& nodes, const F& wanted) {
    for (const Node& n : nodes) {
      if (wanted(n)) return &n;
      if (const Node* inner = find(n.children, wanted)) return inner;
    }
    return nullptr;
  }
  static bool isMesh(const Node& n) { return n.type == "StaticMesh" || n.type == "SMN"; }

 private:
  static void check(bool holds, const std::string& what) {
    if (!holds) throw std::runtime_error("expected: " + what);
  }
  static int javaInt(std::string_view text) {
    check(!text.empty() && text.size() < 10 &&
              text.find_first_not_of("0123456789", text[0] == '-') == std::string_view::npos,
          "a whole number, found " + std::string(text));
    return std::stoi(std::string(text));
  }
  static double javaFloat(std::string_view text) {
    static const std::regex number("[-+]?[0-9]*\\.?[0-9]+([eE][-+]?[0-9]+)?");
    check(std::regex_match(text.begin(), text.end(), number), "a number, found " + std::string(text));
    return std::stod(std::string(text));
  }
  void readEnvironment(const Element& list) {
    static const std::set<std::string> whole{"half", "score_left", "score_right", "play_mode"},
        words{"team_left", "team_right"};
    for (const Element e : list) {
      const std::string name(e.head());
      check(e.isList() && e.size() >= 2, "an entry with a value");
      if (name == "play_modes") {
        playModes.clear();
        for (std::size_t i = 1; i < e.size(); ++i) playModes.emplace_back(e.at(i).text());
      } else if (name == "foul") {
        check(e.size() == 5, "a foul with four arguments");
        fouls.push_back(
            {javaInt(e.at(1).text()), javaInt(e.at(2).text()), javaInt(e.at(3).text()), javaInt(e.at(4).text())});
        check(fouls.back()[1] >= 0 && fouls.back()[1] <= 10, "a type of foul that is known");
      } else if (whole.count(name)) {
        const int value = javaInt(e.at(1).text());
        if (name == "play_mode")
          check(value >= 0 && value < static_cast<int>(playModes.size()), "a play mode of the list");
      } else if (!words.count(name)) {
        javaFloat(e.at(1).text());
      }
      env[name] = e.at(1).text();
    }
  }
  static bool isNode(const Element& e) { return e.isList() && e.head() == "nd"; }
  Node readNode(const Element& e) {
    static const std::set<std::string> types{"TRF", "Light", "StaticMesh", "SMN"};
    check(isNode(e) && e.size() >= 2, "a node");
    Node node;
    node.type = e.at(1).text();
    check(types.count(node.type) == 1, "a known type, or diffs shift, found " + node.type);
    if (node.type == "TRF") {
      check(e.at(2) && e.at(2).head() == "SLT", "SLT as the first child of a transform");
      readMatrix(e.at(2), node);
    }
    for (std::size_t i = 2; i < e.size(); ++i)
      if (isNode(e.at(i)))
        node.children.push_back(readNode(e.at(i)));
      else
        operate(e.at(i), node);
    check(!isMesh(node) || !node.mesh.empty(), "a mesh with a name");
    return node;
  }
  static void readMatrix(const Element& e, Node& node) {
    check(e.size() == 17, "16 numbers");
    for (std::size_t i = 0; i < 16; ++i) node.matrix[i] = javaFloat(e.at(i + 1).text());
  }
  static void operate(const Element& e, Node& node) {
    const std::string_view name = e.head();
    if (name == "load") node.mesh = e.at(1).text();
    if (name == "setVisible") node.visible = e.at(1).text() == "1";
    if (name == "sSc")
      for (std::size_t i = 0; i < 3; ++i) node.scale[i] = javaFloat(e.at(i + 1).text());
    if (name == "sMat") node.materials = {std::string(e.at(1).text())};
    if (name != "resetMaterials") return;
    node.materials.clear();
    for (std::size_t i = 1; i < e.size(); ++i) node.materials.emplace_back(e.at(i).text());
  }
  void patchChildren(const Element& list, std::vector<Node>& nodes, bool top = false) {
    std::size_t next = 0;
    for (const Element e : list) {
      check(!top || isNode(e), "nodes");
      if (!isNode(e)) continue;
      check(next < nodes.size(), "the shape of the last full message");
      patch(e, nodes[next++]);
    }
    check(next == nodes.size(), "as many children as in the last full message");
  }
  void patch(const Element& e, Node& node) {
    for (std::size_t i = 1; i < e.size(); ++i) {
      const Element item = e.at(i);
      if (item.head() == "SLT") {
        check(i == 1 && node.type == "TRF", "SLT as the first child of a transform");
        readMatrix(item, node);
      } else if (item.isList() && !isNode(item)) {
        operate(item, node);
      }
    }
    patchChildren(e, node.children);
  }
  static bool wears(const Node& n, bool left, int unum) {
    const auto has = [&n](const std::string& name) {
      return std::find(n.materials.begin(), n.materials.end(), name) != n.materials.end();
    };
    return n.type == "StaticMesh" && has(left ? "matLeft" : "matRight") && has("matNum" + std::to_string(unum));
  }
};

}  // namespace spark::test
