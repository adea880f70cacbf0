#pragma once
/// \file
/// Reads a recorded full monitor message into a frame, so that an encoder can write it again.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fake_scene.h"

namespace spark::test {

/// A frame and the update that one client gets from it, made from the text of a recorded message. A diff must follow
/// the full message that has the same nodes.
class RecordedFrame {
 public:
  RecordedFrame() : update{frame, false, {}, {}, {}} {}
  void read(const std::string& message) {
    Predicates p;
    if (const ReadResult r = readSexp(message, p); !r.message.empty()) throw std::runtime_error(r.message);
    std::vector<Element> parts;
    for (const Element e : p) parts.push_back(e);
    if (parts.size() != 3) throw std::runtime_error("expected three parts");
    update.full = parts[1].head() == "RSG";
    readEnvironment(parts[0]);
    if (update.full) frame.nodes.clear(), visuals_.clear();
    next_ = 0;
    readNodes(parts[2], 0);
    update.changed = changed_;
  }
  MonitorFrame frame;
  MonitorUpdate update;

 private:
  static bool isNumber(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789+-.e") == std::string_view::npos;
  }
  void readEnvironment(const Element& env) {
    frame.env = {};
    update.env.clear();
    update.events.clear();
    for (const Element e : env) {
      const bool event = e.head() == "foul";
      Predicates& out = event ? update.events : frame.env.predicates;
      if (!event) update.env.push_back(out.size());
      out.open();
      for (const Element atom : e) isNumber(atom.text()) ? out.add(atom.number()) : out.add(atom.text());
      out.close();
    }
  }
  static std::vector<float> numbersOf(const Element& list) {
    std::vector<float> out;
    bool first = true;
    for (const Element e : list) {
      if (!first) out.push_back(static_cast<float>(e.number()));
      first = false;
    }
    return out;
  }
  void readNodes(const Element& list, int depth) {
    for (const Element e : list)
      if (e.head() == "nd") {
        readNode(e, depth);
        readNodes(e, depth + 1);
      }
  }
  void readNode(const Element& e, int depth) {
    const std::size_t i = next_++;
    if (update.full) {
      frame.nodes.emplace_back();
      visuals_.push_back(std::make_unique<FakeVisual>());
      setKind(i, e.at(1).text());
    }
    changed_.resize(frame.nodes.size());
    changed_[i] = 0;
    FrameNode& node = frame.nodes.at(i);
    FakeVisual& visual = *visuals_[i];
    node.depth = depth;
    for (const Element item : e) {
      const std::string_view name = item.head();
      const std::vector<float> n = item.isList() ? numbersOf(item) : std::vector<float>();
      if (name == "SLT") changed_[i] = 1, std::copy(n.begin(), n.end(), node.local.data());
      if (name == "setVisible") changed_[i] = 1, node.visible = n.at(0) == 1;
      if (name == "setTransparent") node.transparent = true;
      if (name == "sSc") visual.size = {n.at(0), n.at(1), n.at(2)};
      if (name == "setDiffuse") visual.colors[0] = {n.at(0), n.at(1), n.at(2), n.at(3)};
      if (name == "setAmbient") visual.colors[1] = {n.at(0), n.at(1), n.at(2), n.at(3)};
      if (name == "setSpecular") visual.colors[2] = {n.at(0), n.at(1), n.at(2), n.at(3)};
      if (name == "load") visual.loads = textOf(item);
      if (name == "sMat") visual.names = {textOf(item)};
      if (name == "resetMaterials")
        for (std::size_t k = 1; k < item.size(); ++k) visual.names.emplace_back(item.at(k).text());
    }
  }
  void setKind(std::size_t i, std::string_view type) {
    using Kind = FrameNode::Kind;
    const bool light = type == "Light", mesh = type == "StaticMesh", single = type == "SMN";
    if (!light && !mesh && !single && type != "TRF") throw std::runtime_error("unknown node type " + std::string(type));
    frame.nodes[i].kind = light ? Kind::light : mesh ? Kind::mesh : single ? Kind::singleMaterial : Kind::transform;
    frame.nodes[i].visual = type == "TRF" ? nullptr : visuals_[i].get();
  }
  static std::string textOf(const Element& item) {
    std::string out;
    for (std::size_t k = 1; k < item.size(); ++k) out.append(k > 1 ? " " : "").append(item.at(k).text());
    return out;
  }
  std::vector<std::unique_ptr<FakeVisual>> visuals_;
  std::vector<std::uint8_t> changed_;
  std::size_t next_ = 0;
};

/// A small frame made by hand: a light, a transform with a mesh, a hidden box, and an environment.
inline void fillFrame(RecordedFrame& f) {
  f.read(
      "((FieldLength 30)(time 0.42)(play_modes A B)(half 1))(RSG 0 1)"
      "((nd Light (setDiffuse 1 1 1 1) (setAmbient 0.8 0.8 0.8 1) (setSpecular 0.1 0.1 0.1 1))"
      "(nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.0403208 1)(nd StaticMesh (setVisible 1) (setTransparent) (load "
      "StdCapsule 0.015 0.08) (sSc 0.042 1 "
      "1)(resetMaterials matLeft naowhite))(nd TRF (SLT 1 -8.74228e-08 0 0 0 1 0 0 0 0 1 0 0 0 0 1)))"
      "(nd SMN (setVisible 0) (load StdUnitBox) (sSc 1 51 1) (sMat matGrey)))");
}

}  // namespace spark::test
