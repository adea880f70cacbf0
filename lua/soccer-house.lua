-- The common part of all soccer configs: variables, rules, monitor items and trainer commands.
--
--     soccerVariables{ FieldLength = 104, ... }   -- before the field is imported
--     soccerRules()                               -- after agents()
--     soccerFouls()                               -- after soccerRules(): the automatic referee of humanoids
--     soccerMonitor()                             -- after monitors()
--     soccerTeams("sphere-team", "SphereBehavior", "Red Blue", 11)   -- teams that play inside the host
--     soccerCompat("F")                           -- last: percepts of another version of the installed base

--- The variables Soccer.*, with the values of a league.
function soccerVariables(values)
  plugin "soccer"
  local soccer = new("SoccerSettings", "/sys/variables/Soccer")
  for name, value in pairs(values or {}) do soccer[name] = value end
  soccer.Cheats = option{ name = "cheats", default = soccer.Cheats, doc = "For training: robots see the truth, too, their own position and heading and the ball's position." }
  return soccer
end

--- Rules are control aspects below game control and run in this order; the referee creates the rules of play below
--- itself. `rules` sets their properties, or disables a rule: soccerRules{ PassModeRule = false, GoalRule = { enabled =
--- true } }. Offside is another aspect: new("OffsideAspect", ...). TeamlessAspect: until robots have a team, they
--- collide with static colliders only, because all are created at the same position.
function soccerRules(rules)
  for _, class in ipairs { "TeamlessAspect", "GameStateAspect", "BallStateAspect", "SoccerRuleAspect" } do
    new(class, "/sys/server/gamecontrol/" .. class)
  end
  for name, values in pairs(rules or {}) do
    local path = "/sys/server/gamecontrol/SoccerRuleAspect/" .. name
    local rule = get(path) or error("soccerRules: there is no rule " .. path)
    if values == false then values = { enabled = false } end
    for property, value in pairs(values) do rule[property] = value end
  end
end

--- The automatic referee of humanoids: each foul is a control aspect of its own, judged in this order after the rules
--- of play. Remove one, or disable it by --set /sys/server/gamecontrol/ChargingFoulAspect.enabled=false.
function soccerFouls()
  for _, class in ipairs { "PlayerContactAspect", "IncapableFoulAspect", "CrowdingFoulAspect", "IllegalDefenceAspect", "TouchingFoulAspect",
                           "ChargingFoulAspect", "BallHoldingAspect", "SelfCollisionAspect", "PenaltyAspect" } do
    new(class, "/sys/server/gamecontrol/" .. class)
  end
end

--- Monitor items and trainer commands of the match, and its log if requested.
function soccerMonitor()
  for _, class in ipairs { "GameStateItem", "SoccerRuleItem", "TrainerCommandParser" } do
    new(class, "/sys/server/monitor/" .. class)
  end
  local file = option{ name = "monitorLog", default = "", doc = "File into which the match is logged for monitors; logplayer.lua plays it." }
  if file ~= "" then new("MonitorLog", "/sys/server/monitor/log").file = file end
end

--- Players inside the host: objects of `class` from the plugin `from` for each team named in `teams` ("Red Blue"; "":
--- none), numbered from 1.
function soccerTeams(from, class, teams, players)
  for team in teams:gmatch("%S+") do
    plugin(from)
    for number = 1, players do
      local player = new(class, "/usr/agent/" .. team .. number)
      player.team, player.unum = team, number
    end
  end
end

-- Differences between versions of the installed base, by the node that has the property. All other defaults are those
-- of M, the mainline server 0.7.3.
local versions = {
  M = {
    ["/sys/server/gamecontrol/timing"] = { agentStep = 0.02 },
  },
  -- the SPL's server
  F = {
    ["/sys/server/gamecontrol/parser"] = { decimals = 3 },
    ["/sys/server/gamecontrol"]        = { sync = true },
    ["/sys/server/gamecontrol/timing"] = { agentStep = 0.01 },
    ["/sys/variables/Soccer"]          = {
      ExtraGameState = true, FieldLinesSeen = false, BeamWithinFieldWidth = false, PenaltyWidthBeyondGoal = false, ConstantTemperature = false,
    },
  },
  -- later servers of the 3D league, as far as their clients show it
  L = {
    ["/sys/server/gamecontrol/timing"] = { agentStep = 0.02 },
    ["/sys/variables/Soccer"] = { VisionInterval = 2, UseBallHolding = true },
  },
}

--- Sets the properties in which a version (M, F or L) differs. Each may also be set individually; values given by --set
--- take precedence.
function soccerCompat(version)
  for path, values in pairs(versions[version]) do
    local node = get(path)
    for name, value in pairs(values) do
      -- Other languages have their own number format.
      if name ~= "decimals" or node.class == "SexpParser" then node[name] = value end
    end
  end
end

--- The option for the version; a config passes it to soccerCompat().
function compatOption(default)
  return option{ name = "compat", default = default or "M", choices = { "M", "F", "L" },
                 doc = "Version of the installed base: M mainline 0.7.3, F the SPL's, L later than 0.7.3." }
end
