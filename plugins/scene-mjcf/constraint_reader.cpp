#include "constraint_reader.h"

#include <fmt/format.h>

namespace spark::mjcf {

/// The defaults of all equalities are those of `equality`, of all tendons those of `tendon`.
Attributes ConstraintReader::attributes(const Element& e, const char* tag) {
  return Attributes(e, defaults_, e.node.attribute("class").value(), unsupported_, tag);
}

void ConstraintReader::equality(const Element& e, Model& model) {
  if (e.tag() != "connect" && e.tag() != "weld" && e.tag() != "joint") return unsupported_.element(e);
  Attributes a = attributes(e, "equality");
  Equality x;
  x.from = e;
  x.type = e.tag();
  x.name = a.text("name");
  const bool joints = x.type == "joint";
  x.first = a.text(joints ? "joint1" : "body1");
  x.second = a.text(joints ? "joint2" : "body2");
  if (x.first.empty()) {
    if (a.has("site1") || a.has("site2")) {
      unsupported_.add(e, "an equality between sites is not supported");
      a.ignore({"site1", "site2"});
      return;
    }
    throw e.error(fmt::format("expected an attribute '{}'", joints ? "joint1" : "body1"));
  }
  if (!joints && x.second.empty()) x.second = "world";
  if (x.first == x.second) throw e.error(fmt::format("expected two different elements, found '{}' twice", x.first));
  if (x.type == "connect" && !a.take("anchor", x.anchor)) throw e.error("expected an attribute 'anchor'");
  if (x.type == "weld") {
    a.take("anchor", x.anchor);
    a.take("relpose", x.relativePose);
    x.torqueScale = a.number("torquescale", 1);
  }
  if (joints) a.fill("polycoef", x.polynomial);
  a.fill("solref", x.solref);
  a.fill("solimp", x.solimp);
  x.active = a.flag("active", true);
  a.finish();
  model.equalities.push_back(std::move(x));
}

void ConstraintReader::tendon(const Element& e, const std::vector<Element>& parts, Model& model) {
  if (e.tag() != "fixed" && e.tag() != "spatial") return unsupported_.element(e);
  Attributes a = attributes(e, "tendon");
  Tendon t;
  t.from = e;
  t.name = a.text("name");
  t.spatial = e.tag() == "spatial";
  for (const auto& [name, value] : {std::pair{"stiffness", &t.stiffness}, std::pair{"damping", &t.damping},
                                    std::pair{"frictionloss", &t.frictionLoss}, std::pair{"margin", &t.margin}}) {
    *value = a.number(name, 0);
    if (*value < 0) throw e.error(fmt::format("expected '{}' of 0 or more, found {}", name, *value));
  }
  t.springLength = a.number("springlength", -1);
  Limit limit;
  limit.read(a, "limited", "range");
  if (const auto range = compiler_.limit(e, "range", limit)) t.limited = true, t.range = *range;
  a.fill("solreflimit", t.limitSolref);
  a.fill("solimplimit", t.limitSolimp);
  a.fill("solreffriction", t.frictionSolref);
  a.fill("solimpfriction", t.frictionSolimp);
  a.ignore({"group", "width", "material", "rgba", "user"});
  a.finish();
  for (const Element& part : parts) {
    if (part.tag() != (t.spatial ? "site" : "joint")) {
      unsupported_.add(part, fmt::format("a tendon along <{}> is not supported: it is left out", part.tag()));
      return;
    }
    Attributes own(part, unsupported_);
    if (!t.spatial && !own.has("coef")) throw part.error("expected an attribute 'coef'");
    t.parts.push_back({part, own.text(t.spatial ? "site" : "joint"), t.spatial ? 0 : own.number("coef", 1)});
    own.finish();
    if (t.spatial && t.parts.size() > 1 && t.parts.back().name == t.parts[t.parts.size() - 2].name)
      throw part.error(fmt::format("expected another site than the one before, found '{}' again", t.parts.back().name));
  }
  if (t.parts.size() < (t.spatial ? 2u : 1u))
    throw e.error(t.spatial ? "expected at least two sites in a tendon" : "expected at least one joint in a tendon");
  model.tendons.push_back(std::move(t));
}

}  // namespace spark::mjcf
