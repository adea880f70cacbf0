#include "read_world.h"

using namespace spark;
using namespace spark::webots::test;
using namespace spark::webots;
using Catch::Contains;

namespace {

/// A world with one PROTO in a file of its own, with this header behind the version, fields and body.
Read instance(const std::string& header, const std::string& fields, const std::string& body,
              const std::string& given = "") {
  return Read(world("P { " + given + " }"), Base::byFile,
              {{"P.proto", "#VRML_SIM R2023b utf8\n" + header + "PROTO P [ " + fields + " ] {\n" + body + "\n}\n"}});
}
const std::string kJavascript = "# template language: javascript\n";

}  // namespace

TEST_CASE("A template in Javascript has loops, conditions, values and fields") {
  const auto read = [](const std::string& given) {
    return instance(kJavascript, R"(field SFInt32 count 3 field SFVec3f size 1 2 3 field SFNode physics NULL
      field SFString name "stairs")",
                    R"(%<
  // one box each
  let x = 0
  const offset = (i) => i * fields.size.value.x;
>%
# a comment prevails: %< nothing( >%
Solid { name IS name physics IS physics boundingObject Group { children [
  %< for (let i = 0; i < fields.count.value; ++i) { >%
    %< if (i % 2) { >%
    Pose { translation %<= offset(i) >% %<= x >% %<= `${i / 2}`; >% children Sphere { radius 0.5 } }
    %< } else { >%
    Pose { translation %<=offset(i)>% 0 0 children Box { size IS size } }
    %< } >%
  %< } >%
] } }
)",
                    given);
  };
  const Read r = read("");
  CHECK(r.messages() == "");
  const auto& geoms = r.body("stairs").geoms;
  REQUIRE(geoms.size() == 3);
  CHECK(geoms[0].shape.lengths == Vec3(1, 2, 3));
  CHECK(geoms[1].shape.shape == engine::Shape::sphere);
  CHECK(geoms[1].pose.position == Vec3(1, 0, 0.5));
  CHECK(geoms[2].pose.position == Vec3(2, 0, 0));
  CHECK(read("count 5 size 2 1 1").body("stairs").geoms.at(4).pose.position == Vec3(8, 0, 0));
}

TEST_CASE("A template in Lua has loops, conditions, values and fields") {
  const Read r =
      instance("", "field SFInt32 count 4 field MFColor colors [ 1 0 0, 0 1 0 ] field MFString names [ \"a\" \"b\" ]",
               R"(%{
  local wbrandom = require("wbrandom")
  wbrandom.seed(3)
  print("count", fields.count.value)
}%
Group { children [ %{ for i = 1, fields.count.value do }%
  Solid { name %{='"' .. fields.names.value[(i - 1) % 2 + 1] .. i .. '"'}% translation %{=i / 4}% %{= fields.colors.value[2].g }% 0
    %{ if i > 3 then }% boundingObject Sphere { radius %{= fields.count.defaultValue }% } %{ end }% }
%{ end }% ] })");
  CHECK(r.messages() == "");
  CHECK(r.document.said() == std::vector<std::string>{"P.proto: count 4"});
  CHECK(r.body("b2").pose.position == Vec3(0.5, 1, 0));
  CHECK(r.body("a3").geoms.empty());
  CHECK(r.body("b4").geoms.at(0).shape.radius == 4);
}

TEST_CASE("Modules of templates are there, and their random numbers are the same in each run") {
  const auto radius = [](const std::string& header, const std::string& body) {
    const Read r = instance(header, "", body);
    INFO(r.messages());
    return r.body("s").geoms.at(0).shape.radius;
  };
  const std::string node = "Solid { name \"s\" boundingObject Sphere { radius ";
  CHECK(radius(kJavascript, "%< import * as wbvector3 from 'wbvector3.js'; >%" + node +
                                "%<= wbvector3.norm(wbvector3.cross({x: 3, y: 0, z: 0}, {x: 0, y: 4, z: 0})) >% } }") ==
        12);
  const double drawn = std::fmod(1140671485.0 * 7 + 12820163.0, 16777216.0);
  CHECK(radius(kJavascript, "%< import {integer as draw, seed} from 'wbrandom.js'; seed(7); >%" + node +
                                "%<= draw(1, 1000) >% } }") == 1 + std::fmod(drawn, 1000));
  CHECK(radius("", "%{ local wbrandom = require('wbrandom') wbrandom.seed(7) }%" + node +
                       "%{= wbrandom.integer(1, 1000) }% } }") ==
        radius(kJavascript, "%< import * as wbrandom from 'wbrandom.js'; wbrandom.seed(7); >%" + node +
                                "%<= wbrandom.integer(1, 1000) >% } }"));
  // A turn of 0.25 about z, twice.
  const std::string turn = "%< import * as w from 'wbrotation.js'; const r = {x: 0, y: 0, z: 2, a: 0.25}; >%";
  CHECK(radius(kJavascript, turn + node + "%<= w.combine(r, r).a >% } }") == Approx(0.5));
  CHECK(radius(kJavascript, turn + node + "%<= w.fromMatrix3(w.toMatrix3(w.combine(r, r))).a >% } }") == Approx(0.5));
  CHECK(radius("", "%{ local w = require('wbrotation') local r = {x = 0, y = 0, z = 2, a = 0.25} }%" + node +
                       "%{= w.frommatrix3(w.tomatrix3(w.combine(r, r))).a }% } }") == Approx(0.5));
  CHECK(radius(kJavascript, node + "%<= 1 + Date.now() + new Date().getTime() >% } }") == 1);
}

TEST_CASE("A template sees nodes by the names of their PROTOs, and NULL as nothing") {
  const Read r(
      world(R"(PROTO Q [ field SFFloat r 2 ] { Sphere { radius IS r } }
P { shape Q { r 3 } sizes [ 1 2 3, 4 5 6 ] turn 0 0 1 0.5 })"),
      Base::byFile,
      {{"P.proto",
        "#VRML_SIM R2023b utf8\n" + kJavascript +
            R"(PROTO P [ field SFNode shape NULL field SFNode other NULL field MFVec3f sizes [ ] field SFRotation turn 0 1 0 0
  field SFBool flag TRUE field MFNode parts [ ] ] {
Solid { name %<= '"' + [fields.shape.value.node_name, fields.shape.value.fields.r.value, fields.other.value === undefined,
    fields.sizes.value[1].y, fields.turn.value.a, fields.flag.value, fields.parts.value.length].join(' ') + '"' >%
  boundingObject IS shape } })"}});
  CHECK(r.messages() == "");
  CHECK(r.body("Q 3 true 5 0.5 true 0").geoms.at(0).shape.radius == 3);
}

TEST_CASE("A template that fails is an empty node with the place of the failure") {
  const auto message = [](const std::string& header, const std::string& body) {
    return instance(header, "", body).messages();
  };
  CHECK_THAT(
      message(kJavascript, "Solid {\n  name %<= nothing.at.all >% }"),
      Contains("a.wbt:2:1: a node 'P' is empty: P.proto:5:8: the template fails: ReferenceError: nothing is not"));
  CHECK_THAT(message("", "Solid { }\n%{ local x =\n\n nil + 1 }%"),
             Contains("P.proto:6:1: the template fails: attempt to"));
  CHECK_THAT(message(kJavascript, "%< let a = ; >%"), Contains("P.proto:4:1: the template fails: SyntaxError"));
  CHECK_THAT(message("", "%{ if }%"), Contains("the template fails: unexpected symbol"));
  CHECK_THAT(message(kJavascript, "Solid { translation 1 2 %<= '3x' >% }"),
             Contains("P.proto:4:25: expected a number, found '3x'"));
  CHECK_THAT(message(kJavascript, "Solid { }\n%< >% %< if"),
             Contains("P.proto:5:7: expected a >% behind this statement of a template"));
  CHECK_THAT(message(kJavascript, "%< import * as fs from 'fs'; >% Solid { }"), Contains("there is no module 'fs'"));
  CHECK_THAT(message(kJavascript, "%< wbfile.readTextFile('/etc/passwd'); >% Solid { }"),
             Contains("templates read and write no files: '/etc/passwd'"));
  CHECK_THAT(message("", "%{ local f = io.open('/etc/passwd') f:read() }% Solid { }"),
             Contains("attempt to index a nil value"));
  CHECK_THAT(message("", "%{ os.execute('true') }% Solid { }"), Contains("attempt to call a nil value"));
  CHECK_THAT(message(kJavascript, "%< (function f() { return f() + 1; })(); >% Solid { }"),
             Contains("too much recursion"));
  CHECK_THAT(message("", "%{ local s = 'x' while true do s = s .. s end }% Solid { }"), Contains("MiB of memory"));
}

TEST_CASE("A template that never ends costs the import its time, once") {
  Read r(world("Solid { name \"other\" }\nP { }\nQ { }"), Base::byFile,
         {{"P.proto", "#VRML_SIM R2023b utf8\nPROTO P [ ] { %< for (;;) ; >% Solid { } }"},
          {"Q.proto", "#VRML_SIM R2023b utf8\nPROTO Q [ ] { %{ while true do end }% Solid { } }"}});
  CHECK_THAT(r.messages(), Contains("a node 'P' is empty: the template takes more than 1 s of CPU time") &&
                               Contains("a node 'Q' is empty: no template is run after one that ended its process"));
  CHECK(r.body("other").pose.position == Vec3::Zero());
}
