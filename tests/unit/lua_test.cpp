// Nodes and values as a script sees them.
#include "lua_fixture.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Catch::Equals;

TEST_CASE("a script reads and writes properties and calls methods by name") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("local a = get('/usr/a'); a.mass = 2.5; a.count = 3; a.label = 'ball'");
  CHECK(h.run("return get('/usr/a').mass") == Value(2.5));
  CHECK(h.run("return get('/usr/a').count") == Value(3));
  CHECK(h.run("return get('/usr/a').label") == Value("ball"));
  CHECK(h.run("return get('/usr/a'):add(1, 2)") == Value(3.0));
  CHECK(h.run("return get('/usr/a'):getMass()") == Value(2.5));
  CHECK(h.run("get('/usr/a'):setMass(4) return get('/usr/a').mass") == Value(4.0));
}

TEST_CASE("every node has name, path, class, parent, alive, find and children") {
  LuaHost h;
  h.thing("/usr/a").create("Thing", "b");
  CHECK(h.run("return get('/usr/a/b').name") == Value("b"));
  CHECK(h.run("return get('/usr/a/b').path") == Value("/usr/a/b"));
  CHECK(h.run("return get('/usr/a/b').class") == Value("Thing"));
  CHECK(h.run("return get('/usr/a/b').parent.path") == Value("/usr/a"));
  CHECK(h.run("return get('/').parent") == Value());
  CHECK(h.run("return get('/usr/a').alive") == Value(true));
  CHECK(h.run("return get('/usr'):find('a/b').path") == Value("/usr/a/b"));
  CHECK(h.run("return get('/usr'):find('a/c')") == Value());
  CHECK(h.run("return get('/nowhere')") == Value());
  CHECK(h.run("local n = {} for i, c in ipairs(get('/usr/a'):children()) do n[i] = c.name end return n") ==
        Value(List{"b"}));
  CHECK(h.run("return tostring(get('/usr/a/b'))") == Value("/usr/a/b"));
}

TEST_CASE("children are reached by find only") {
  LuaHost h;
  h.thing("/usr/a").create("Thing", "b");
  CHECK_THAT(h.failure("return get('/usr/a').b"), Contains("has no property or method 'b'"));
}

namespace {
/// A class with two members that have the names of built-ins of every node.
class Coupling : public Node {
  SPARK_CLASS(Coupling, Node)
 public:
  static void describe(Description<Coupling>& d) {
    d.doc("Couples.");
    d.property("path", &Coupling::track).doc("Where it runs.");
    d.method("attach", &Coupling::attach).parameters({"first", "second"}).optional(1).doc("Couples two things.");
  }
  void attach(std::string first, std::string second) { coupled = first + "+" + second; }
  std::string track = "straight", coupled;
};
}  // namespace

TEST_CASE("a member of the class takes precedence over a built-in of the same name") {
  LuaHost h;
  h.kernel.registerClass<Coupling>();
  Coupling& c = h.kernel.create<Coupling>("Coupling", "/usr/c");
  h.thing("/usr/a");
  h.write("mark.lua", "on('tick', function() get('/usr/a').count = get('/usr/a').count + 1 end)");
  h.run("get('/usr/c'):attach('../a', '../b')");
  CHECK(c.coupled == "../a+../b");
  CHECK(h.run("return get('/usr/c').path") == Value("straight"));
  h.run("get('/usr/c').path = 'round'");
  CHECK(c.track == "round");
  CHECK(h.run("return {tostring(get('/usr/c')), get('/usr/c'):getFullPath(), get('/usr/c').name}") ==
        Value(List{"/usr/c", "/usr/c", "c"}));

  h.run(
      "get('/usr/c'):attachScript('mark.lua') get('/usr/a'):attachScript('mark.lua') get('/usr/a'):attach('mark.lua')");
  h.emit("tick");
  CHECK(h.kernel.root().find<Thing>("/usr/a")->count == 3);
  CHECK_THAT(h.failure("get('/usr/c'):attach('mark.lua')"),
             Equals("test:1: attach is a method of class Coupling itself: write node:attachScript(\"mark.lua\") to "
                    "attach a script to /usr/c"));
}

TEST_CASE("nodes tell if they are of a class or offer an interface") {
  LuaHost h;
  h.thing("/usr/a");
  CHECK(h.run("local a = get('/usr/a') return {a:isA('Thing'), a:isA('Node'), a:isA('Leaf'), a:isA('Group')}") ==
        Value(List{true, true, true, false}));
  CHECK(h.run("local s = get('/sys/server/script') return {s:isA('IScriptServer'), s:isA('ITelephone')}") ==
        Value(List{true, false}));
  CHECK_THAT(h.failure("get('/usr/a'):isA(3)"), Contains("expected the name of a class or interface (a string)"));
}

TEST_CASE("class objects tell bases, interfaces, properties and methods") {
  LuaHost h;
  h.run("thing, script = get('/classes/Thing'), get('/classes/ScriptServer')");
  CHECK(h.run("return {thing:isA('Thing'), thing:isA('Node'), thing:isA('Class'), script:isA('IScriptServer')}") ==
        Value(List{true, true, false, true}));
  CHECK(h.run("return script:interfaces()") == Value(List{"IScriptServer", "IScriptText"}));
  CHECK(h.run("return {thing.abstract, get('/classes/Node').abstract}") == Value(List{false, false}));
  h.run(
      "properties, methods = {}, {} "
      "for _, p in ipairs(thing:properties()) do properties[p.name] = p end "
      "for _, m in ipairs(thing:methods()) do methods[m.name] = m end");
  CHECK(h.run("local p = properties.mass return {p.type, p.unit, p.doc, p.min, p.readOnly, p.default}") ==
        Value(List{"number", "kg", "How heavy it is.", 0.0, false, 1.0}));
  CHECK(h.run("return {properties.fixed.readOnly, properties.mass.max == nil, properties.name.type}") ==
        Value(List{true, true, "string"}));
  CHECK(h.run("local m = methods.add return {m.doc, m.returns, m.parameters}") ==
        Value(List{"Adds.", "number", List{"a: number", "b: number"}}));
  CHECK(h.run("return {methods.setMass.parameters, #methods.raise.parameters, methods.raise.returns == nil}") ==
        Value(List{List{"mass: number [kg]"}, 1, true}));
}

TEST_CASE("a class object makes objects") {
  LuaHost h;
  CHECK(h.run("return get('/classes/Thing'):new('/usr/made/here').path") == Value("/usr/made/here"));
  CHECK(h.run("return get('/classes/Thing').living") == Value(1));
  CHECK_THAT(h.failure("get('/classes/Thing'):new()"), Contains("expected a path (a string), found no value"));
}

TEST_CASE("nodes are equal by identity and work as table keys") {
  LuaHost h;
  h.thing("/usr/a");
  h.thing("/usr/b");
  CHECK(h.run("return get('/usr/a') == get('/usr'):find('a')") == Value(true));
  CHECK(h.run("return get('/usr/a') == get('/usr/b')") == Value(false));
  CHECK(h.run("local t = {[get('/usr/a')] = 5} return t[get('/usr/a')]") == Value(5));
}

TEST_CASE("scripts make and delete nodes") {
  LuaHost h;
  CHECK(h.run("return new('Thing', '/usr/x/y').path") == Value("/usr/x/y"));
  CHECK(h.run("return get('/usr/x'):new('Thing', 'z').path") == Value("/usr/x/z"));
  CHECK(h.run("return get('/usr/x'):new('Thing').name") == Value("Thing"));
  h.run("get('/usr/x/z'):delete() delete('/usr/x/y') delete(get('/usr/x/Thing'))");
  CHECK(h.kernel.root().find<Node>("/usr/x")->children().empty());
}

TEST_CASE("the kernel's own nodes cannot be deleted") {
  LuaHost h;
  for (const char* path : {"/", "/classes", "/classes/Thing", "/plugins"})
    CHECK_THAT(h.failure(std::string("delete('") + path + "')"),
               Contains(std::string("cannot delete ") + path + ": it belongs to the kernel"));
}

TEST_CASE("the error for using a deleted node names its former path") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("a = get('/usr/a') a:delete()");
  CHECK(h.run("return a.alive") == Value(false));
  CHECK(h.run("return tostring(a)") == Value("dead node (was /usr/a)"));
  for (const char* use : {"a.mass = 1", "a:add(1, 2)", "return a.path", "return a:children()", "delete(a)"}) {
    INFO(use);
    CHECK_THAT(h.failure(use), Contains("test:1: this node is gone"));
  }
  CHECK_THAT(h.failure("return a.mass"), Equals("test:1: this node is gone: it was /usr/a and has been deleted. Ask "
                                                "node.alive before you use a node that may die."));
  h.thing("/usr/b");
  CHECK_THAT(h.failure("get('/usr/b').anything = a"), Contains("this node is gone"));
}

TEST_CASE("patterns match as described in the reference manual") {
  LuaHost h;
  const std::vector<std::pair<const char*, Value>> cases{
      {"{('hello world'):find('wor')}", List{7, 9}},
      {"{('hello'):find('l+')}", List{3, 4}},
      {"{('hello'):find('(l)(l)')}", List{3, 4, "l", "l"}},
      {"{('a.b'):find('.', 2, true)}", List{2, 2}},
      {"{('abc'):find('b', -1)}", List{}},
      {"{('abc'):find('', 10)}", List{}},
      {"{('abc'):find('', 4)}", List{4, 3}},
      {"{('abc'):find('c$')}", List{3, 3}},
      {"{('a$c'):find('$c')}", List{2, 3}},
      {"{('  x = 5 '):match('^%s*(%w+)%s*=%s*(.-)%s*$')}", List{"x", "5"}},
      {"{('key=val'):match('()=()')}", List{4, 5}},
      {"('THE (quick) fox'):find('%((%a+)%)')", 5},
      {"('f(a(b)c)d'):match('%b()')", "(a(b)c)"},
      {"('THE (quick) fox'):match('%f[%a]%a+', 5)", "quick"},
      {"('\"say \\'hi\\'\"'):match([[(['\"])(.-)%1]])", "\""},
      {"('x-y]z'):match('[%]%-]+')", "-"},
      {"('a]b'):match('[]]')", "]"},
      {"('a-z'):match('[a%-z]+')", "a-z"},
      {"('0xFf'):match('^0[xX](%x+)$')", "Ff"},
      {"('abc'):match('[^%a]')", Value()},
      {"('aaa'):match('a-')", ""},
      {"('aaab'):match('a-b')", "aaab"},
      {"('colour color'):gsub('colou?r', 'c')", "c c"},
      {"{('abc'):gsub('', '-')}", List{"-a-b-c-", 4}},
      {"{('hello world'):gsub('o', '0', 1)}", List{"hell0 world", 1}},
      {"('hello world'):gsub('(%w+) (%w+)', '%2 %1 %0 %%')", "world hello hello world %"},
      {"('$a $b'):gsub('%$(%w+)', {a = 'x'})", "x $b"},
      {"('abc'):gsub('%w', function(c) return c == 'b' and c:upper() end)", "aBc"},
      {"{('abc'):gsub('^a', 'x')}", List{"xbc", 1}},
      {"(function() local t = {} for k, v in ('a=1, b=2'):gmatch('(%w+)=(%w+)') do t[#t + 1] = k .. v end return t "
       "end)()",
       List{"a1", "b2"}},
      {"(function() local t = {} for w in ('one two'):gmatch('%a*') do t[#t + 1] = w end return t end)()",
       List{"one", "two"}},
      {"(function() local t = {} for w in ('^a^'):gmatch('^a') do t[#t + 1] = w end return t end)()", List{"^a"}},
      {"{('a\\0b'):find('%z')}", List{2, 2}},
  };
  for (const auto& [text, value] : cases) {
    INFO(text);
    CHECK(h.run(std::string("return (") + text + ")") == value);
  }
  CHECK_THAT(h.failure("('a'):find('%')"), Equals("test:1: malformed pattern (ends with '%')"));
  CHECK_THAT(h.failure("('a'):find('[a')"), Equals("test:1: malformed pattern (missing ']')"));
  CHECK_THAT(h.failure("('a'):find('%b')"), Equals("test:1: malformed pattern (missing arguments to '%b')"));
  CHECK_THAT(h.failure("('a'):find('%f')"), Equals("test:1: missing '[' after '%f' in pattern"));
  CHECK_THAT(h.failure("('a'):find('(a')"), Equals("test:1: unfinished capture"));
  CHECK_THAT(h.failure("('a'):match('a)')"), Equals("test:1: invalid pattern capture"));
  CHECK_THAT(h.failure("('a'):find('%1')"), Equals("test:1: invalid capture index %1"));
  CHECK_THAT(h.failure("('a'):gsub('a', '%2')"), Contains("test:1: invalid capture index %2"));
  CHECK_THAT(h.failure("('a'):gsub('a', '%x')"), Contains("test:1: invalid use of '%' in replacement string"));
  CHECK_THAT(h.failure("('a'):gsub('a', function() return {} end)"),
             Contains("test:1: invalid replacement value (a table)"));
  CHECK_THAT(h.failure("('a'):gsub('a')"),
             Contains("test:1: bad argument #2 to 'gsub' (string/function/table expected, got no value)"));
  CHECK_THAT(h.failure("('x'):rep(300):find(('x?'):rep(300) .. ('x'):rep(300))"), Contains("pattern too complex"));
}

TEST_CASE("values keep their type between Lua and C++") {
  LuaHost h;
  h.thing("/usr/a");
  const std::vector<std::pair<const char*, Value>> cases{{"nil", {}},
                                                         {"true", true},
                                                         {"3", 3},
                                                         {"3.0", 3.0},
                                                         {"0.1", 0.1},
                                                         {"'x\\0y'", std::string("x\0y", 3)},
                                                         {"9007199254740993", std::int64_t{9007199254740993}},
                                                         {"{}", List{}},
                                                         {"{1, 2.5, 'a', {true}}", List{1, 2.5, "a", List{true}}}};
  for (const auto& [text, value] : cases) {
    INFO(text);
    CHECK(h.run(std::string("return ") + text) == value);
    CHECK(h.run(std::string("return get('/usr/a'):echo(") + text + ")") == value);
  }
  CHECK(h.run("return math.type(get('/usr/a'):echo(3))") == Value("integer"));
  CHECK(h.run("return math.type(get('/usr/a'):echo(3.0))") == Value("float"));
}

TEST_CASE("a table that is not a sequence becomes a list of pairs sorted by key") {
  LuaHost h;
  CHECK(h.run("return {b = 1, a = 2, [3] = 'x', [1.5] = 'y'}") ==
        Value(List{List{1.5, "y"}, List{3, "x"}, List{"a", 2}, List{"b", 1}}));
  CHECK(h.run("return {1, nil, 3}") == Value(List{List{1, 1}, List{3, 3}}));
}

TEST_CASE("a node is converted to its path") {
  LuaHost h;
  h.thing("/usr/a");
  CHECK(h.run("return {get('/usr/a')}") == Value(List{"/usr/a"}));
}

TEST_CASE("functions and recursive tables are refused as values") {
  LuaHost h;
  h.thing("/usr/a");
  CHECK_THAT(h.failure("get('/usr/a').anything = print"),
             Equals("test:1: expected a value (nil, boolean, number, string, table or node), found a function"));
  CHECK_THAT(h.failure("local t = {} t[1] = t get('/usr/a').anything = t"),
             Contains("is nested more than 64 deep, or holds itself"));
}

TEST_CASE("the error for an unknown name suggests a similar name") {
  LuaHost h;
  h.thing("/usr/a");
  CHECK_THAT(h.failure("return get('/usr/a').mas"),
             Equals("test:1: /usr/a (class Thing) has no property or method 'mas'. Did you mean 'mass'?"));
  CHECK_THAT(h.failure("get('/usr/a'):ad(1, 2)"), Contains("has no property or method 'ad'. Did you mean 'add'"));
  CHECK_THAT(h.failure("get('/usr/a').lable = 'x'"),
             Equals("test:1: /usr/a (class Thing) has no property 'lable'. Did you mean 'label'?"));
  // a property of another class
  CHECK_THAT(h.failure("new('Node', '/usr/n').mass = 1"),
             Contains("has no property 'mass'.") && Contains("Thing has a property of that name."));
  CHECK_THAT(h.failure("get('/usr/a'):childen()"), Contains("Did you mean 'children'?"));
  CHECK_THAT(h.failure("new('Thin', '/usr/b')"), Contains("test:1: there is no class 'Thin'. Did you mean 'Thing'?"));
}

TEST_CASE("the error for a wrong value or argument says what was expected") {
  LuaHost h;
  h.thing("/usr/a");
  CHECK_THAT(h.failure("get('/usr/a').mass = -1"),
             Equals("test:1: cannot set /usr/a.mass\n  because: expected 0.0 to inf kg, found -1"));
  CHECK_THAT(h.failure("get('/usr/a').mass = {}"), Contains("cannot set /usr/a.mass"));
  CHECK_THAT(h.failure("get('/usr/a').fixed = 1"), Contains("/usr/a.fixed is read only"));
  CHECK_THAT(h.failure("get('/usr/a').path = 'x'"), Contains("cannot set /usr/a.path: it is read only"));
  CHECK_THAT(h.failure("get('/usr/a'):add(1)"), Contains("expected 2 arguments, found 1"));
  CHECK_THAT(h.failure("get('/usr/a').add(1, 2)"),
             Contains("expected a node before add, found number: write node:add(...), with a colon"));
  CHECK_THAT(h.failure("get('/usr/a'):on('tick', 5)"),
             Contains("expected a function(self, event) to handle 'tick', found number"));
  CHECK_THAT(h.failure("get(5)"), Contains("expected a path (a string), found number"));
}

TEST_CASE("the variables of a group are read and written like properties") {
  LuaHost h;
  h.kernel.create<Group>("Group", "/sys/variables/Nao").values["UseTexture"] = "true";
  CHECK(h.run("return Nao.UseTexture") == Value("true"));
  h.run("Nao.UseTexture = 'false' Nao.New = 5");
  CHECK(h.run("return {Nao.UseTexture, Nao.New}") == Value(List{"false", 5}));
  CHECK_THAT(h.failure("return Nao.UseTextur"), Contains("Did you mean 'UseTexture'?"));
  CHECK(h.run("return Unheard") == Value());
}

TEST_CASE("a script's error has file, line and a short traceback") {
  LuaHost h;
  CHECK_THAT(h.failure("local x = nil\nreturn x.y"), Equals("test:2: attempt to index a nil value (local 'x')"));
  CHECK_THAT(h.failure("function f()\n  error('boom')\nend\nlocal function g()\n  f()\nend\ng()"),
             Equals("test:2: boom\n  from test:5 in 'g'\n  from test:7"));
  CHECK_THAT(h.failure("x ="), Equals("test:1: unexpected symbol near <eof>"));
  CHECK_THAT(h.failure("error({})"), Equals("table\n  from test:1"));
}

TEST_CASE("an attached script gets arguments") {
  LuaHost host;
  host.thing("/usr/a");
  host.write("rule.lua",
             "local args, more = ...\nself.count = args and args.limit or -1\nself.label = tostring(args and "
             "args.who) .. tostring(more)\n"
             "if args and args.call then args.call(self) end");
  SECTION("from Lua unchanged: tables, nodes and functions") {
    host.run(
        "get('/usr/a'):attachScript('rule.lua', {limit = 3, who = get('/usr'), call = function(node) node.mass = 5 "
        "end}, 'x')");
    CHECK(host.kernel.root().require<Thing>("/usr/a").count == 3);
    CHECK(host.kernel.root().require<Thing>("/usr/a").label == "/usrx");
    CHECK(host.kernel.root().require<Thing>("/usr/a").mass == 5);
  }
  SECTION("none") {
    host.run("get('/usr/a'):attachScript('rule.lua')");
    CHECK(host.kernel.root().require<Thing>("/usr/a").count == -1);
    CHECK(host.kernel.root().require<Thing>("/usr/a").label == "nilnil");
  }
  SECTION("from C++, as values") {
    Thing& a = host.kernel.root().require<Thing>("/usr/a");
    scripts(host.kernel).attach(a, "rule.lua", List{List{"limit", 4}, List{"who", "me"}});
    CHECK(a.count == 4);
    CHECK(a.label == "menil");
    host.write("list.lua", "local args = ...\nself.count = #args  self.anything = args");
    scripts(host.kernel).attach(a, "list.lua", List{1, 2, List{3}});
    CHECK(a.count == 3);
    CHECK(a.anything == Value(List{1, 2, List{3}}));
  }
}

TEST_CASE("unload refuses a plugin that does not exist") {
  LuaHost host;
  CHECK_THAT(host.failure("unload 'nosuch'"),
             Catch::Contains("test:1: cannot unload plugin 'nosuch': there is none of that name"));
  CHECK_THAT(host.failure("unload(3)"), Catch::Contains("expected a plugin's name"));
}
