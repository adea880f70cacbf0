-- row: 14
-- input: modifiers that mean nothing for what is above them: a gain of a rotation, noise of names, of an unknown field
-- right: each is named
-- args: --duration 2
-- expect: /usr/scene/probe/agent/imu/gain (Gain) leaves the rotation that /usr/scene/probe/agent/imu senses as it is
-- expect: /usr/scene/probe/agent/touch/noise (WhiteNoise) has changed nothing so far
-- expect: have no number with decimals in a list 'speed'
include "house.lua"
files() scene() physics() simulation() agents{ port = 0 }
plugin "sensors" plugin "modifiers"
local probe = new("Transform", "/usr/scene/probe")
probe:new("RigidBody", "body")
local agent = probe:new("AgentAspect", "agent")
agent:new("OrientationPerceptor", "imu"):new("Gain", "gain").gain = 2
agent:new("TouchPerceptor", "touch"):new("WhiteNoise", "noise").sigma = 2
agent:new("GyroRatePerceptor", "gyro"):new("WhiteNoise", "noise").field = "speed"
agent:new("ScriptBehavior", "mind"):on("think", function() end)
