#include "vocabulary.h"

#include <fmt/format.h>

namespace spark::mjcf {

namespace {

constexpr std::string_view kBodies = "worldbody body frame";
constexpr std::string_view kVisual = "visual";
constexpr std::string_view kSection = "mujoco";

constexpr Word kVocabulary[] = {
    {"mujoco", "", "model", ""},
    {"compiler", kSection,
     "angle autolimits eulerseq meshdir assetdir inertiafromgeom inertiagrouprange fitaabb strippath exactmeshinertia "
     "boundmass boundinertia balanceinertia settotalmass coordinate",
     "texturedir discardvisual fusestatic convexhull usethread alignfree"},
    {"option", kSection,
     "gravity wind timestep tolerance impratio density viscosity iterations cone solver integrator collision "
     "noslip_iterations noslip_tolerance mpr_iterations mpr_tolerance o_margin o_solref o_solimp",
     "jacobian apirate magnetic"},
    {"flag", "option",
     "contact limit frictionloss passive actuation clampctrl equality constraint gravity filterparent refsafe override "
     "multiccd nativeccd eulerdamp midphase invdiscrete island sensornoise",
     "warmstart sensor energy fwdinv autoreset"},
    {"size", kSection, "",
     "memory njmax nconmax nstack nuserdata nkey nuser_body nuser_jnt nuser_geom nuser_site nuser_cam nuser_tendon "
     "nuser_actuator nuser_sensor"},
    {"statistic", kSection, "", "meanmass meaninertia meansize extent center"},
    {"visual", kSection, "", ""},
    {"global", kVisual, "",
     "cameraid orthographic fov fovy ipd azimuth elevation linewidth glow offwidth offheight realtime ellipsoidinertia "
     "bvactive treedepth"},
    {"quality", kVisual, "", "shadowsize offsamples numslices numstacks numquads"},
    {"headlight", kVisual, "", "ambient diffuse specular active"},
    {"map", kVisual, "",
     "stiffness stiffnessrot force torque alpha fogstart fogend znear zfar haze shadowclip shadowscale actuatortendon"},
    {"scale", kVisual, "",
     "forcewidth contactwidth contactheight connect com camera light selectpoint jointlength jointwidth actuatorlength "
     "actuatorwidth framelength framewidth constraint slidercrank frustum"},
    {"rgba", kVisual, "",
     "fog haze force inertia joint actuator actuatornegative actuatorpositive com camera light selectpoint connect "
     "contactpoint contactforce contactfriction contacttorque contactgap rangefinder constraint slidercrank "
     "crankbroken "
     "frustum bv bvactive"},
    {"keyframe", kSection, "", ""},
    {"key", "keyframe", "", "name time qpos qvel act ctrl mpos mquat"},
    {"custom", kSection, "", ""},
    {"numeric", "custom", "", "name size data"},
    {"text", "custom", "", "name data"},
    {"tuple", "custom", "", "name"},
    {"element", "tuple", "", "objtype objname prm"},
    {"default", "mujoco default", "class", ""},
    {"asset", kSection, "", ""},
    {"mesh", "asset default", "name class file vertex face scale refpos refquat inertia",
     "normal texcoord smoothnormal content_type maxhullvert"},
    {"hfield", "asset", "name file nrow ncol size elevation", "content_type"},
    {"texture", "asset", "",
     "name class type colorspace content_type file gridsize gridlayout fileright fileleft fileup filedown filefront "
     "fileback builtin rgb1 rgb2 mark markrgb random width height hflip vflip nchannel"},
    {"material", "asset default", "rgba name class",
     "texture texrepeat texuniform emission specular shininess reflectance metallic roughness"},
    {"layer", "material", "", "texture role"},
    {"worldbody", kSection, "", ""},
    {"body", kBodies, "name childclass pos quat axisangle xyaxes zaxis euler gravcomp mocap", "user"},
    {"frame", kBodies, "childclass pos quat axisangle xyaxes zaxis euler", "name"},
    {"inertial", "body", "pos quat axisangle xyaxes zaxis euler mass diaginertia fullinertia", ""},
    {"freejoint", "body frame", "name", "group align"},
    {"joint", "body frame default",
     "name class type pos axis ref limited range actuatorfrclimited actuatorfrcrange armature damping frictionloss "
     "stiffness springref springdamper solreflimit solimplimit solreffriction solimpfriction margin",
     "group user"},
    {"geom", "worldbody body frame default",
     "name class type pos quat axisangle xyaxes zaxis euler fromto size mesh hfield fitscale contype conaffinity "
     "condim "
     "priority friction solref solimp solmix margin gap density mass group fluidshape fluidcoef",
     "material rgba user"},
    {"site", "worldbody body frame default", "name class pos quat axisangle xyaxes zaxis euler fromto",
     "type size group material rgba user"},
    {"camera", "worldbody body frame default", "",
     "name class mode target fovy ipd pos quat axisangle xyaxes zaxis euler user resolution focal focalpixel principal "
     "principalpixel sensorsize orthographic projection output"},
    {"light", "worldbody body frame default", "",
     "name class mode target type directional castshadow active pos dir bulbradius intensity range attenuation cutoff "
     "exponent ambient diffuse specular texture"},
    {"contact", kSection, "", ""},
    {"exclude", "contact", "body1 body2", "name"},
    {"pair", "contact default", "geom1 geom2 condim friction solref solimp margin gap class", "name"},
    {"equality", kSection, "", ""},
    {"equality", "default", "active solref solimp", ""},
    {"connect", "equality", "name class active solref solimp body1 body2 anchor site1 site2", ""},
    {"weld", "equality", "name class active solref solimp body1 body2 anchor relpose torquescale site1 site2", ""},
    {"joint", "equality", "name class active solref solimp joint1 joint2 polycoef", ""},
    {"tendon", "equality", "name class active solref solimp tendon1 tendon2 polycoef", ""},
    {"tendon", kSection, "", ""},
    {"tendon", "default",
     "stiffness damping frictionloss margin springlength limited range solreflimit solimplimit solreffriction "
     "solimpfriction",
     "group width material rgba user"},
    {"fixed", "tendon",
     "name class stiffness damping frictionloss margin springlength limited range solreflimit solimplimit "
     "solreffriction solimpfriction",
     "group width material rgba user"},
    {"spatial", "tendon",
     "name class stiffness damping frictionloss margin springlength limited range solreflimit solimplimit "
     "solreffriction solimpfriction",
     "group width material rgba user"},
    {"joint", "fixed", "joint coef", ""},
    {"site", "spatial", "site", ""},
    {"geom", "spatial", "geom sidesite", ""},
    {"pulley", "spatial", "divisor", ""},
    {"actuator", kSection, "", ""},
    {"general", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange dyntype dynprm gaintype gainprm biastype biasprm",
     "group user"},
    {"motor", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange",
     "group user"},
    {"position", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange kp kv",
     "group user"},
    {"velocity", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange kv",
     "group user"},
    {"intvelocity", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange kp",
     "group user"},
    {"damper", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange kv",
     "group user"},
    {"cylinder", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange timeconst area diameter bias",
     "group user"},
    {"muscle", "actuator default",
     "name class joint jointinparent tendon site refsite body cranksite slidersite cranklength gear ctrllimited "
     "ctrlrange "
     "forcelimited forcerange actlimited actrange lengthrange timeconst range force scale lmin lmax vmax fpmax fvmax",
     "group user"},
    {"adhesion", "actuator default",
     "name class body ctrllimited ctrlrange forcelimited forcerange actlimited actrange lengthrange gear gain",
     "group user"},
    {"sensor", kSection, "", "", Word::foreign},
};

void look(Document& document, const Element& e, const Word& word, Unsupported& unsupported, int depth) {
  if (word.content == Word::foreign || depth > Document::kMaxDepth) return;
  for (const pugi::xml_attribute a : e.node.attributes())
    if (!word.knows(a.name())) unsupported.attribute(e, a.name());
  for (const pugi::xml_node node : e.node.children()) {
    const Element child{node, e.file};
    if (node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata)
      unsupported.add(e, fmt::format("text in <{}> is ignored", e.tag()));
    else if (child.tag() == "include")
      for (const pugi::xml_attribute a : node.attributes())
        if (std::string_view(a.name()) != "file") unsupported.attribute(child, a.name());
  }
  for (const Element& child : document.children(e))
    if (const Word* const known = wordOf(kVocabulary, child.tag(), e.tag()))
      look(document, child, *known, unsupported, depth + 1);
    else
      unsupported.element(child);
}

}  // namespace

std::span<const Word> vocabulary() { return kVocabulary; }

void nameUnknown(Document& document, Unsupported& unsupported) {
  look(document, document.root(), *wordOf(kVocabulary, "mujoco", ""), unsupported, 0);
}

}  // namespace spark::mjcf
