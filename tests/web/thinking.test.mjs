// How long agents think in simulated time, in the host's panel.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { drawn, part, until, untilText } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { sphereMatch, startHost, startHostOfAgents, temporaryFolder } from "./support/host.mjs";
import { shoot } from "./support/pictures.mjs";
import { build } from "./support/places.mjs";

/**
 * Two teams of agents that the host starts. Each thought of the reds takes 3 steps of 10 ms, each of the blues 12: two in
 * 20 steps are too many, so they miss sensations after some seconds.
 */
function oldMatch(t) {
  const type = (name, team, timer) => `<agent_type_external name="${name}"><timer>${timer}</timer><working_dir>${join(build, "bin")}</working_dir><exec_line>spades-agent ${team}</exec_line></agent_type_external>`;
  const database = join(temporaryFolder(t), "agentdb.xml");
  writeFileSync(database, `<agentdb>${type("red", "Red", "fixed 3")}${type("blue", "Blue", "fixed 12")}</agentdb>`);
  return ["--config", "soccer-2004.lua", "--set", `agentDatabase=${database}`, "--set", "agents=red blue", "--seed", "3"];
}

/** The texts of the table's rows, by cell. */
async function rows(page) {
  const all = [];
  for (const row of await part(page, "latency-row").all()) all.push(await row.locator("td").evaluateAll((cells) => cells.map((cell) => [...cell.children].map((line) => line.textContent).join(" ").trim())));
  return all;
}

const heads = (page) => part(page, "latency-table").locator("th").allTextContents();

test("the panel has think times, latencies and missed sensations of agents in simulated time", async (t) => {
  const host = await startHostOfAgents(t, ...oldMatch(t));
  const page = await openPage(t, `${host.url}?panel=host`);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  await untilText(page, "latency-table", (text) => text.includes("Blue 11") && !text.includes("No team") && !text.includes("–"));
  await until(page, "that a blue agent missed something", () => Number(document.querySelector('[data-testid="latency-row"]:last-child td:last-child').textContent) > 0);
  assert.deepEqual(await heads(page), ["Agent", "Thought", "Mean", "Sense", "Act", "Missed"]);
  const shown = await rows(page);
  assert.equal(shown.length, 22);
  for (const [name, ...cells] of shown) {
    const isRed = name.startsWith("Red"), thought = isRed ? "3 30 ms" : "12 120 ms";
    const missed = cells.pop();
    assert.deepEqual(cells, [thought, thought, "10 100 ms", "10 100 ms"], name);
    assert.match(missed, isRed ? /^0$/ : /^\d+$/, name);
  }
  await drawn(page);
  await shoot(page, "thinking");
});

test("other agents have the time of their answers alone", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, `${host.url}?panel=host`);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  await part(page, "latency-row").first().waitFor();
  assert.deepEqual(await heads(page), ["Agent", "Answers after"]);
});
