/// Sessions recorded with the original server, if they are available.
import { existsSync, readdirSync, readFileSync } from "node:fs";
import { describe, expect, test } from "vitest";
import { openReplay, type Replay } from "../../src/sources";

const reference = process.env.SPARK_REFERENCE_DIR ?? "";
const captures = `${reference}/captures`;
if (reference && !existsSync(captures)) throw new Error(`SPARK_REFERENCE_DIR is '${reference}', where there is no folder captures/.`);
const builds = ["mainline", "spl"].filter((name) => existsSync(`${captures}/${name}`));
const sessions = builds.flatMap((build) => readdirSync(`${captures}/${build}`).filter((f) => f.endsWith(".jsonl")).map((f) => `${build}/${f}`));

function messages(session: string): string[] {
  const lines = readFileSync(`${captures}/${session}`, "utf8").split("\n").filter(Boolean);
  return lines.map((line) => JSON.parse(line) as { dir: string; msg: string }).filter((m) => m.dir === "server>monitor").map((m) => m.msg);
}

async function at(replay: Replay, time: number): Promise<Replay> {
  replay.seek(time);
  await replay.settled();
  return replay;
}

describe.skipIf(sessions.length === 0)("a recorded monitor session of the original server", () => {
  test.each(sessions)("%s plays as a log", async (session) => {
    const sent = messages(session);
    const replay = await openReplay(new Blob([sent.join("\n")]), session);
    let robots = 0;
    for (let k = 0; k < 20; ++k) {
      await at(replay, replay.start + ((replay.end - replay.start) * k) / 19);
      robots = Math.max(robots, replay.world.robots.length);
      expect(replay.world.ball).toBeGreaterThan(0);
      expect(replay.world.local.every(Number.isFinite)).toBe(true);
    }
    expect(replay.damaged).toBe(0);
    // Every agent that loaded a robot is visible, including one that was killed at the end.
    expect(robots).toBe(session.includes("four-agents") ? 4 : 1);
    for (const robot of replay.world.robots) {
      expect(replay.world.nodes[robot.torso]!.shapes).toEqual([expect.objectContaining({ kind: "box" })]);
      expect(replay.world.nodes[robot.head]!.shapes).toEqual([expect.objectContaining({ kind: "sphere" })]);
    }
  });
});
