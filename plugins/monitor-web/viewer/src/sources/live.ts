import type { AgentStatus, Drawing, GameEvent, LiveSource, Robot, Sound, Status, Thinking, World } from "../model";
import type { Entry } from "../codec/record";
import { FrameDecoder } from "../codec/frames";
import { Connection, type Connect, connectSocket } from "./connection";
import { EventReader, isEntry, modeName, takeEntries, teamName } from "./events";
import { FrameRing } from "./frame_ring";
import { HostTape } from "./host_tape";
import { LiveClock } from "./live_clock";
import { Mirror } from "./mirror";
import { Past } from "./past";
import { OutlineReader } from "./outline";
import { isPast } from "./piece_message";
import { Poses } from "./poses";
import { Questions } from "./questions";
import { kNoScene, makeScene, sameNodes, type Scene } from "./scene";
import { isRecord, readScene } from "./scene_message";
import { soundIn, whistlesAt } from "./sounds";
import { emptyWorld, showScene } from "./world";

/// The running match, and its last minutes. Frames are shown with a small delay, so that motion is smooth; everything
/// else is shown when it arrives, unless the past is shown. Invalid data closes the connection, and the next connection begins with a complete scene, so no message of
/// a host causes an error in the viewer.

const kMostEvents = 1000;
/// Limit of sounds between two pictures. If there was no picture for longer than this, they are left out [ms].
const kMostSounds = 64, kLongestPicture = 1000;

export class Live implements LiveSource {
  readonly kind = "live";
  /// What is shown: the present, or an instant of the past.
  readonly world: World = emptyWorld();
  past: Past | null = null;
  status: Status | null = null;
  referee = false;
  onchange: (() => void) | null = null;

  private readonly present: World = emptyWorld();
  private readonly mirror = new Mirror(this.world);
  private readonly tape = new HostTape((request) => this.ask(request), () => this.present.events, (scene) => this.nameRobotsOf(scene));
  /// Simulated time that the host keeps [s].
  private kept = 0;
  /// Simulated time of a step [s].
  private step = NaN;
  private readonly connection: Connection;
  private readonly questions: Questions;
  private readonly decoder = new FrameDecoder();
  private readonly ring = new FrameRing();
  private readonly clock = new LiveClock();
  private events = new EventReader();
  /// Sounds since the last update.
  private coming: Sound[] = [];
  private last = NaN;
  private scene: Scene = kNoScene;
  /// The last decoded poses; delta frames refer to them.
  private poses = new Poses();
  private free = false;
  private token: string | null = null;
  private logins: ((ok: boolean) => void)[] = [];
  private view: { rate: number; detail: string } | null = null;
  private drawings = false;
  /// Names of the entries in the host's environment; null before the first message.
  private told: Set<string> | null = null;
  /// Mode, score and teams of the status, as entries of the environment.
  private words: Entry[] = [];

  constructor(url: string, connect: Connect = connectSocket) {
    this.connection = new Connection(url, connect);
    this.questions = new Questions(this.connection);
    this.connection.onopen = () => this.opened();
    this.connection.onlost = () => this.lost();
    this.connection.ontext = (text) => this.text(text);
    this.connection.onbinary = (bytes) => this.frame(bytes);
    this.connection.open();
  }

  get state(): "connecting" | "open" | "lost" {
    return this.connection.state;
  }

  get connected(): boolean {
    return this.connection.state === "open";
  }

  update(now: number): void {
    this.present.sounds = now - this.last > kLongestPicture ? [] : this.coming;
    this.world.sounds = this.coming = [];
    this.last = now;
    if (this.past && !this.past.following) this.past.update(now);
    else this.updatePresent(now);
    this.show();
  }

  private updatePresent(now: number): void {
    if (this.ring.empty) return;
    const { present } = this;
    const time = this.clock.at(now);
    const shown = this.ring.show(time, this.scene, present.local);
    if (!shown) return;
    present.time = time;
    for (let i = 0; i < present.nodes.length; ++i) if (present.nodes[i]!.kind === "mesh") present.nodes[i]!.visible = shown.visible[i] === 1;
    ++present.versions.frame;
  }

  /// Until the past is loaded, the last picture stays.
  private show(): void {
    if (!this.past || this.past.following) this.mirror.show(this.present);
    else if (this.past.shown) this.mirror.show(this.past.shown);
  }

  close(): void {
    this.connection.close();
    this.questions.lost();
    this.loggedIn(false);
  }

  ask<T = unknown>(request: Record<string, unknown>): Promise<T> {
    return this.questions.ask(request) as Promise<T>;
  }

  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void {
    return this.questions.watch({ path, property, heard, failed });
  }

  async command(text: string): Promise<void> {
    await this.questions.ask({ do: "command", text });
  }

  login(token: string): Promise<boolean> {
    this.token = token;
    return new Promise((resolve) => {
      this.logins.push(resolve);
      // Without a connection, the token is sent later.
      this.connection.send({ do: "login", token });
    });
  }

  setRate(rate: number, detail: "fine" | "coarse"): void {
    this.view = { rate: Math.min(50, Math.max(1, rate)), detail };
    this.connection.send({ do: "view", ...this.view });
  }

  setDrawings(on: boolean): void {
    this.drawings = on;
    this.connection.send({ do: "drawings", on });
    if (on || this.present.drawings.size === 0) return;
    this.present.drawings.clear();
    ++this.present.versions.drawings;
    this.show();
  }

  private opened(): void {
    if (this.view) this.connection.send({ do: "view", ...this.view });
    if (this.drawings) this.connection.send({ do: "drawings", on: true });
    if (this.token !== null) this.connection.send({ do: "login", token: this.token });
    this.questions.opened();
    this.onchange?.();
  }

  private lost(): void {
    this.referee = false;
    this.status = null;
    this.decoder.setScene(-1, this.scene);
    this.decoder.time = 0;
    this.questions.lost();
    this.onchange?.();
  }

  private text(text: string): void {
    let message: unknown;
    try {
      message = JSON.parse(text);
    } catch {
      return this.connection.again();
    }
    if (!isRecord(message) || !this.take(message)) return this.connection.again();
    this.show();
  }

  /// Returns false if the message is invalid. Unknown types are ignored: they come from newer hosts.
  private take(message: Record<string, unknown>): boolean {
    switch (message.type) {
      case "hello":
        return this.takeHello(message);
      case "scene":
        return this.takeScene(message);
      case "environment":
        return this.takeEnvironment(message);
      case "event":
        return this.takeEvent(message);
      case "status":
        return this.takeStatus(message);
      case "drawings":
        return this.takeDrawings(message);
      case "answer":
      case "watched":
        this.questions.answered(message);
        return true;
      case "referee":
        this.loggedIn(message.ok === true);
        return true;
      default:
        return typeof message.type === "string";
    }
  }

  private takeHello(message: Record<string, unknown>): boolean {
    this.kept = typeof message.history === "number" ? message.history : 0;
    this.step = numberIn(message.step) ?? NaN;
    this.tape.clear();
    if (this.kept > 0) this.ask<Record<string, unknown>>({ do: "history" }).then((outline) => this.takeOutline(outline), () => undefined);
    return true;
  }

  /// What happened before this viewer came: the events of the timeline.
  private takeOutline({ from, to, messages }: Record<string, unknown>): void {
    if (typeof from !== "number" || typeof to !== "number" || !Array.isArray(messages)) return;
    const outline = new OutlineReader();
    for (const message of messages) outline.take(message);
    const { present } = this;
    present.events = [...outline.events, ...present.events.filter((e) => e.time > to)].slice(-kMostEvents);
    ++present.versions.events;
    this.tape.start = from;
    this.tape.end = Math.max(to, this.decoder.time);
    this.past ??= new Past(this.world, this.tape, () => this.followed());
    // Another host, or the same one again much later.
    if (this.past.time < from || this.past.time > this.tape.end) this.past.follow();
    this.show();
  }

  private followed(): void {
    this.ring.again();
    this.update(performance.now());
  }

  private takeScene(message: Record<string, unknown>): boolean {
    const read = readScene(message);
    if (!read) return false;
    // After a loss, the host usually sends the same scene again.
    if (!sameNodes(this.scene.nodes, read.nodes) || this.scene === kNoScene) this.scene = makeScene(read.nodes);
    this.poses = read.poses;
    this.decoder.setScene(read.shape, this.scene);
    this.ring.begin(read.poses);
    this.tape.addScene(read.shape, this.scene, read.poses);
    this.nameRobots();
    showScene(this.present, this.scene);
    for (const i of this.scene.transforms) read.poses.getMatrix(i, this.present.local, 16 * i);
    for (let i = 0; i < read.nodes.length; ++i) if (read.nodes[i]!.kind === "mesh") this.scene.nodes[i]!.visible = read.poses.visible[i] === 1;
    ++this.present.versions.frame;
    return true;
  }

  private frame(bytes: Uint8Array): void {
    if (isPast(bytes)) return this.tape.take(bytes) ? undefined : this.connection.again();
    const decoded = this.decoder.decode(bytes, this.poses);
    if (decoded === "broken") return this.connection.again();
    if (decoded !== "shown") return;
    this.connection.proven();
    this.clock.arrived(this.decoder.time, performance.now());
    this.ring.take(this.decoder.time, this.poses, this.free);
    this.tape.end = this.decoder.time;
    this.tape.start = Math.min(this.tape.end, Math.max(this.tape.start, this.tape.end - this.kept));
  }

  private takeEnvironment(message: Record<string, unknown>): boolean {
    if (!Array.isArray(message.entries) || !message.entries.every(isEntry)) return false;
    const entries = message.entries as Entry[];
    const time = Number(message.time) || 0;
    // The host was restarted.
    if (message.full === true && time < this.present.time - 1) this.forget();
    if (message.full === true) this.told = new Set();
    for (const [name] of entries) this.told?.add(name);
    this.change(entries, time, message.full === true);
    this.fillIn(time);
    return true;
  }

  private change(entries: Entry[], time: number, full: boolean): void {
    const { present } = this;
    takeEntries(present.environment, entries, full);
    ++present.versions.environment;
    this.addEvents(this.events.take(present.environment, entries, time));
    this.free = /^(playon|pass)/i.test(modeName(present.environment));
    if (entries.some(([name]) => name === "team_left" || name === "team_right")) this.nameRobots();
  }

  /// A game without a monitor item reports mode, score and teams only in its status.
  private fillIn(time: number): void {
    const { told, words, present } = this;
    if (!told || words.length === 0) return;
    const entries = [...words, ["time", time] as Entry].filter(([name, value]) => !told.has(name) && present.environment.get(name) !== value);
    if (entries.length > 0) this.change(entries, time, false);
  }

  private takeEvent(message: Record<string, unknown>): boolean {
    if (!isEntry(message.entry)) return false;
    const sound = soundIn(message);
    if (sound) this.addSounds([sound]);
    this.addEvents(this.events.take(this.present.environment, [message.entry], Number(message.time) || 0));
    return true;
  }

  private takeStatus(message: Record<string, unknown>): boolean {
    const { agents, status } = message;
    if (!Array.isArray(agents) || !agents.every(isRecord)) return false;
    const facts = Array.isArray(status) ? status.filter(isEntry) : [];
    this.status = {
      realTimeFactor: Number(message.realTimeFactor ?? NaN),
      cycle: Number(message.cycle ?? 0),
      spectators: Number(message.spectators ?? 0),
      step: this.step,
      agents: agents.map(agentOf),
      facts: facts.map(([name, value]) => [name, [value].flat().join(" ")]),
    };
    this.words = wordsOf(message);
    this.fillIn(Number(message.time) || 0);
    this.nameRobots();
    this.onchange?.();
    return true;
  }

  private takeDrawings(message: Record<string, unknown>): boolean {
    if (!isRecord(message.sets)) return false;
    for (const [name, set] of Object.entries(message.sets)) {
      if (set === null) this.present.drawings.delete(name);
      else if (Array.isArray(set)) this.present.drawings.set(name, set as Drawing[]);
      else return false;
    }
    ++this.present.versions.drawings;
    return true;
  }

  private addEvents(events: GameEvent[]): void {
    if (events.length === 0) return;
    this.present.events = [...this.present.events, ...events].slice(-kMostEvents);
    ++this.present.versions.events;
    this.addSounds(whistlesAt(events));
  }

  private addSounds(sounds: Sound[]): void {
    this.coming = [...this.coming, ...sounds].slice(-kMostSounds);
  }

  private forget(): void {
    this.events = new EventReader();
    this.clock.reset();
    this.present.events = [];
    ++this.present.versions.events;
  }

  private loggedIn(ok: boolean): void {
    const changed = this.referee !== ok;
    this.referee = ok;
    if (!ok) this.token = null;
    const { logins } = this;
    this.logins = [];
    logins.forEach((resolve) => resolve(ok));
    if (changed) this.onchange?.();
  }

  /// Completes the robots with data of the host, which also knows robots without a visible number.
  private nameRobots(): void {
    for (const scene of new Set([this.scene, ...this.tape.sceneList])) this.nameRobotsOf(scene);
    if (this.present.nodes !== this.scene.nodes || this.present.robots === this.scene.robots) return;
    this.present.robots = this.scene.robots;
    ++this.present.versions.scene;
  }

  private nameRobotsOf(scene: Scene): void {
    const agents = new Map(this.status?.agents.map((a) => [a.path, a]));
    const { environment } = this.present;
    const teams = { left: teamName(environment, "left"), right: teamName(environment, "right") };
    let changed = false;
    const robots = scene.robots.map((robot): Robot => {
      const agent = agents.get(robot.path ?? "");
      if (!agent || !(agent.number > 0)) return robot;
      const side = agent.team === teams.left ? "left" : agent.team === teams.right ? "right" : robot.side;
      if (side === null || (side === robot.side && agent.number === robot.number)) return robot;
      changed = true;
      return { ...robot, side, number: agent.number, key: `${side}:${agent.number}` };
    });
    if (changed && new Set(robots.map((r) => r.key)).size === robots.length) scene.robots = robots;
  }
}

function numberIn(value: unknown): number | null {
  return typeof value === "number" ? value : null;
}

/// An agent of a status message.
function agentOf(agent: Record<string, unknown>): AgentStatus {
  const { path, team, number, latency, thinking } = agent;
  return { path: String(path), team: String(team ?? ""), number: Number(number ?? 0), latency: numberIn(latency), thinking: isRecord(thinking) ? thinkingOf(thinking) : null };
}

function thinkingOf({ last, mean, senseLatency, actLatency, dropped }: Record<string, unknown>): Thinking {
  return { last: numberIn(last), mean: numberIn(mean), senseLatency: Number(senseLatency), actLatency: Number(actLatency), dropped: Number(dropped ?? 0) };
}

/// playMode, score and teams of a status, as entries of the environment.
function wordsOf({ playMode, score, teams }: Record<string, unknown>): Entry[] {
  const words: Entry[] = [];
  if (typeof playMode === "string") words.push(["play_mode", playMode]);
  (["left", "right"] as const).forEach((side, i) => {
    if (Array.isArray(score) && typeof score[i] === "number") words.push([`score_${side}`, score[i]]);
    if (Array.isArray(teams) && typeof teams[i] === "string") words.push([`team_${side}`, teams[i]]);
  });
  return words;
}
