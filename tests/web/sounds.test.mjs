// The sounds of a scene are played when the user wants them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { part, state, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { startHostIn, temporaryFolder } from "./support/host.mjs";

// A ball is lifted once a second, and falls.
const config = `
include "house.lua"
files() scene() physics() simulation() agents{} monitors{} web()
soundServer()
new("PlaneCollider", "/usr/scene/ground"):new("ContactJointHandler", "contact")
local ball = new("Transform", "/usr/scene/ball")
ball:new("Sphere", "look").radius = 0.1
ball:new("RigidBody", "body"):setSphere(500, 0.1)
local shape = ball:new("SphereCollider", "geometry")
shape.radius = 0.1
shape:new("ContactJointHandler", "contact")
shape:new("SoundHandler", "sound").sound = "ball"
local lift = 0
ball:on("prepare", function(self, event)
  if event.time < lift then return end
  lift = event.time + 1
  self.localPos = { 0, 0, 1 }
end)
`;

test("sounds are played while they are on, live and from the past, and the choice is kept", async (t) => {
  const folder = temporaryFolder(t);
  writeFileSync(join(folder, "falling.lua"), config);
  const host = await startHostIn(folder, t, "--config", "falling.lua");
  const page = await openPage(t, `${host.url}?panel=none`);
  const pressed = () => part(page, "sound").getAttribute("aria-pressed");
  const pass = async (seconds) => {
    const { time } = await state(page);
    return until(page, `${seconds} s more`, (s, end) => s.time > end, time + seconds);
  };
  await until(page, "the match", (s) => s.time > 0);
  assert.equal((await pass(3)).sounds, 0, "sounds are off at first");
  assert.equal(await pressed(), "false");

  await part(page, "sound").click();
  const loud = await until(page, "three sounds", (s) => s.sounds >= 3);
  assert.equal(loud.events, 0, "a sound is listed as an event");
  assert.equal(await part(page, "timeline-mark").count(), 0);
  await page.reload();
  await until(page, "a sound after loading again", (s) => s.sounds > 0);
  assert.equal(await pressed(), "true");

  // The past has them, too, while it is played.
  await page.keyboard.press("Home");
  await until(page, "the past", (s) => !s.following && s.time < s.end - 3);
  const then = await state(page);
  const played = (s, { sounds, time }) => !s.following && s.sounds > sounds && s.time > time;
  await until(page, "sounds of the past", played, then);
  await page.keyboard.press("Space");
  const { sounds, end } = await until(page, "the pause", (s) => !s.playing);
  assert.equal((await until(page, "that the match goes on", (s, end) => s.end > end + 3, end)).sounds, sounds);

  await part(page, "back-to-live").click();
  await page.keyboard.press("Shift+S");
  const quiet = await until(page, "the present", (s) => s.following);
  assert.equal(await pressed(), "false");
  assert.equal((await pass(3)).sounds, quiet.sounds, "sounds were played although they are off");
});
