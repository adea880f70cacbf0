#include "constraint_reader.h"

#include <fmt/format.h>

namespace spark::mjcf {

/// The defaults of all equalities are those of `equality`, of all tendons those of `tendon`.
Attributes ConstraintReader::attributes(const Element& e, const char* tag) {
  return Attributes(e, defaults_, e.node.attribute("class").value(), unsupported_, tag);
}

void ConstraintReader::equality(const Element& e, Model& model) {
  if (e.tag() != "connect" && e.tag() != "weld" && e.tag() != "joint" && e.tag() != "tendon")
    return unsupported_.element(e);
  Attributes a = attributes(e, "equality");
  Equality x;
  x.from = e;
  x.type = e.tag();
  x.name = a.text("name");
  const bool tendons = x.type == "tendon", joints = x.type == "joint" || tendons;
  x.first = a.text(tendons ? "tendon1" : joints ? "joint1" : "body1");
  x.second = a.text(tendons ? "tendon2" : joints ? "joint2" : "body2");
  if (x.first.empty()) {
    if (a.has("site1") || a.has("site2")) {
      unsupported_.add(e, "an equality between sites is not supported");
      a.ignore({"site1", "site2"});
      return;
    }
    throw e.error(fmt::format("expected an attribute '{}'", tendons ? "tendon1" : joints ? "joint1" : "body1"));
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
                                    std::pair{"frictionloss", &t.frictionLoss}})
    *value = a.within(name, 0, 0);
  t.margin = a.number("margin", 0);
  t.springLength = a.number("springlength", -1);
  Limit limit;
  limit.read(a, "limited", "range");
  if (const auto range = compiler_.limit(a, "range", limit)) t.limited = true, t.range = *range;
  a.fill("solreflimit", t.limitSolref);
  a.fill("solimplimit", t.limitSolimp);
  a.fill("solreffriction", t.frictionSolref);
  a.fill("solimpfriction", t.frictionSolimp);
  a.ignore({"group", "width", "material", "rgba", "user"});
  a.finish();
  for (const Element& part : parts) {
    using Kind = TendonPart::Kind;
    const std::string_view tag = part.tag();
    const bool known = t.spatial ? tag == "site" || tag == "geom" || tag == "pulley" : tag == "joint";
    if (!known) {
      unsupported_.add(part, fmt::format("a tendon along <{}> is not supported: it is left out", tag));
      model.skippedTendons.insert(t.name);
      return;
    }
    Attributes own(part, unsupported_);
    TendonPart p{part, "", 1, Kind::joint, ""};
    p.kind = tag == "site" ? Kind::site : tag == "geom" ? Kind::geom : tag == "pulley" ? Kind::pulley : Kind::joint;
    const char* const number = p.kind == Kind::joint ? "coef" : p.kind == Kind::pulley ? "divisor" : nullptr;
    if (number && !own.has(number)) throw part.error(fmt::format("expected an attribute '{}'", number));
    if (number) p.coefficient = own.number(number, 1);
    if (p.kind == Kind::pulley && !(p.coefficient > 0)) throw part.error("expected a divisor above 0");
    if (p.kind != Kind::pulley)
      p.name = own.text(part.tag() == "site" ? "site" : part.tag() == "geom" ? "geom" : "joint");
    if (p.kind == Kind::geom) p.side = own.text("sidesite");
    own.finish();
    if (p.kind == Kind::site && !t.parts.empty() && t.parts.back().kind == Kind::site && t.parts.back().name == p.name)
      throw part.error(fmt::format("expected another site than the one before, found '{}' again", p.name));
    t.parts.push_back(std::move(p));
  }
  if (t.parts.size() < (t.spatial ? 2u : 1u))
    throw e.error(t.spatial ? "expected at least two sites in a tendon" : "expected at least one joint in a tendon");
  model.tendons.push_back(std::move(t));
}

}  // namespace spark::mjcf
