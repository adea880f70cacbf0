-- What all soccer houses share: variables, rules, what monitors and trainers need.
--
--     soccerVariables{ FieldLength = 104, ... }   -- before the field is imported
--     soccerRules()                               -- after agents()
--     soccerMonitor()                             -- after monitors()

--- The variables Soccer.*, with other values where a league has them.
function soccerVariables(values)
  plugin "soccer"
  local soccer = new("SoccerSettings", "/sys/variables/Soccer")
  for name, value in pairs(values or {}) do soccer[name] = value end
  return soccer
end

--- Rules are control aspects below game control and run in this order. Offside is another one: new("OffsideAspect", ...).
function soccerRules()
  for _, class in ipairs { "GameStateAspect", "BallStateAspect", "SoccerRuleAspect" } do
    new(class, "/sys/server/gamecontrol/" .. class)
  end
end

--- What monitors are told of the match, and what trainers may do to it.
function soccerMonitor()
  for _, class in ipairs { "GameStateItem", "SoccerRuleItem", "TrainerCommandParser" } do
    new(class, "/sys/server/monitor/" .. class)
  end
end
