-- The five types of the heterogeneous Nao, as its scene files read them: NaoType[0]['UseToe']. Booleans are texts
-- there.
local function naoType(t)
  return {
    Hip1RelTorso_X = t.hip or 0.055, Hip1RelTorso_Z = -0.115, ThighRelHip2_Z = t.thigh or -0.04, AnkleRelShank_Z = t.ankle or -0.055,
    lj5_max_abs_speed = t.speed5 or 6.1395, lj6_max_abs_speed = t.speed6 or 6.1395, ElbowRelUpperArm_Y = t.elbow or 0.07,
    UseToe = t.toe and "true" or "false", ToeLength = t.toe or 0,
  }
end

--- The variables Nao and NaoType; after scene().
function naoVariables()
  new("Variables", "/sys/variables/Nao"):set("UseTexture", "true")
  new("Variables", "/sys/variables/NaoType").value = {
    naoType {},
    naoType { thigh = -0.05832, ankle = -0.07332, elbow = 0.10664 },
    naoType { speed5 = 8.80667, speed6 = 3.47234 },
    naoType { hip = 0.072954143, thigh = -0.067868424, ankle = -0.082868424, elbow = 0.125736848 },
    naoType { toe = 0.035517656 },
  }
end
