-- The buggy of the paper on a course: it sees the walls by rays, steers, and drives laps.
--
--     sparkhost --config buggy.lua                                       the page shows it, with lap times
--     sparkhost --config buggy.lua --set drivers=0                       one place is free for an agent over TCP
--
-- The agent gets (LDR (n scan) (d ...)), distances [m] from 80 degrees to the right to 80 degrees to the left, and
-- sends (lb v)(rb v), speeds of the back wheels [deg/s], and (lf a)(rf a), angles of the front wheels [deg], positive
-- to the right; buggy-driver is one.
include "house.lua" include "materials.lua" include "course.lua"

local drivers = option{ name = "drivers", default = 1, choices = { 0, 1 }, doc = "Buggies driven from inside." }
local laps    = option{ name = "laps", default = 0, doc = "The race ends after as many laps; 0: it does not." }
local speed   = option{ name = "speed", default = 800.0, doc = "Of the driver on a free road, in deg/s of the wheels." }
local turn    = option{ name = "turn", default = 20.0, doc = "How much the driver steers to the freer side, in deg/m." }
local caution = option{ name = "caution", default = 0.5, doc = "How much the driver brakes before walls, 0 to 1." }

files() scene() materials() physics(engineOption()) simulation()
local agents = agents{}
agents.maxAgents = 1
monitors{} web() control() plugin "effectors" plugin "sensors"
local race = status{ playMode = "Race", lap = 0, way = 0, seconds = 0, best = 0 }
local a, b = course(12, 7, 4)                           -- half axes of its middle [m]

-- the rule: a lap is once round the middle, counter-clockwise, from the right
local rule = agents:new("ScriptAspect", "laps")
rule:on("agentConnected", function(self, event)
  local place = get(event.data)
  place.localPos = { a, 0, 0 }
  place:importScene("rsg/agent/buggy/buggy.rsg")
  state.car, state.angle, state.turned, state.began = place:find("buggy/chassis/body"), 0, 0, event.time
  race.lap, race.way, race.best = 0, 0, 0
end)
rule:on("agentLeaving", function() state.car = nil end)
rule:on("judge", function(self, event)
  if not state.car then return end
  local angle, time = math.atan(state.car.position[2] / b, state.car.position[1] / a), event.time - state.began
  state.turned = state.turned + (angle - state.angle + math.pi) % (2 * math.pi) - math.pi
  state.angle = angle
  race.way = state.turned / (2 * math.pi)               -- laps so far, with the part of the present one
  race.seconds = math.floor(10 * time) / 10
  if state.turned < 2 * math.pi * (race.lap + 1) then return end
  race.lap, state.began = race.lap + 1, event.time
  race.best = race.best == 0 and time or math.min(time, race.best)
  print(string.format("lap %d took %.2f s", race.lap, time))
  if race.lap == laps then get("/sys/server/simulation"):stop() end
end)

if drivers == 1 then
  new("ScriptBehavior", "/usr/agent/driver"):on("think", function(self, event)
    for _, percept in ipairs(event.data) do
      if percept[1] == "LDR" then
        local d = percept[3]                            -- { "d", right, ..., ahead, ..., left }
        local right, left = d[2] + d[3] + d[4] + d[5], d[10] + d[9] + d[8] + d[7]
        local angle = math.max(-40, math.min(40, turn * (right - left) / 4))
        local v = speed * (1 - caution * math.max(0, 1 - d[6] / 8))
        self.actions = string.format("(lb %.0f)(rb %.0f)(lf %.1f)(rf %.1f)", v, v, angle, angle)
      end
    end
  end)
end
