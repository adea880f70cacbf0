-- row: 16
-- input: a ball leaves the field near a corner, or near a post, at up to 40 m/s: past which line, or between the posts?
-- right: the line that the whole ball crossed first decides; a goal only between the posts and below the bar
-- args: --agent-port 0 --monitor-port 0 --web-port 0 --duration 60
include "soccer-sphere.lua"
include "../lib/judge.lua"
include "../lib/soccer.lua"

-- Half of the field, and of the goal [m]; a ball is out, or a goal, when its centre is its radius beyond the line.
local length, width, goal, r = 52, 34, 3.66, 0.111
local shots = {}
local function shot(name, right, x, y, z, vx, vy) shots[#shots + 1] = { name, right, x, y, z, vx, vy } end

-- The last toucher is of the left team: over a touch line the right team kicks in, over its goal line it has a goal
-- kick; over the left goal line the right team has a corner.
local kickIn, goalKick, corner = "KickIn_Right", "goal_kick_right", "corner_kick_right"
for _, sx in ipairs { 1, -1 } do
  local line = sx > 0 and goalKick or corner
  for _, sy in ipairs { 1, -1 } do
    -- 20 cm before one line, and by `gap` farther from the other one: it is over both within a cycle
    for _, gap in ipairs { 0.02, 0.15, 0.3 } do
      shot("touch line first by " .. gap, kickIn,
           sx * (length + r - 0.2 - gap), sy * (width + r - 0.2), r, sx * 28, sy * 28)
      shot("goal line first by " .. gap, line,
           sx * (length + r - 0.2), sy * (width + r - 0.2 - gap), r, sx * 28, sy * 28)
    end
    shot("along the goal line", kickIn, sx * (length + 0.07), sy * (width - 0.3), r, 0, sy * 8)
    shot("along the touch line", line, sx * (length - 0.3), sy * (width + 0.07), r, sx * 8, 0)
  end
end
shot("beside the post, then behind the mouth", goalKick, length - 0.2, goal + 0.25, 0.25, 35, -12)
shot("between the posts, close to one", "Goal_Left", length - 0.2, goal - 0.2, 0.25, 35, 0)
shot("above the bar", goalKick, length - 0.1, 1, 0.9, 35, 0)

local game = get "/sys/server/gamecontrol/GameStateAspect"
local red = player { name = "red", team = "Red", unum = 1 }
player { name = "blue", team = "Blue", unum = 1 }

local now, bad, seen = 0, 0, {}
local period, shoots, judges = 20, 8, 12          -- cycles
on("prepare", function(self, event)
  local ball, toucher, other = body "/usr/scene/Ball", robot(1), robot(2)
  if event.cycle < 60 or not (ball and toucher and other) then return end
  local phase = event.cycle % period
  if phase == 0 then
    now = now + 1
    if now > #shots then
      local what = bad .. " of " .. #shots .. " shots: " .. table.concat(seen, "; ")
      judge(bad == 0 and "all " .. #shots .. " shots" or what, bad == 0)
      get("/sys/server/simulation"):stop()
      return
    end
  end
  if phase < shoots then                           -- red touches the ball in the middle of the field
    game.playMode = "PlayOn"
    place(other, -40, 20)
    place(toucher, -0.3, 0)
    if phase % 4 == 0 then place(ball, 0, 0, r) end
  elseif phase == shoots then
    local s = shots[now]
    place(toucher, -20, 0)
    game.playMode = "PlayOn"
    place(ball, s[3], s[4], s[5])
    ball.velocity = { s[6], s[7], 0 }
  elseif phase == judges then
    local s = shots[now]
    if game.playMode ~= s[2] then
      bad = bad + 1
      seen[#seen + 1] = s[1] .. ": " .. game.playMode .. ", right is " .. s[2]
    end
  end
end)
