-- The rule of the shot clock: a side that has the ball for longer than `seconds` loses it, by a free kick for the other one.
--
--     shotClock(get("/sys/server/gamecontrol"))                        -- in a match
--     shotClock(get("/usr/match/sys/server/gamecontrol"))              -- in another host, which has mounted it: referee.lua
--
-- It is the same in both places, because all that it remembers is in a group of variables of the match.
function shotClock(control, seconds)
  seconds = seconds or 5
  local game, ball, clock = control:find("GameStateAspect"), control:find("BallStateAspect"), control:find("../../variables/ShotClock")
  control:on("rule", function(_, event)
    local side = game.playMode == "PlayOn" and ball.lastTeam or "none"
    if side ~= clock:get("side") then
      clock:set("side", side)
      clock:set("since", event.time)
    elseif side ~= "none" and event.time - clock:get("since") >= seconds then
      game.playMode = side == "left" and "free_kick_right" or "free_kick_left"
      print(string.format("shot clock: %s had the ball for %g s", side, seconds))
    end
  end)
end
