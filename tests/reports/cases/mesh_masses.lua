-- row: 10
-- input: bodies with the masses of a pyramid and of a gable that is not convex, given by density and by mass
-- right: those of MuJoCo 2.2.2, which takes the volume of the box with the inertia of the mesh
-- args: --duration 0.1
include "../lib/judge.lua"
include "../lib/mesh.lua"
meshWorld()
get("/usr/scene"):importScene("mesh_masses.xml")
local function body(name) return get("/usr/scene/masses/" .. name .. "/body") end
near("mass of the pyramid", body("a").mass, 48.29907014, 1e-4)
near("mass of the gable", body("b").mass, 23.99933047, 1e-4)
near("mass of the gable that says it", body("c").mass, 3, 1e-9)
near("x of the gable's centre", body("b").position[1], 2.15756688, 1e-6)
near("y of the gable's centre", body("b").position[2], 0.10905345, 1e-6)
