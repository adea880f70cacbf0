-- Plays a recorded game to all monitors that connect, and to the page: a monitor log, or what --record wrote.
--
--     sparkhost --config logplayer.lua --set file=game.log
--
-- Monitors may send (p) pause, (f) and (b) one record forward or back, (l) the other direction, (speed 2), (record
-- 150), (time 30).
include "house.lua"

local file    = option{ name = "file", default = "sparkmonitor.log",
  doc = "The log: what --set monitorLog=... of a soccer config, or rcssserver3d, wrote; or a recording." }
local speed   = option{ name = "speed", default = 1.0,
  doc = "How fast it plays; 1: as it was recorded; -1: backwards." }
local from    = option{ name = "from", default = -1.0,
  doc = "Where it begins [s]; -1: at the beginning, backwards at the end." }
local wait    = option{ name = "wait", default = true, doc = "Begins when the first monitor is there." }
local encoder = option{ name = "monitor", default = "SexpMonitor", doc = "Class of the language that monitors hear." }

simulation()
local server = monitors{ encoder = encoder }
server.precision = 0                    -- the log already contains only what moved
local page = web()
control()
drawing()                               -- the log's drawings are shown on the page

plugin "parser-json"
local player = new("LogPlayer", "/sys/server/monitor/player")
new("JsonParser", "/sys/server/monitor/player/parser").maxTokens = 262144   -- for logs that JsonMonitor wrote
plugin "recorder"
player:new("RecordedMatch", "recording")                                    -- for recordings
player.speed, player.backward, player.waitForMonitor = math.abs(speed), speed < 0, wait
player.file = file
if from >= 0 then player.time = from elseif speed < 0 then player.record = player.records end
-- Viewers in browsers are not monitors of the server, so the first one must also start the game.
if page then page:on("act", function(self) if self.viewers > 0 then player.waitForMonitor = false end end) end
