// Events, attached scripts, and what happens when nodes are deleted.
#include "lua_fixture.h"
#include "spark/script_server.h"

using namespace spark;
using namespace spark::test;
using Catch::Contains;
using Catch::Equals;

namespace {
/// Emits an event when it leaves the tree.
class Farewell : public Leaf {
  SPARK_CLASS(Farewell, Leaf)
 public:
  static void describe(Description<Farewell>& d) { d.doc("Emits 'gone' when it leaves the tree."); }

 protected:
  void onUnlink() override { kernel().events().channel("gone").emit({"gone"}); }
};
}  // namespace

TEST_CASE("a handler gets its node and the event") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("get('/usr/a'):on('tick', function(self, e) seen = {self.path, e.name, e.time, e.step, e.cycle, e.data} end)");
  const Value data(List{1, "two"});
  h.kernel.events().channel("tick").emit({"tick", 1.5, 0.25, 7, &data});
  CHECK(h.run("return seen") == Value(List{"/usr/a", "tick", 1.5, 0.25, 7, data}));
}

TEST_CASE("on without a node listens at the root in configs and at self in attached scripts") {
  LuaHost h;
  h.run("on('tick', function(self) where = self.path end)");
  scripts(h.kernel).attachText(h.thing("/usr/a"),
                               "on('tock', function(node, e) node.label = e.name self.count = 9 end)", "script", true);
  h.emit("tick");
  h.emit("tock");
  CHECK(h.run("return where") == Value("/"));
  CHECK(h.run("return {get('/usr/a').label, get('/usr/a').count}") == Value(List{"tock", 9}));
}

TEST_CASE("a removed subscription stays removed, and removing it again does nothing") {
  LuaHost h;
  h.run("n = 0; s = on('tick', function() n = n + 1 end)");
  h.emit("tick");
  h.run("s:remove()");
  h.emit("tick");
  h.run("other = on('tick', function() n = n + 10 end); s:remove()");
  h.emit("tick");
  CHECK(h.run("return n") == Value(11));
}

TEST_CASE("a handler may remove itself and delete its node while it runs") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("n = 0; local s; s = on('tick', function() s:remove() n = n + 1 end)");
  h.run("get('/usr/a'):on('tick', function(self) self:delete() n = n + 10 end)");
  h.emit("tick");
  h.emit("tick");
  CHECK(h.run("return {n, get('/usr/a') == nil}") == Value(List{11, true}));
  CHECK(h.text == "");
}

TEST_CASE("subscriptions are removed with their node") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("n = 0; s = get('/usr/a'):on('tick', function() n = n + 1 end)");
  h.run("delete('/usr/a')");
  h.emit("tick");
  CHECK(h.run("s:remove() return n") == Value(0));
  CHECK(h.kernel.events().channel("tick").empty());
}

TEST_CASE("handlers that an attached script adds to other nodes are removed with the script's node") {
  LuaHost h;
  Thing& b = h.thing("/usr/b");
  scripts(h.kernel).attachText(h.thing("/usr/a"), "get('/usr/b'):on('tick', function(b) b.count = b.count + 1 end)",
                               "script", true);
  h.emit("tick");
  CHECK(b.count == 1);
  h.run("delete('/usr/a')");
  h.emit("tick");
  h.emit("tick");
  CHECK(b.count == 1);
  CHECK(h.kernel.events().channel("tick").empty());
}

TEST_CASE("a script file that is attached to a node runs at once in its own environment") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  Thing& b = h.thing("/usr/b");
  h.write("mark.lua", "counter = (counter or 0) + 1; self.count = counter; string.mine = true");
  scripts(h.kernel).attach(a, "mark.lua");
  h.run("get('/usr/b'):attach('mark.lua')");
  CHECK(a.count == 1);
  CHECK(b.count == 1);
  CHECK(h.run("return {counter, self, string.mine}") == Value(List{}));
  CHECK_THAT(h.failure("get('/usr/b'):attach('marc.lua')"),
             Contains("test:1: there is no script 'marc.lua'") && Contains("Did you mean 'mark.lua'?"));
}

TEST_CASE("get in an attached script resolves paths from the script's node") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  h.thing("/usr/b").label = "neighbour";
  scripts(h.kernel).attachText(a, "self.label = get('../b').label", "script", true);
  CHECK(a.label == "neighbour");
}

TEST_CASE("a script that fails while it is attached leaves no handlers") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  const std::string text = LuaHost::errorOf([&] {
    scripts(h.kernel).attachText(a, "on('tick', function() self.count = 1 end)\nerror('no')", "script", true);
  });
  CHECK_THAT(text, Equals("the script attached to /usr/a failed: script:2: no"));
  h.emit("tick");
  CHECK(a.count == 0);
}

TEST_CASE("an error in a handler is logged once for each line of code, and the handler stays") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("n = 0\nget('/usr/a'):on('tick', function(self)\n  n = n + 1\n  local none\n  none.x = 1\nend)");
  for (int i = 0; i < 3; ++i) CHECK_NOTHROW(h.emit("tick"));
  CHECK(h.run("return n") == Value(3));
  CHECK_THAT(h.text, Equals("handler of 'tick' at /usr/a failed: test:5: attempt to index a nil value (local 'none')\n"
                            "  It stays; further errors of this line are not logged.\n"));
}

TEST_CASE("an error in a handler is logged with a traceback of the calls") {
  LuaHost h;
  h.run(
      "local function deep()\n  error('boom')\nend\nlocal function top()\n  deep()\nend\non('tick', function()\n  "
      "top()\nend)");
  h.emit("tick");
  CHECK_THAT(h.text, Contains("test:2: boom\n  from test:5 in 'top'\n  from test:8\n"));
}

TEST_CASE("an endless loop in a handler becomes an error that names script, line and node") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("get('/usr/a'):on('tick', function(self)\n  while true do end\nend)");
  h.emit("tick");
  CHECK_THAT(h.text, Contains("handler of 'tick' at /usr/a failed: test:2: stopped after 50000000 instructions: is "
                              "there an endless loop?"));
}

TEST_CASE("each handler that uses up its budget is switched off and logged") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  h.run(
      "n = 0\nfor i = 1, 2 do\n  get('/usr/a'):on('tick', function(self)\n    self.count = self.count + 1\n    while "
      "true do end\n  end)\nend");
  h.run("get('/usr/a'):on('tick', function(self) n = n + 1 end)");
  for (int i = 0; i < 3; ++i) h.emit("tick");
  CHECK(a.count == 2);
  CHECK(h.run("return n") == Value(3));
  const std::string line =
      "handler of 'tick' at /usr/a failed: test:5: stopped after 50000000 instructions: is there an endless loop?\n"
      "  It is switched off: it would take as long every time.\n";
  CHECK_THAT(h.text, Equals(line + line));
}

TEST_CASE("a handler that is switched off fails each event that asks it for an answer, until it is removed") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  h.run("endless = get('/usr/a'):on('ask', function() while true do end end)");
  const auto faults = [&h, &a] {
    const std::int64_t before = h.kernel.faults();
    Value answers(List{});
    Event event{"ask"};
    event.answer = &answers;
    h.kernel.events().channel("ask").emitAt(a, event);
    CHECK(answers.toList().empty());
    return h.kernel.faults() - before;
  };
  CHECK(faults() == 1);
  CHECK(faults() == 1);
  const std::int64_t before = h.kernel.faults();
  h.emit("ask");  // wants no answer
  CHECK(h.kernel.faults() == before);
  h.run("endless:remove()");
  CHECK(faults() == 0);
}

TEST_CASE("a handler that calls itself without end is switched off and logged") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  h.run(
      "get('/usr/a'):on('tick', function(self)\n  self.count = self.count + 1\n  local function f() return 1 + f() "
      "end\n  f()\nend)");
  for (int i = 0; i < 3; ++i) h.emit("tick");
  CHECK(a.count == 1);
  CHECK_THAT(h.text, Contains("handler of 'tick' at /usr/a failed: test:3: stack overflow") &&
                         Contains("It is switched off: it would take as long every time."));
}

TEST_CASE("a long error of a handler is cut in the log, and its traceback is kept") {
  LuaHost h;
  h.thing("/usr/a");
  h.run(
      "get('/usr/a'):on('tick', function(self)\n  local function f() error(string.rep('y', 100000)) end\n  f()\nend)");
  h.emit("tick");
  CHECK(h.text.size() < 5000);
  CHECK_THAT(h.text, Contains("failed: test:2: yyyy") && Contains("yyyy ... (95912 bytes were cut)\n") &&
                         Contains("from test:3"));
}

TEST_CASE("functions that process much data at once are charged for it") {
  LuaHost h;
  h.run("long = ('a'):rep(1000000) many = {} for i = 1, 200000 do many[i] = i % 1000 end");
  for (const char* forever :
       {"string.find(long, '.-.-.-b')", "long:match('(a*)*(a*)(a*)(a*)b')", "long:gsub('.-.-.-b', '')",
        "for x in long:gmatch('a*a*a*b') do end", "while true do long:find(('a'):rep(10000) .. 'b', 1, true) end",
        "while true do s = ('x'):rep(100000000) end", "while true do s = long:upper() end",
        "while true do s = long .. long end", "while true do table.insert(many, 1, 0) end",
        "while true do table.sort(many) end", "while true do s = table.concat(many) end",
        "while true do table.remove(many, 1) many[200000] = 1 end", "while true do table.move(many, 1, 200000, 2) end",
        "while true do s = select('#', table.unpack(many)) end", "while true do next(many) end",
        "while true do for k in pairs(many) do break end end", "while true do utf8.len(long) end"}) {
    INFO(forever);
    h.text.clear();
    h.run(std::string("s = nil handler = on('work', function() ") + forever + " end)");
    h.emit("work");
    CHECK_THAT(h.text, Contains("stopped after 50000000 instructions"));
  }
}

TEST_CASE("many small searches are charged as much as a large one") {
  LuaHost h;
  for (const char* search :
       {"('aaaaaaaa'):find('.-.-b')", "('aaaaaaaa'):match('a*a*a*b')", "('aaaaaaaa'):gsub('.-.-b', '')"}) {
    INFO(search);
    h.run(std::string("n = 0 on('work', function() while true do n = n + 1 local x = ") + search + " end end)");
    h.emit("work");
    CHECK(h.run("return n").toInteger() < 1'000'000);  // each takes some 100 comparisons, and 5 instructions
    CHECK(h.run("return n").toInteger() > 10'000);
  }
}

TEST_CASE("an endless loop is stopped within pcall and coroutines too") {
  LuaHost h;
  h.run("on('tick', function() while true do pcall(function() while true do end end) end end)");
  h.run("on('tick', function() while true do coroutine.wrap(function() while true do end end)() end end)");
  h.run(
      "on('tick', function() while true do coroutine.resume(coroutine.create(function() while true do end end)) end "
      "end)");
  h.run("on('tick', function() after = true end)");
  h.emit("tick");
  CHECK(h.run("return after") == Value(true));
  h.text.clear();
  h.run("n = 0 on('tock', function() for i = 1, 100000 do n = n + 1 end end)");  // the next run has a full budget
  h.emit("tock");
  CHECK(h.run("return n") == Value(100000));
  CHECK(h.text == "");
}

TEST_CASE("an attached script that never ends is stopped") {
  LuaHost h;
  Thing& a = h.thing("/usr/a");
  CHECK_THAT(LuaHost::errorOf([&] { scripts(h.kernel).attachText(a, "while true do end", "script", true); }),
             Contains("the script attached to /usr/a failed: script:1: stopped after"));
}

TEST_CASE("handlers may raise events, but only to a limited depth") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("get('/usr/a'):on('tick', function(self) self:raise('tock') end)");
  h.run("get('/usr/a'):on('tock', function(self) self.count = self.count + 1 end)");
  h.emit("tick");
  CHECK(h.run("return get('/usr/a').count") == Value(1));
  h.run("get('/usr/a'):on('loop', function(self) self:raise('loop') end)");
  CHECK_NOTHROW(h.emit("loop"));
  CHECK_THAT(h.text, Contains("scripts entered each other more than 16 deep: does a handler raise its own event?"));
}

TEST_CASE("a handler is charged for the handlers of the events that it raises, and for nothing else") {
  LuaHost h;
  h.thing("/usr/a");
  h.kernel.events().define("outer", Order::parentsFirst, "");
  h.kernel.events().define("inner", Order::parentsFirst, "");
  h.run(
      "inner, done = 0, 0\n"
      "get('/usr/a'):on('inner', function() for i = 1, work do end inner = inner + 1 end)\n"
      "get('/usr/a'):on('outer', function(a) for k = 1, 100 do a:raise('inner') for i = 1, 5000 do end end done = done "
      "+ 1 end)");
  h.run("work = 100");
  h.emit("outer");
  CHECK(h.run("return {inner, done}") == Value(List{100, 1}));
  h.run("work = 1000000");
  h.emit("outer");
  CHECK(h.run("return done") == Value(1));
  CHECK_THAT(h.text, Contains("stopped after 50000000 instructions"));
}

TEST_CASE("scripts end before nodes: events that nodes emit while the kernel is destroyed reach no script") {
  std::string text;
  {
    Kernel kernel;
    kernel.log().setSink([&](Level, std::string_view line) { text += line; });
    kernel.registerClass<Farewell>();
    kernel.create("Farewell", "/usr/first");
    kernel.create("Farewell", "/usr/second");
    scripts(kernel).run("held = get('/usr/second') on('gone', function() log.info('ran') end)", "test");
    scripts(kernel).attachText(*kernel.root().find("/usr/second"), "self:on('gone', function() error('no') end)",
                               "script", false);
    scripts(kernel).run("delete('/usr/first')", "test");
    CHECK_THAT(text, Contains("ran") && Contains("script:1: no"));
    text.clear();
  }
  CHECK(text == "");
}

TEST_CASE("a script that deletes the script server runs to its end, and later scripts use a new server") {
  LuaHost h;
  h.thing("/usr/a");
  h.run("get('/usr/a'):on('bell', function(a) delete('/sys/server/script') a.count = a.count + 1 end)");
  h.emit("bell");
  h.emit("bell");  // its handlers are gone
  CHECK(h.kernel.root().require<Thing>("/usr/a").count == 1);
  CHECK(!h.kernel.root().find<IScriptServer>());
  CHECK(h.run("delete('/sys/server/script') return 1 + 1") == Value(2));
  CHECK(h.run("return 3") == Value(3));
  h.write("last.lua", "delete('/sys/server/script')\nget('/usr/a').count = 9\n");
  scripts(h.kernel).addFolder(h.folder);
  scripts(h.kernel).runConfig("last.lua");
  CHECK(h.kernel.root().require<Thing>("/usr/a").count == 9);
}
