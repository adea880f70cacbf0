-- The offside rule can be disabled and enabled in a running match, and removed.
-- expect: enabled false, then true
-- expect: every aspect can be switched off
-- expect: "cycles":100,
-- args: --rate max --duration 2 --agent-port 0 --monitor-port 0 --set web=false
include "soccer-sphere.lua"
on("act", function(self, event)
  local control = get("/sys/server/gamecontrol")
  if event.cycle == 20 then
    local offside = control:find("OffsideAspect") or control:new("OffsideAspect", "OffsideAspect")
    offside.enabled = false
    local off = offside.enabled
    offside.enabled = true
    print("enabled " .. tostring(off) .. ", then " .. tostring(offside.enabled))
  end
  if event.cycle ~= 30 then return end
  for _, aspect in ipairs(control:children()) do
    if aspect.class:find("Aspect$") then aspect.enabled = false end
  end
  print("every aspect can be switched off")
end)
