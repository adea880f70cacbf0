#include "read_world.h"

using namespace spark;
using namespace spark::webots::test;
using namespace spark::webots;
using Catch::Contains;

TEST_CASE("Commas and comments separate; numbers, texts and lists are read as VRML has them") {
  const Read r(world("Solid{translation .5,-1e-1,+2#c\nname\"a\\\"b\" children[]model\"\"}"));
  CHECK(r.messages() == "");
  CHECK(r.body("a\"b").pose.position == Vec3(0.5, -0.1, 2));
}

TEST_CASE("Numbers that are none are named, and 0") {
  const Read r(world("Solid { translation 1 -nan inf }"));
  CHECK(r.body("solid").pose.position == Vec3(1, 0, 0));
  CHECK_THAT(r.messages(), Contains("a.wbt:2:23: expected a number, found '-nan'; 0 is taken"));
}

TEST_CASE("A file that is not of Webots is refused, and templates outside of PROTOs") {
  CHECK_THAT(failure("Solid { }"), Contains("a.wbt:1:1: expected '#VRML_SIM R2022a utf8', or another version"));
  CHECK_THAT(failure(world("Solid { name \"%{= 3 }%\" }")),
             Contains("a.wbt:2:15: '%{' begins a statement of a template, which only the node of a PROTO may have"));
  CHECK_THAT(failure(world("Solid { translation %<= x >% 0 0 }")), Contains("a.wbt:2:21: '%<' begins"));
}

TEST_CASE("The oldest PROTO files have no line with their version") {
  const Read r("# A stool.\nPROTO Stool [ ] { Solid { boundingObject Cylinder { } physics Physics { } } }");
  CHECK_THAT(r.messages(), Contains("a.wbt:1:1: expected '#VRML_SIM R2022a utf8', or another version, in the first "
                                    "line; it is read as a file before R2022a"));
  CHECK(r.document.coordinates() == "NUE");
}

TEST_CASE("What EXTERNPROTO names without being a PROTO file is named and ignored") {
  const Read r(world("EXTERNPROTO \"home.wbt\" Solid { }"));
  CHECK(r.body("solid").name == "solid");
  CHECK_THAT(r.messages(), Contains("a.wbt:2:13: expected the name of a .proto file, found \"home.wbt\""));
}

TEST_CASE("Errors of syntax say where they are, what was expected and what is there") {
  const auto fails = [](const std::string& text, const std::string& message) {
    INFO(text);
    CHECK_THAT(failure(world(text)), Contains(message));
  };
  fails("Solid", "a.wbt:2:6: expected '{' behind 'Solid', found the end of the file");
  fails("Solid {", "expected a field of Solid or '}', found the end of the file");
  fails("Solid { name", "expected a value, found the end of the file");
  fails("Solid { name \"a", "a.wbt:2:14: expected a \" at the end of the text");
  fails("Solid { children [ 1 \"a\" ] }", "a.wbt:2:22: expected values of one kind, found \"a\"");
  fails("Solid { children [ [ ] ] }", "expected a value, found '['");
  fails("Solid { translation 1 2 3x }", "expected a number, found '3x'");
  fails("Solid { translation 1 2 1e999 }", "expected a number, found '1e999'");
  fails("Solid { children [ Solid { } ", "expected a value, found the end of the file");
  fails("} Solid { }", "expected the type of a node, found '}'");
  fails("3", "expected the type of a node, found '3'");
  fails("EXTERNPROTO 3", "expected the name of a .proto file in quotes");
  fails("IMPORTABLE Solid { }", "expected EXTERNPROTO, found 'Solid'");
  fails("PROTO P { }", "expected '[' before the fields of the PROTO, found '{'");
  fails("PROTO P [ fields SFFloat x 1 ] { }", "expected 'field' or ']' in the PROTO 'P', found 'fields'");
  fails("PROTO P [ field Float x 1 ] { }", "expected a type such as SFFloat or MFNode, found 'Float'");
  fails("PROTO P [ field SFFloat{ 1 2 x 1 ] {", "expected a '}' behind the values of the field");
  fails("PROTO P [ ] { Solid { } Solid { } }", "expected '}' behind the one node of the PROTO");
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "Group { children [ ";
  fails(deep, "expected nodes nested at most 200 deep");
}

TEST_CASE("Names of other files never lead out of the folder of files") {
  CHECK(fileNames("worlds/a.wbt", "../protos/P.proto").front() == "protos/P.proto");
  CHECK(fileNames("projects/robots/x/worlds/a.wbt", "webots://projects/robots/y/protos/Y.proto").front() ==
        "projects/robots/x/worlds/projects/robots/y/protos/Y.proto");
  for (const char* url : {"../../../etc/passwd", "/etc/passwd", "file:///etc/passwd", "..", "", "webots://../x"})
    for (const std::string& name : fileNames("worlds/a.wbt", url)) {
      CHECK_FALSE(name.starts_with('/'));
      CHECK_FALSE(name.starts_with(".."));
    }
}
