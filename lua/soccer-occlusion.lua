-- Soccer with eyes from which things can hide: players do not see what is behind a goal post, a robot or any other
-- collider, of a robot only the parts that nothing hides. The teams of the installed base see everything; see
-- soccer.lua for how a match is played.
--
--     sparkhost --config soccer-occlusion.lua --set "team=Red Blue" --set Soccer.AutomaticKickOff=true
league = { variables = { VisionOcclusion = true } }
include "soccer.lua"
