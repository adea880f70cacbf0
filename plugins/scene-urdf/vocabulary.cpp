#include "vocabulary.h"

#include <fmt/format.h>

#include <set>
#include <string>

namespace spark::urdf {

namespace {

constexpr std::string_view kPlaced = "robot/joint link/inertial link/visual link/collision";
constexpr std::string_view kDriven = "robot/transmission transmission/joint transmission/actuator";

constexpr Word kVocabulary[] = {
    {"robot", "", "name", "version"},
    {"link", "robot", "name", "", Word::elements, true},
    {"inertial", "robot/link", "", ""},
    {"mass", "link/inertial", "value", ""},
    {"inertia", "link/inertial", "ixx ixy ixz iyy iyz izz", ""},
    {"visual", "robot/link", "", "name", Word::elements, true},
    {"collision", "robot/link", "", "name", Word::elements, true},
    {"contact", "robot/link", "", ""},
    {"lateral_friction", "link/contact", "value", ""},
    {"origin", kPlaced, "xyz rpy", ""},
    {"geometry", "link/visual link/collision", "", ""},
    {"box", "visual/geometry collision/geometry", "size", ""},
    {"sphere", "visual/geometry collision/geometry", "radius", ""},
    {"cylinder", "visual/geometry collision/geometry", "radius length", ""},
    {"capsule", "visual/geometry collision/geometry", "radius length", ""},
    {"mesh", "visual/geometry collision/geometry", "filename scale", ""},
    {"material", "robot link/visual", "name", "", Word::elements, true},
    {"color", "robot/material visual/material", "rgba", ""},
    {"joint", "robot", "name type", "", Word::elements, true},
    {"parent", "robot/joint", "link", ""},
    {"child", "robot/joint", "link", ""},
    {"axis", "robot/joint", "xyz", ""},
    {"limit", "robot/joint", "lower upper effort", "velocity acceleration deceleration jerk"},
    {"dynamics", "robot/joint", "damping friction", ""},
    {"mimic", "robot/joint", "joint multiplier offset", ""},
    {"calibration", "robot/joint", "", "rising falling reference_position"},
    {"safety_controller", "robot/joint", "", "soft_lower_limit soft_upper_limit k_position k_velocity"},
    {"transmission", "robot", "", "name type", Word::elements, true},
    {"type", "robot/transmission", "", "", Word::text},
    {"joint", "robot/transmission", "name", "", Word::elements, true},
    {"actuator", "robot/transmission", "", "name", Word::elements, true},
    {"hardwareInterface", "robot/joint transmission/joint transmission/actuator", "", "", Word::text, true},
    {"mechanicalReduction", kDriven, "", "", Word::text},
    {"gazebo", "robot", "reference", "", Word::elements, true},
    {"mu1", "robot/gazebo", "value", "", Word::text},
    {"mu2", "robot/gazebo", "value", "", Word::text},
    {"selfCollide", "robot/gazebo", "value", "", Word::text},
    {"self_collide", "robot/gazebo", "value", "", Word::text},
    {"gravity", "robot/gazebo", "value", "", Word::text},
    {"turnGravityOff", "robot/gazebo", "value", "", Word::text},
    {"static", "robot/gazebo", "value", "", Word::text},
    {"material", "robot/gazebo", "value", "", Word::text},
    {"springStiffness", "robot/gazebo", "value", "", Word::text},
    {"springReference", "robot/gazebo", "value", "", Word::text},
    {"sensor", "robot/gazebo", "name type", "", Word::foreign, true},
};

/// `place`: the element's own, as in Word::in.
void look(const Element& e, const Word& word, const std::string& place, Unsupported& unsupported) {
  if (word.content == Word::foreign) return;
  for (const pugi::xml_attribute a : e.node.attributes()) {
    const std::string_view name = a.name();
    // Namespaces only say what prefixes mean.
    if (!word.knows(name) && name != "xmlns" && !name.starts_with("xmlns:"))
      unsupported.attribute(e, std::string(name));
  }
  std::set<std::string_view> seen;
  for (const pugi::xml_node node : e.node.children()) {
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata) {
      if (word.content != Word::text) unsupported.add(e, fmt::format("text in <{}> is ignored", e.tag()));
      continue;
    }
    if (node.type() != pugi::node_element) continue;
    const Element child{node, e.file};
    const Word* const known = wordOf(kVocabulary, child.tag(), place);
    if (!known)
      unsupported.element(child);
    else if (!seen.insert(known->element).second && !known->repeats)
      unsupported.add(child, fmt::format("a second <{}> in <{}> is ignored", child.tag(), e.tag()));
    else
      look(child, *known, fmt::format("{}/{}", e.tag(), child.tag()), unsupported);
  }
}

}  // namespace

std::span<const Word> vocabulary() { return kVocabulary; }

void nameUnknown(const Element& root, Unsupported& unsupported) {
  look(root, *wordOf(kVocabulary, "robot", ""), "robot", unsupported);
}

}  // namespace spark::urdf
