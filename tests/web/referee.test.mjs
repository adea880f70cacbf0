// The referee's console, which is only available with the token.
import assert from "node:assert/strict";
import { test } from "node:test";
import { part, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { startHost } from "./support/host.mjs";
import { shoot } from "./support/pictures.mjs";

const token = "whistle-of-the-tests";
/** No team plays, so the state that the referee sets does not change by itself. */
const ruled = ["--config", "soccer-sphere.lua", "--set", `webToken=${token}`, "--set", "Soccer.AutomaticKickOff=false"];

/** The host's answer to a request on a separate connection; runs in the page. */
function ask(request) {
  return new Promise((heard) => {
    const socket = new WebSocket(new URL("stream", location.href.replace(/^http/, "ws")));
    socket.onopen = () => socket.send(JSON.stringify({ ...request, id: 1 }));
    socket.onmessage = ({ data }) => {
      const message = typeof data === "string" ? JSON.parse(data) : {};
      if (message.type !== "answer") return;
      socket.close();
      heard(message);
    };
  });
}

test("without the token there is no console, and the host refuses commands", async (t) => {
  const host = await startHost(t, ...ruled);
  const page = await openPage(t, `${host.url}?panel=referee`);
  await until(page, "the match", (s) => s.connection === "open" && !s.referee);
  assert.equal(await part(page, "referee-console").isVisible(), false);
  await part(page, "token-field").fill("guess");
  await part(page, "token-submit").click();
  await page.locator('[data-testid="token-field"][aria-invalid="true"]').waitFor();
  await until(page, "that there are no referee rights", (s) => !s.referee);

  for (const request of [
    { do: "command", text: "(score 5 5)" },
    { do: "set", path: "/sys/server/gamecontrol/GameStateAspect", property: "score", value: "{5, 5}" },
    { do: "call", path: "/sys/server/gamecontrol/GameStateAspect", method: "setScores", arguments: [5, 5] },
  ]) {
    const answer = await page.evaluate(ask, request);
    assert.equal(answer.ok, false, request.do);
    assert.match(answer.error, /referee|token/i);
  }
  const later = await until(page, "that time advances", (s) => s.time > 1);
  assert.deepEqual(later.score, [0, 0]);
});

test("the referee's link allows kick-off, setting the score and moving the ball", async (t) => {
  const host = await startHost(t, ...ruled);
  const page = await openPage(t, `${host.url}?panel=referee#token=${token}`);
  await until(page, "the referee", (s) => s.referee);
  assert.ok(!page.url().includes(token), "the token is still in the URL");

  await part(page, "kickoff-left").click();
  await until(page, "the kick-off", (s) => s.playMode === "KickOff_Left");
  await part(page, "score-left-field").fill("2");
  await part(page, "score-right-field").fill("1");
  await part(page, "score-set").click();
  await until(page, "the score", (s) => s.score[0] === 2 && s.score[1] === 1);
  await part(page, "mode-select").selectOption("PlayOn");
  await part(page, "mode-set").click();
  await until(page, "that play is on", (s) => s.playMode === "PlayOn");
  await part(page, "ball-x").fill("20");
  await part(page, "ball-y").fill("10");
  await part(page, "ball-z").fill("0");
  await part(page, "ball-move").click();
  await until(page, "the ball at its new position", (s) => Math.hypot(s.ball[0] - 20, s.ball[1] - 10) < 0.5);
  await shoot(page, "referee");
});

test("the referee switches offside off and on in a running match", async (t) => {
  const host = await startHost(t, ...ruled);
  const page = await openPage(t, `${host.url}?panel=referee#token=${token}`);
  await until(page, "the referee", (s) => s.referee);
  const offside = part(page, "rule-OffsideAspect");
  await offside.waitFor();
  assert.equal(await offside.isChecked(), true);
  const enabled = async () => {
    const { properties } = await page.evaluate(ask, { do: "get", path: "/sys/server/gamecontrol/OffsideAspect" });
    return properties.find((p) => p.name === "enabled").value;
  };
  for (const on of [false, true]) {
    await offside.setChecked(on);
    await part(page, "referee-message").getByText(`Offside: ${on ? "on" : "off"}.`).waitFor();
    assert.equal(await enabled(), on);
  }
});

test("the referee reads the host's log, which spectators cannot", async (t) => {
  const host = await startHost(t, ...ruled, "--set", "logLines=50");
  const page = await openPage(t, `${host.url}?panel=host#token=${token}`);
  await part(page, "log-text").waitFor();
  assert.match(await part(page, "log-text").textContent(), /info +Web: http/);
  for (const request of [{ do: "make", path: "/usr/n", class: "Node" }, { do: "attach", path: "/usr", text: "return 1" }]) {
    const { ok, error } = await page.evaluate(ask, request);
    assert.equal(ok, false, request.do);
    assert.match(error, /only the owner of the host/);
  }

  const spectator = await openPage(t, `${host.url}?panel=host`);
  await until(spectator, "the match", (s) => s.connection === "open" && !s.referee);
  assert.equal(await part(spectator, "log").isVisible(), false);
  const answer = await spectator.evaluate(ask, { do: "call", path: "/sys/server/log/memory", method: "tail", arguments: [] });
  assert.equal(answer.ok, false);
  assert.match(answer.error, /referee|token/i);
});

test("entering the token opens the console", async (t) => {
  const host = await startHost(t, ...ruled);
  const page = await openPage(t, `${host.url}?panel=referee`);
  await part(page, "token-field").fill(token);
  await part(page, "token-submit").click();
  await until(page, "the referee", (s) => s.referee);
  await part(page, "referee-console").waitFor();
});
