-- Materials and meshes that scenes name. The simulation does not use them: monitors pass the names on to viewers. An
-- unknown name causes a warning.
--
--     include "materials.lua"
--     materials()             -- after scene()

local colours = {
  matYellow = { 1, 1, 0, 1 },      matOrange = { 1, 0.03, 0, 1 },  matRed = { 1, 0, 0, 1 },        matRedGlow = { 1, 0, 0, 1 },
  matMagenta = { 1, 0, 0.75, 1 },  matBlue = { 0, 0, 1, 1 },       matLightBlue = { 0, 0.75, 1, 1 }, matGreen = { 0.1, 0.6, 0.1, 1 },
  matSelect = { 1, 0, 0, 0.5 },    matWhite = { 1, 1, 1, 1 },      matGrey = { 0.2, 0.2, 0.2, 1 }, matDarkGrey = { 0.05, 0.05, 0.05, 1 },
  matBall = { 1, 1, 1, 1 },        matTrack = { 0.6, 0.3, 0.2, 1 }, matGrass = { 0.1, 0.5, 0.1, 1 },
  matTeam = { 0.5, 0.5, 0.5, 1 },  matNum = { 0.9, 0.9, 0.9, 1 },  matLeft = { 0, 0.75, 1, 1 },    matRight = { 1, 0.1, 0.1, 1 },
}

-- The materials of the installed base's meshes, in the order in which monitors get them. The meshes themselves belong
-- to the viewers. If a file models/*.obj exists, it takes precedence.
local function declareMeshes(server)
  local function mesh(name, ...) server:defineMesh("models/" .. name .. ".obj", ...) end
  mesh("naosoccerfield", "None_rcs-naofield.png")
  mesh("soccerball", "soccerball_rcs-soccerball.png")
  mesh("leftsoccergoal", "naogoalnet", "yellow")
  mesh("rightsoccergoal", "naogoalnet", "sky-blue")
  mesh("skybox", "Material_skyrender_0001.tif", "Material_skyrender_0002.tif", "Material_skyrender_0003.tif", "Material_skyrender_0004.tif",
    "Material_skyrender_0005.tif", "Material_skyrender_0006.tif")
  mesh("naohead", "matTeam", "naoblack", "naogrey", "naowhite")
  mesh("rthigh", "matNum", "matTeam", "naowhite")
  for _, part in ipairs { "lthigh", "lfoot", "rfoot", "llowerarm", "rlowerarm" } do mesh(part, "matTeam", "naowhite") end
  -- Types 0 to 3 show their type on torso, upper arms and shanks, type 4 does not.
  for type = 0, 3 do
    mesh("naobody" .. type, "matNum", "matTeam", "matType" .. type, "naowhite")
    for _, part in ipairs { "lupperarm", "rupperarm", "lshank", "rshank" } do mesh(part .. type, "matTeam", "matType" .. type, "naowhite") end
  end
  mesh("naobody4", "matNum", "matTeam", "naowhite")
  for _, part in ipairs { "lupperarm4", "rupperarm4", "lshank4", "rshank4" } do mesh(part, "matTeam", "naowhite") end
end

-- Colours of the materials of these meshes, for cameras: their textures belong to the viewers, too.
local ofMeshes = {
  ["None_rcs-naofield.png"] = { 0.1, 0.5, 0.1 }, ["soccerball_rcs-soccerball.png"] = { 1, 1, 1 },
  naogoalnet = { 0.8, 0.8, 0.8 }, yellow = { 1, 1, 0 }, ["sky-blue"] = { 0, 0.75, 1 },
  naoblack = { 0.1, 0.1, 0.1 }, naogrey = { 0.5, 0.5, 0.5 }, naowhite = { 1, 1, 1 },
  matType0 = { 0.9, 0.9, 0.9 }, matType1 = { 0.9, 0.9, 0.9 },
  matType2 = { 0.9, 0.9, 0.9 }, matType3 = { 0.9, 0.9, 0.9 },
}

--- Defines those colours in the material server.
function meshColours(server)
  for name, c in pairs(ofMeshes) do server:define(name, c[1], c[2], c[3], 1) end
end

--- Material server, with the usual materials and the materials of the usual meshes.
function materials()
  local server = new("MaterialServer", "/sys/server/material")
  for name, c in pairs(colours) do server:define(name, c[1], c[2], c[3], c[4]) end
  for number = 1, 11 do
    server:define("matLeft" .. number, 0, 0.75, 1, 1)
    server:define("matRight" .. number, 1, 0.1, 0.1, 1)
    server:define("matNum" .. number, 0.9, 0.9, 0.9, 1)
  end
  declareMeshes(get("/sys/server/scene"))
  return server
end
