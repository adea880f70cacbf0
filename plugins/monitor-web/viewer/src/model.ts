/// What all parts of the viewer share. A source (the live stream, a log file) fills a World; views and panels read it.
/// Metres, seconds, z up, the left team's goal at -x. Matrices are column by column, as in the monitor protocol.

/// A robot's own shape, from the colliders of its scene, in the frame of the transform that it hangs below.
export interface Shape {
  kind: "box" | "sphere" | "capsule" | "cylinder";
  /// box: full edges [m]; sphere: [radius]; capsule and cylinder: [radius, length without caps], along z.
  size: number[];
  /// Position [m] and rotation (x, y, z, w) in the transform's frame.
  position: [number, number, number];
  rotation: [number, number, number, number];
}

/// A node of the scene, in depth-first order: parents before their children.
export interface SceneNode {
  /// Index in World.nodes; -1 at the top.
  parent: number;
  kind: "transform" | "light" | "mesh";
  /// Path in the host's tree; missing in logs.
  path?: string;
  /// Transforms: what touches there; missing in logs and where nothing does.
  shapes?: Shape[];
  /// Meshes: "models/naohead.obj", "StdUnitBox", "StdCapsule 0.015 0.08"; scale; material names in the mesh's order.
  load?: string;
  scale?: [number, number, number];
  materials?: string[];
  transparent?: boolean;
  visible?: boolean;
}

export type Side = "left" | "right";

/// A robot, found in the scene by the materials of its meshes (matNum3, matLeft).
export interface Robot {
  /// "left:3"; "?:<node>" for one that has no team yet.
  key: string;
  side: Side | null;
  number: number;
  /// Index of its topmost transform, and of those that carry its torso and its head (the topmost when there is none).
  node: number;
  torso: number;
  head: number;
  /// Path of its agent in the host's tree; missing in logs.
  path?: string;
}

/// Named values of the environment, as the monitor protocol has them: play_mode, score_left, team_left, FieldLength...
export type Value = string | number;
export type Environment = Map<string, Value | Value[]>;

export type Colour = [number, number, number, number];   // 0..1, with alpha

/// What agents drew: the commands of the drawing port, in world coordinates.
export type Drawing =
  | { kind: "circle"; centre: [number, number]; radius: number; thickness: number; colour: Colour }
  | { kind: "line"; from: [number, number, number]; to: [number, number, number]; thickness: number; colour: Colour }
  | { kind: "point"; at: [number, number, number]; size: number; colour: Colour }
  | { kind: "sphere"; centre: [number, number, number]; radius: number; colour: Colour }
  | { kind: "polygon"; points: [number, number, number][]; colour: Colour }
  | { kind: "text"; at: [number, number, number]; text: string; colour: Colour }
  | { kind: "agentText"; side: Side; number: number; text: string; colour: Colour };

/// Something that happened: a goal, a foul, another play mode.
export interface GameEvent {
  time: number;
  kind: "goal" | "foul" | "mode";
  /// For people: "Goal for Red", "foul: illegal defence of left 3".
  text: string;
  side?: Side;
}

/// Counters that increase with each change; a reader keeps the last value and updates when it differs.
export interface Versions {
  /// Nodes, shapes, meshes, materials or robots are others: build anew.
  scene: number;
  /// Transforms or visibility are others.
  frame: number;
  environment: number;
  events: number;
  drawings: number;
}

export interface World {
  nodes: SceneNode[];
  /// 16 numbers for each node that is a transform (identity for others): relative to the transform above. What is shown now, interpolated.
  local: Float32Array;
  robots: Robot[];
  /// Index of the ball's transform; -1: there is none.
  ball: number;
  /// Simulated seconds of what is shown now.
  time: number;
  environment: Environment;
  events: GameEvent[];
  drawings: Map<string, Drawing[]>;
  versions: Versions;
}

/// How the host is doing; live only, once a second.
export interface Status {
  realTimeFactor: number;
  cycle: number;
  spectators: number;
  /// For each agent: its path, and the wall time from its percepts to its answer [ms]; null when not known.
  agents: { path: string; team: string; number: number; latency: number | null }[];
  /// What the game reports besides mode, score and teams: name and value.
  facts: [string, string][];
}

/// Where a World comes from.
export interface Source {
  readonly world: World;
  readonly kind: "live" | "replay";
  /// Brings the world to this instant of wall time [ms, as performance.now()]; called once for each picture.
  update(now: number): void;
  close(): void;
}

/// The running match, over a WebSocket.
export interface LiveSource extends Source {
  readonly kind: "live";
  readonly connected: boolean;
  /// "lost": it was open, and is tried again and again.
  readonly state: "connecting" | "open" | "lost";
  readonly status: Status | null;
  /// True when the host took our token.
  readonly referee: boolean;
  /// Asks the host (requests of the control plugin: tree, get, set, call; and contacts, percepts, joints); rejects with the host's words.
  ask<T = unknown>(request: Record<string, unknown>): Promise<T>;
  /// Hears a property's value now and after every change, until the returned function is called.
  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void;
  /// A trainer's command, "(kickOff Left)"; rejects when this viewer is no referee.
  command(text: string): Promise<void>;
  /// Hands over the token printed by the host; false when it is wrong.
  login(token: string): Promise<boolean>;
  /// Wanted pictures a second, 1..50; detail "fine" or "coarse".
  setRate(rate: number, detail: "fine" | "coarse"): void;
  /// World.drawings is kept up to date from now on, or empty; off at first.
  setDrawings(on: boolean): void;
  onchange: (() => void) | null;
}

/// A recorded match.
export interface ReplaySource extends Source {
  readonly kind: "replay";
  readonly name: string;
  /// Simulated seconds of the first and last record.
  readonly start: number;
  readonly end: number;
  /// All events of the whole log, in ascending time; World.events holds those up to what is shown now.
  readonly timeline: GameEvent[];
  /// Lines of the log that are damaged and were passed over, as far as is known by now.
  readonly damaged: number;
  /// Why the log cannot be read any more (its file was changed or removed), or null.
  readonly error: string | null;
  playing: boolean;
  /// 0.1..10
  speed: number;
  seek(time: number): void;
  /// One record forward (1) or back (-1); pauses.
  step(direction: 1 | -1): void;
}
