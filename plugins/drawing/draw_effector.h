#pragma once
/// \file
/// The effector with which agents draw.

#include "api/agents.h"
#include "draw_packet.h"
#include "drawing_server.h"
#include "shape_reader.h"

namespace spark {

/// `(draw (set Red.3.plan) (line (from 0 0 0) (to 1 2 0)) (text (at 1 2 0.5) (say "there")))`: replaces the shapes of a
/// set, in the world frame. Without a drawing server it does nothing but say so.
class DrawEffector : public Effector {
  SPARK_CLASS(DrawEffector, Effector)
 public:
  static void describe(Description<DrawEffector>& d) {
    d.doc(
        "Draws for viewers: (draw (set name) shapes ...) replaces the shapes of that set; without shapes it removes "
        "the set.");
    d.link(&DrawEffector::server_, At<DrawingServer>());
    d.property("defaultSet", &DrawEffector::defaultSet_)
        .doc("Name of the set if the action names none; empty: agent and its number.");
  }
  std::string predicate() const override { return "draw"; }

  std::string act(const Element& action) override {
    DrawingServer* const server = server_.get();
    if (!server) return "expected a DrawingServer, found none: nothing is drawn";
    std::vector<Drawing> shapes;
    for (const Element e : action) {
      if (e.index() == (*action.begin()).index()) continue;
      if (!e.isList()) return fmt::format("expected (set name) or a shape, found '{}'", e.text());
      if (e.head() == "set") {
        if (!e.at(1) || e.at(1).text().empty()) return "expected (set name), found a set without a name";
        continue;
      }
      if (shapes.size() == drawing::DrawBoard::kMaxShapes)
        return fmt::format("expected at most {} shapes, found more", shapes.size());
      if (std::string wrong = drawing::readShape(e, shapes.emplace_back()); !wrong.empty()) return wrong;
    }
    server->show(setOf(action), std::move(shapes));
    return {};
  }

 private:
  std::string setOf(const Element& action) const {
    if (const Element set = action.named("set"))
      return drawing::cleanText(set.at(1).text(), drawing::PacketReader::kMaxNameBytes);
    if (!defaultSet_.empty()) return defaultSet_;
    AgentAspect* aspect = agent();
    return fmt::format("agent{}", aspect ? aspect->outermost().number() : 0);
  }

  std::string defaultSet_;
  Link<DrawingServer> server_;
};

}  // namespace spark
