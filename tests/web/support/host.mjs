// A running sparkhost on free ports, started the way users start it.
import { execFile, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { promisify } from "node:util";
import { closePages, patience } from "./browser.mjs";
import { build } from "./places.mjs";

const program = (name) => join(build, "bin", name);

/** Two teams that play inside the host in lockstep, so every run gives the same match. */
export const sphereMatch = ["--sync", "--config", "soccer-sphere.lua", "--set", "team=Red Blue"];
export const humanoidMatch = ["--sync", "--config", "soccer.lua", "--set", "team=Red Blue", "--set", "Soccer.AutomaticKickOff=true", "--set", "Soccer.WaitBeforeKickOff=2"];
/** With this seed the first goal of the sphere match comes after about 14 s. */
export const goalSeed = ["--seed", "26"];

/** The host does not disconnect a browser that is slow. */
const patient = ["--set", "/sys/server/web.requestTimeout=3600", "--set", "/sys/server/web.stallTimeout=3600"];

/** Creates a folder that is removed after the test. */
export function temporaryFolder(t) {
  const folder = mkdtempSync(join(tmpdir(), "spark-web-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

/**
 * Starts a host that ends with the test. `url` is the link for spectators, `refereeUrl` the one with the token; `halt`
 * stops its process, so that the page keeps its last frame.
 */
export async function startHost(t, ...options) {
  return startHostIn(undefined, t, ...options);
}

/** The same in another working folder. */
export async function startHostIn(cwd, t, ...options) {
  return start(cwd, t, ...options, "--agent-port", "0");
}

/** A host that starts its agents itself, and has no port for others. */
export async function startHostOfAgents(t, ...options) {
  return start(undefined, t, ...options);
}

async function start(cwd, t, ...options) {
  const log = [];
  const child = spawn(program("sparkhost"), [...patient, ...options, "--monitor-port", "0", "--web-port", "0"], { stdio: ["ignore", "pipe", "pipe"], cwd });
  createInterface({ input: child.stderr }).on("line", (line) => log.push(line));
  const lines = createInterface({ input: child.stdout });
  const ended = new Promise((done) => child.once("exit", done));
  t.after(async () => {
    await closePages(t);
    child.kill();
    child.kill("SIGCONT");
    await ended;
  });
  const first = await Promise.race([new Promise((heard) => lines.once("line", heard)), ended]);
  if (typeof first !== "string") throw new Error(`sparkhost ended at once:\n${log.join("\n")}`);
  const said = JSON.parse(first);
  return { url: said.web, refereeUrl: said.referee, said, log, ended, ctl: (...words) => ctl(child.pid, words), halt: () => child.kill("SIGSTOP") };
}

/** The output of sparkctl for a host. */
async function ctl(pid, words) {
  return (await promisify(execFile)(program("sparkctl"), ["--pid", String(pid), "--timeout", String(patience / 1000), ...words])).stdout.trim();
}

/** Plays a match at maximum rate and returns the path of its log. */
export async function recordMatch(t, seconds, ...options) {
  const file = join(temporaryFolder(t), "match.log");
  const host = await startHost(t, ...options, "--rate", "max", "--duration", String(seconds), "--set", `monitorLog=${file}`);
  await host.ended;
  return file;
}
