-- A failing handler is reported with its line and stays active, the others run on, and the faults are counted.
-- expect: has no property or method 'nosuch'
-- expect: this node is gone: it was /usr/scene/deleted
-- expect: expected 3 numbers, found a list of 2
-- expect: expected number, found string "here"
-- expect: has no property 'locolPos'. Did you mean 'localPos'
-- expect: handlers_that_fail.lua:28: no
-- expect: stack overflow
-- expect: still here in cycle 100
-- expect: "faults":7,
include "house.lua"
files() scene() simulation()
local function failing(name, f)
  new("Transform", "/usr/scene/" .. name):on("act", function(self, event)
    if event.cycle == 3 then f(self) end
  end)
end
failing("method", function(self) self:nosuch() end)
failing("deleted", function(self) self:delete() self.localPos = { 0, 0, 0 } end)
failing("short", function(self) self.localPos = { 0, 0 } end)
failing("text", function(self) self.localPos = "here" end)
failing("misspelt", function(self) self.locolPos = { 0, 0, 0 } end)
failing("thrower", function(self)
  local function deep(n)
    if n > 0 then deep(n - 1) end
    if n == 0 then
      -- five calls down
      error("no")
    end
  end
  deep(5)
end)
failing("endless", function() local function f() return 1 + f() end f() end)
on("rule", function(self, event)
  if event.cycle == 100 then print("still here in cycle 100") end
end)
