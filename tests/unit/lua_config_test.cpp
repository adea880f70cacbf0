// Config files: lookup, include, options, and values that are set from outside.
#include "absence.h"
#include "lua_fixture.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Catch::Equals;

namespace {
/// Changes the working folder while it lives.
struct WorkingFolder {
  std::filesystem::path before = std::filesystem::current_path();
  explicit WorkingFolder(const std::filesystem::path& folder) { std::filesystem::current_path(folder); }
  ~WorkingFolder() { std::filesystem::current_path(before); }
};
/// Defines a channel when it is linked.
class Definer : public Leaf {
  SPARK_CLASS(Definer, Leaf)
 public:
  static void describe(Description<Definer>& d) { d.doc("Defines 'prepare'."); }

 protected:
  void onLink() override { kernel().events().define("prepare", Order::parentsFirst, "A phase."); }
};

class Misspelt : public Leaf {
  SPARK_CLASS(Misspelt, Leaf)
 public:
  static void describe(Description<Misspelt>& d) {
    d.doc("Has hooks on channels that are not defined.");
    d.on<&Misspelt::prepare>(ChannelName("prepar"));
    d.on<&Misspelt::prepare>(ChannelName("of my own"));
  }
  void prepare(const Event&) {}
};
}  // namespace

TEST_CASE("a config is looked up in the working folder first, then in the added folders in order") {
  LuaHost h;
  for (const char* sub : {"work", "second"}) std::filesystem::create_directory(h.folder / sub);
  scripts(h.kernel).addFolder(h.folder / "second");
  h.write("second/c.lua", "found = 'second'");
  scripts(h.kernel).runConfig("c.lua");
  CHECK(h.run("return found") == Value("second"));
  h.write("c.lua", "found = 'first'");
  scripts(h.kernel).runConfig("c.lua");
  CHECK(h.run("return found") == Value("first"));
  const WorkingFolder there(h.folder / "work");
  h.write("work/c.lua", "found = 'work'");
  scripts(h.kernel).runConfig("c.lua");
  CHECK(h.run("return found") == Value("work"));
  scripts(h.kernel).runConfig((h.folder / "second/c.lua").string());
  CHECK(h.run("return found") == Value("second"));
}

TEST_CASE("a program can set globals of configs, also tables with string keys and sequences") {
  LuaHost h;
  scripts(h.kernel).setGlobal("host", List{List{"share", "/usr/share"}, List{"paths", List{"a", "b"}},
                                           List{"empty", List{}}, List{"alone", true}});
  h.write("c.lua", "found = host.share .. #host.paths .. host.paths[2] .. #host.empty .. tostring(host.alone)");
  scripts(h.kernel).runConfig("c.lua");
  CHECK(h.run("return found") == Value("/usr/share2b0true"));
  scripts(h.kernel).setGlobal("host", {});
  CHECK(h.run("return host").isNil());
}

TEST_CASE("the error for a missing config lists the searched folders and similar names") {
  LuaHost h;
  h.write("soccer.lua", "");
  const std::string text = LuaHost::errorOf([&] { scripts(h.kernel).runConfig("socer.lua"); });
  CHECK_THAT(text, Contains("there is no config 'socer.lua'. Looked in: " + std::filesystem::current_path().string() +
                            ", " + h.folder.string() + ". Did you mean 'soccer.lua'?"));
  std::filesystem::create_directory(h.folder / "folder");
  CHECK_THAT(LuaHost::errorOf([&] { scripts(h.kernel).runConfig("folder"); }), Contains("is a folder"));
}

TEST_CASE("include runs a file in the environment of the including script and returns its results") {
  LuaHost h;
  h.write("rooms.lua", "function room(name) return new('Thing', '/usr/' .. name) end return 42");
  CHECK(h.configFailure("answer = include 'rooms.lua'\nroom('kitchen')") == "");
  CHECK(h.run("return {answer, get('/usr/kitchen').path}") == Value(List{42, "/usr/kitchen"}));
  CHECK_THAT(h.configFailure("include 'room.lua'"),
             Contains("config.lua:1: there is no script 'room.lua'") && Contains("Did you mean 'rooms.lua'?"));
}

TEST_CASE("include also looks in the folder of the running config") {
  LuaHost h;
  std::filesystem::create_directory(h.folder / "mine");
  h.write("mine/a.lua", "include 'b.lua'");
  h.write("mine/b.lua", "b = 1");
  scripts(h.kernel).runConfig((h.folder / "mine/a.lua").string());
  CHECK(h.run("return b") == Value(1));
}

TEST_CASE("an included file is found next to the file that includes it, and never in the working folder") {
  LuaHost h;
  for (const char* sub : {"mine/parts", "work"}) std::filesystem::create_directories(h.folder / sub);
  h.write("mine/a.lua", "include 'parts/a.lua'");
  h.write("mine/parts/a.lua", "include 'b.lua'");
  h.write("mine/parts/b.lua", "b = 'beside'");
  h.write("work/b.lua", "b = 'taken over'");
  const WorkingFolder there(h.folder / "work");
  scripts(h.kernel).runConfig((h.folder / "mine/a.lua").string());
  CHECK(h.run("return b") == Value("beside"));
  std::filesystem::remove(h.folder / "mine/parts/b.lua");
  const std::string text = LuaHost::errorOf([&] { scripts(h.kernel).runConfig((h.folder / "mine/a.lua").string()); });
  CHECK_THAT(text, Contains("there is no script 'b.lua'. Looked in: "));
  Thing& thing = h.thing("/usr/thing");  // whose scripts are also looked for in the working folder
  const std::string attached = LuaHost::errorOf([&] { scripts(h.kernel).attach(thing, "none.lua"); });
  CHECK(lacks(text, (h.folder / "work").string(), attached));
  CHECK(h.run("return b") == Value("beside"));
}

TEST_CASE("an attached script is taken from the working folder only if no other folder has it") {
  LuaHost h;
  std::filesystem::create_directory(h.folder / "work");
  const WorkingFolder there(h.folder / "work");
  h.write("work/s.lua", "self.label = 'work'");
  Thing& a = h.thing("/usr/a");
  scripts(h.kernel).attach(a, "s.lua");
  CHECK(a.label == "work");
  h.write("s.lua", "self.label = 'folder'");
  scripts(h.kernel).attach(a, "s.lua");
  CHECK(a.label == "folder");
}

TEST_CASE("a script that is attached later is found next to the config that has run") {
  LuaHost h;
  std::filesystem::create_directories(h.folder / "mine");
  h.write("mine/a.lua", "");
  h.write("mine/s.lua", "self.label = 'beside the config'");
  Thing& a = h.thing("/usr/a");
  scripts(h.kernel).runConfig((h.folder / "mine/a.lua").string());
  scripts(h.kernel).attach(a, "s.lua");
  CHECK(a.label == "beside the config");
}

TEST_CASE("a config in an endless loop ends when the kernel is stopped, even if it catches errors") {
  for (const char* loop : {"while true do end", "while true do pcall(function() while true do end end) end"}) {
    LuaHost h;
    h.kernel.requestStop();
    CHECK(h.configFailure("short = true") == "");
    CHECK_THAT(h.configFailure(std::string("before = 1\n") + loop),
               Contains("config.lua:2: stopped before the config was done: the host was asked to end."));
  }
}

TEST_CASE("a handler for a misspelt channel is an error: at the end of a config, or at once in other scripts") {
  LuaHost h;
  const auto define = [&] { h.kernel.events().define("prepare", Order::parentsFirst, "A phase."); };
  CHECK(h.configFailure("on('prepair', function() end)") == "");  // no channel has a similar name yet
  define();
  CHECK_THAT(h.configFailure("\non('prepair', function() end)"),
             Contains("config.lua:2: there is no event channel 'prepair': nothing would ever run this handler. Did you "
                      "mean 'prepare'?"));
  CHECK_THAT(h.failure("on('prepair', function() end)"), Contains("test:1: there is no event channel 'prepair'"));
  CHECK(h.failure("on('prepare', function() end) on('of my own', function() end)") == "");
  LuaHost late;
  late.kernel.registerClass<Definer>();
  CHECK_THAT(late.configFailure("on('prepair', function() end)\nnew('Definer', '/usr/d')"),
             Contains("config.lua:1: there is no event channel 'prepair'"));
  CHECK(late.configFailure("delete('/usr/d') on('prepare', function() end)\nnew('Definer', '/usr/d')") == "");
}

TEST_CASE("a class with a hook on a misspelt channel is reported at the end of the config, once it has an instance") {
  LuaHost h;
  h.kernel.registerClass<Misspelt>();
  h.kernel.events().define("prepare", Order::parentsFirst, "A phase.");
  CHECK(h.configFailure("") == "");
  CHECK(h.text == "");
  CHECK(h.configFailure("new('Misspelt', '/usr/m')") == "");
  CHECK(h.text ==
        "class Misspelt has a hook on 'prepar', and there is no such channel: nothing runs it. Did you mean "
        "'prepare'?\n");
}

TEST_CASE("the error for a global that is nil suggests a similar name") {
  LuaHost h;
  h.write("rooms.lua", "function physics() end");
  CHECK_THAT(h.configFailure("include 'rooms.lua'\nphsyics()"),
             Contains("config.lua:2: attempt to call a nil value (global 'phsyics'). Did you mean 'physics'?"));
  CHECK_THAT(h.failure("local x = maths.pi"),
             Contains("attempt to index a nil value (global 'maths'). Did you mean 'math'?"));
}

TEST_CASE("errors in configs name file and line, also in included files") {
  LuaHost h;
  h.write("inner.lua", "function wrong()\n  new('Nothing', '/usr/x')\nend");
  CHECK_THAT(h.configFailure("include 'inner.lua'\n\nwrong()"),
             Equals("inner.lua:2: there is no class 'Nothing'. Did you mean 'Thing'?\n  from config.lua:3"));
  h.write("syntax.lua", "\nif");
  CHECK_THAT(h.configFailure("include 'syntax.lua'"),
             Equals("syntax.lua:2: unexpected symbol near <eof>\n  from config.lua:1"));
}

TEST_CASE("bytecode is refused") {
  LuaHost h;
  CHECK_THAT(h.configFailure("\x1bLua"), Contains("expected text, found compiled code"));
}

TEST_CASE("plugin reports a name that no plugin has") {
  LuaHost h;
  CHECK_THAT(h.configFailure("plugin 'sensrs'"), Contains("config.lua:1: there is no plugin 'sensrs'."));
}

TEST_CASE("an option has its default or the value set from outside, and is listed") {
  LuaHost h;
  scripts(h.kernel).addOverride("agents", Value(22));
  CHECK(h.configFailure("a = option{name = 'agents', default = 11, doc = 'Players a side.'}\n"
                        "b = option{name = 'parser', default = 'SexpParser', choices = {'SexpParser', 'JsonParser'}}\n"
                        "c = option{name = 'free'}") == "");
  CHECK(h.run("return {a, b, c}") == Value(List{22, "SexpParser"}));
  const std::vector<List> expected{{"agents", 11, "Players a side.", 22},
                                   {"parser", "SexpParser", "", "SexpParser"},
                                   {"free", Value(), "", Value()}};
  CHECK(scripts(h.kernel).options() == expected);
}

TEST_CASE("an option's value is converted to the type of its default") {
  LuaHost h;
  scripts(h.kernel).addOverride("step", Value(1));
  scripts(h.kernel).addOverride("team", Value(42));
  scripts(h.kernel).addOverride("whole", Value(3.0));
  CHECK(h.configFailure("v = {option{name = 'step', default = 0.02}, option{name = 'team', default = 'A'}, option{name "
                        "= 'whole', default = 1}}") == "");
  CHECK(h.run("return v") == Value(List{1.0, "42", 3}));
}

TEST_CASE("a value typed for an option or a property stays text until its type is known") {
  LuaHost h;
  for (const char* key : {"team", "number", "list", "any", "/usr/a.label", "/usr/a.mass", "/usr/a.anything"})
    scripts(h.kernel).addOverride(key, Value::typed("007"));
  scripts(h.kernel).addOverride("list", Value::typed("{1, x}"));
  scripts(h.kernel).addOverride("token", Value::typed("0123456789012345678"));
  CHECK(h.configFailure("new('Thing', '/usr/a')\n"
                        "v = {option{name = 'team', default = 'A'}, option{name = 'token', default = ''}, option{name "
                        "= 'number', default = 1},\n"
                        "  option{name = 'list', default = {}}, option{name = 'any'}}") == "");
  CHECK(h.run("return v") == Value(List{"007", "0123456789012345678", 7, List{1, "x"}, 7}));
  CHECK(h.run("a = get '/usr/a' return {a.label, a.mass, a.anything}") == Value(List{"007", 7.0, 7}));
}

TEST_CASE("an option refuses values of another type and values that are not among its choices") {
  LuaHost h;
  scripts(h.kernel).addOverride("agents", Value("many"));
  CHECK_THAT(h.configFailure("option{name = 'agents', default = 11}"),
             Equals("config.lua:1: cannot set option 'agents'\n  because: expected integer (its default is 11), found "
                    "string \"many\""));
  scripts(h.kernel).addOverride("parser", Value("XmlParser"));
  CHECK_THAT(h.configFailure("option{name = 'parser', default = 'a', choices = {'a', 'b'}}"),
             Contains("cannot set option 'parser'\n  because: expected one of \"a\", \"b\", found \"XmlParser\""));
  CHECK_THAT(h.configFailure("option{name = 'x', default = 'c', choices = {'a', 'b'}}"),
             Contains("the default of option 'x' is not among its choices"));
}

TEST_CASE("option checks its arguments") {
  LuaHost h;
  CHECK_THAT(h.failure("option{name = 'a', defualt = 1}"),
             Contains("option knows no field 'defualt'. Did you mean 'default'?"));
  CHECK_THAT(h.failure("option('a')"), Contains("option expected a table"));
  CHECK_THAT(h.failure("option{default = 1}"), Contains("expected an option's name (a string), found nil"));
  CHECK_THAT(h.failure("option{name = 'a.b'}"), Contains("cannot declare option 'a.b'"));
  CHECK(h.failure("option{name = 'a', default = 1} option{name = 'a', default = 1}") == "");
  CHECK_THAT(h.failure("option{name = 'a', default = 2}"), Contains("option 'a' is declared already"));
}

TEST_CASE("a value set from outside takes precedence over assignments and setters in the config") {
  LuaHost h;
  scripts(h.kernel).addOverride("/usr/a.mass", Value(9));
  CHECK(h.configFailure("a = new('Thing', '/usr/a')\natOnce = a.mass\na.mass = 3\na:setMass(4)\na.count = 5") == "");
  CHECK(h.run("return {atOnce, a.mass, a.count}") == Value(List{9.0, 9.0, 5}));
  h.run("a.mass = 6");  // after the config, scripts may change it
  CHECK(h.run("return a.mass") == Value(6.0));
}

TEST_CASE("an ignored assignment is logged at debug level") {
  LuaHost h;
  h.kernel.log().setLevel(Level::debug);
  scripts(h.kernel).addOverride("/usr/a.mass", Value(9));
  CHECK(h.configFailure("new('Thing', '/usr/a').mass = 3") == "");
  CHECK_THAT(h.text, Contains("/usr/a.mass stays 9: it was set from outside the config"));
}

TEST_CASE("a value set from outside also applies to nodes made by node:new, made again, or not made by the config") {
  LuaHost h;
  scripts(h.kernel).addOverride("/usr/a.mass", Value(9));
  scripts(h.kernel).addOverride("/usr/scene/ball.mass", Value(5));
  CHECK(h.configFailure("get('/usr'):new('Thing', 'a') delete('/usr/a') again = get('/usr'):new('Thing', 'a').mass") ==
        "unknown setting '/usr/scene/ball.mass': there is no /usr/scene/ball.");
  CHECK(h.run("return again") == Value(9.0));
  Thing& ball = h.thing("/usr/scene/ball");  // as an import would
  CHECK(h.configFailure("get('/usr/scene/ball').mass = 2") == "");
  CHECK(ball.mass == 5);
}

TEST_CASE("a value set for Namespace.Name applies as soon as the namespace exists") {
  LuaHost h;
  scripts(h.kernel).addOverride("Field.mass", Value(12));
  scripts(h.kernel).addOverride("Soccer.FieldLength", Value(30));
  CHECK(h.configFailure("f = new('Thing', '/sys/variables/Field')\natOnce = {f.mass}\n"
                        "s = new('Group', '/sys/variables/Soccer')\natOnce[2] = s.FieldLength\n"
                        "f.mass = 1\nSoccer.FieldLength = 20\ns:set('FieldLength', 21)") == "");
  CHECK(h.run("return {atOnce, Field.mass, Soccer.FieldLength}") == Value(List{List{12.0, 30}, 12.0, 30}));
}

TEST_CASE("settings without a target are errors that suggest similar names") {
  const std::string config =
      "option{name = 'agents', default = 11}\nnew('Thing', '/usr/ball')\nnew('Group', "
      "'/sys/variables/Soccer'):set('FieldLength', 30)";
  const std::vector<std::pair<const char*, std::string>> cases{
      {"agnets", "unknown setting 'agnets': the config declares no option of that name. Did you mean 'agents'?"},
      {"Soccer.FieldLenght",
       "unknown setting 'Soccer.FieldLenght': /sys/variables/Soccer has no variable of that name. Did you mean "
       "'Soccer.FieldLength'?"},
      {"Socer.FieldLength",
       "unknown setting 'Socer.FieldLength': there is no /sys/variables/Socer. Did you mean 'Soccer.FieldLength'?"},
      {"/usr/bal.mass", "unknown setting '/usr/bal.mass': there is no /usr/bal. Did you mean '/usr/ball.mass'"},
      {"/usr/ball.mas",
       "unknown setting '/usr/ball.mas': /usr/ball (class Thing) has no property 'mas'. Did you mean 'mass'?"},
      {"/usr.mass",
       "unknown setting '/usr.mass': /usr (class Node) has no property 'mass'. Thing has a property of that name."}};
  for (const auto& [key, expected] : cases) {
    LuaHost h;
    scripts(h.kernel).addOverride(key, Value(1));
    CHECK_THAT(h.configFailure(config), Contains(expected));
  }
}

TEST_CASE("the error for a wrong value names the property and the expected range") {
  LuaHost h;
  scripts(h.kernel).addOverride("/usr/a.mass", Value(-1));
  CHECK_THAT(h.configFailure("new('Thing', '/usr/a')"),
             Equals("config.lua:1: cannot set /usr/a.mass\n  because: expected 0.0 to inf kg, found -1"));
  CHECK_THAT(LuaHost::errorOf([&] { scripts(h.kernel).addOverride("/usr/a", Value(1)); }),
             Contains("expected /path.property"));
}

TEST_CASE("log and print write to the kernel's log") {
  LuaHost h;
  h.kernel.log().setLevel(Level::debug);
  h.run("log.debug('d') log.info('i', 1, {}) log.warning('w') log.error('e') print('p', 2.5)");
  CHECK(h.text == "d\ni 1 table\nw\ne\np 2.5\n");
}
