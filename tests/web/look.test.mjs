// What scenes say about their look: lights, materials, mesh files and textures.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { drawn, part, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { startHostIn, temporaryFolder } from "./support/host.mjs";
import { difference, encode, shoot } from "./support/pictures.mjs";

// A board with a texture, twice; a pyramid of STL without one; a box with a texture; a ball whose material the page
// does not know by itself; a mesh whose file is damaged. A lamp on the right.
const config = `
include "house.lua"
files() scene() physics() simulation() agents{} monitors{} web()
local server = new("MaterialServer", "/sys/server/material")
server:define("lime", 0.5, 1, 0, 1)
local wood = server:new("Material2DTexture", "wood")
wood.diffuseTexture = "textures/fields.png"
local function place(name, x, y, z)
  local node = new("Transform", "/usr/scene/" .. name)
  node.localPos = { x, y, z }
  return node
end
for i, x in ipairs { -3, 0 } do place("board" .. i, x, 0, 1.2):new("StaticMesh", "look"):load("models/board.obj") end
place("pyramid", 2.5, 0, 0):new("StaticMesh", "look"):load("models/pyramid.stl")
place("damaged", 4.5, 0, 0.5):new("StaticMesh", "look"):load("models/damaged.stl")
local box = place("box", 0, -2.5, 0.6):new("Box", "look")
box:setExtents(1.2, 1.2, 1.2)
box:setMaterial("wood")
local ball = place("ball", 2.5, -2.5, 0.6):new("Sphere", "look")
ball.radius = 0.6
ball:setMaterial("lime")
local lamp = place("lamp", 8, -6, 6):new("Light", "light")
lamp.diffuse, lamp.ambient = { 1, 1, 1, 1 }, { 0.2, 0.2, 0.2, 1 }
`;

const board = "mtllib board.mtl\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl fields\nf 1/1 2/2 3/3 4/4\n";
const fields = "newmtl fields\nKa 1 1 1\nKd 1 1 1\nmap_Kd fields.png\n";
const corners = ["-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0", "0 0 2"];
const facet = (face) => `facet normal 0 0 0\nouter loop\n${face.map((k) => `vertex ${corners[k]}\n`).join("")}endloop\nendfacet\n`;
const pyramid = `solid p\n${[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]].map(facet).join("")}endsolid p\n`;

/** Four fields: magenta above on the left, all others in one colour each. */
function picture() {
  const [magenta, white, blue, black] = [[255, 0, 255], [255, 255, 255], [0, 0, 255], [0, 0, 0]];
  const data = new Uint8Array(3 * 64 * 64);
  for (let i = 0; i < 64 * 64; i++) data.set([[magenta, white], [blue, black]][Math.floor(i / 2048)][Math.floor((i % 64) / 32)], 3 * i);
  return encode({ width: 64, height: 64, channels: 3, data });
}

/** The host's working folder, with its config and files. */
function yard(t) {
  const folder = temporaryFolder(t);
  const files = {
    "yard.lua": config, "models/board.obj": board, "materials/board.mtl": fields, "textures/fields.png": picture(),
    "models/pyramid.stl": pyramid, "models/damaged.stl": "no mesh",
  };
  for (const [name, content] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), content);
  }
  return folder;
}

/** The fraction of pixels of which `is` is true. */
function share({ channels, data }, is) {
  let found = 0;
  for (let i = 0; i < data.length; i += channels) if (is(data[i], data[i + 1], data[i + 2])) found++;
  return found / (data.length / channels);
}
const magenta = (r, g, b) => r > 90 && b > 90 && g < 0.3 * r && g < 0.3 * b;
const lime = (r, g, b) => g > 90 && b < 0.3 * g && r > 0.35 * g && r < 0.7 * g;

/** Runs in the page. */
function lookAtScene() {
  const { camera, eye } = window.spark.app.stage;
  camera.lookAt(eye.position.clone().set(0.5, -1, 0.8), 9);
}

test("a scene has its lights, materials, meshes and textures, in both lighting modes", async (t) => {
  const folder = yard(t);
  const host = await startHostIn(folder, t, "--config", "yard.lua", "--scene-path", folder);
  const page = await openPage(t, `${host.url}?view=orbit&quality=flat&panel=none`);
  await until(page, "two meshes and their texture", (s) => s.meshes === 2 && s.textures === 1);
  await until(page, "the scene's light", (s) => s.lights === "scene");
  await page.evaluate(lookAtScene);
  const keep = async (name) => {
    await drawn(page);
    const taken = await shoot(part(page, "stage"), name);
    assert.ok(share(taken, magenta) > 0.005, `${name}: no texture is seen`);
    assert.ok(share(taken, lime) > 0.002, `${name}: the host's material is not seen`);
    return taken;
  };
  const lit = await keep("look-scene-lights");
  await part(page, "lights").click();
  await until(page, "plain light", (s) => s.lights === "plain");
  const plain = await keep("look-plain-light");
  assert.ok(difference(lit, plain) > 0.01, "both lighting modes look the same");

  // The choice is kept, and the meshes come again from the browser's cache or the host.
  await page.reload();
  await until(page, "the choice and the meshes", (s) => s.lights === "plain" && s.meshes === 2 && s.textures === 1);
  await part(page, "lights").click();
  await part(page, "quality").click();
  await until(page, "lamps with shadows", (s) => s.lights === "scene" && s.quality === "quality");
  await page.evaluate(lookAtScene);
  await keep("look-scene-lights-quality");
  assert.ok(host.log.some((line) => line.includes("viewers do not show 'models/damaged.stl'")), host.log.join("\n"));
});
