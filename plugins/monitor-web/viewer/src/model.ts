/// Types that all parts of the viewer share. A source (the live stream, a log file) fills a World; views and panels
/// read it. Metres, seconds, z up, the left team's goal at -x. Matrices are column by column, as in the monitor
/// protocol.

/// The shape of a collider, in the frame of its parent transform.
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
  /// Transforms: frames place this one relative to that transform, which is counted among transforms and before it;
  /// `pin` is the point that both share, in the frame of this one [m]. Missing if there is none.
  on?: number;
  pin?: [number, number, number];
  /// Transforms: the colliders; missing in logs and if there are none.
  shapes?: Shape[];
  /// Lights: diffuse, ambient and specular colour.
  colors?: [Colour, Colour, Colour];
  /// Meshes: "models/naohead.obj", "StdUnitBox", "StdCapsule 0.015 0.08"; scale; material names in the mesh's order.
  load?: string;
  scale?: [number, number, number];
  materials?: string[];
  /// Meshes: where the host serves the file; missing in recordings and logs, and for meshes that are no files.
  file?: string;
  /// What the host knows of each of `materials`; null: nothing. Missing in logs and older recordings.
  looks?: (Material | null)[];
  /// Meshes: all parts have the first material.
  single?: boolean;
  transparent?: boolean;
  visible?: boolean;
}

/// A material, as in OpenGL's lighting equation.
export interface Material {
  name: string;
  diffuse: Colour;
  ambient: Colour;
  specular: Colour;
  emission: Colour;
  /// Exponent of highlights, 0..128.
  shininess: number;
  /// Where the host serves its texture; missing without one.
  picture?: string;
}

export type Side = "left" | "right";

/// A robot, found in the scene by the materials of its meshes (matNum3, matLeft).
export interface Robot {
  /// "left:3"; "?:<node>" for a robot without a team.
  key: string;
  side: Side | null;
  number: number;
  /// Indices of its topmost transform and of the transforms of torso and head (the topmost one if there is no torso or
  /// head).
  node: number;
  torso: number;
  head: number;
  /// Path of its agent in the host's tree; missing in logs.
  path?: string;
}

/// Named values of the environment, as in the monitor protocol: play_mode, score_left, team_left, FieldLength...
export type Value = string | number;
export type Environment = Map<string, Value | Value[]>;

export type Colour = [number, number, number, number];   // 0..1, with alpha

/// Drawings of agents: the commands of the drawing port, in world coordinates.
export type Drawing =
  | { kind: "circle"; centre: [number, number]; radius: number; thickness: number; colour: Colour }
  | { kind: "line"; from: [number, number, number]; to: [number, number, number]; thickness: number; colour: Colour }
  | { kind: "point"; at: [number, number, number]; size: number; colour: Colour }
  | { kind: "sphere"; centre: [number, number, number]; radius: number; colour: Colour }
  | { kind: "polygon"; points: [number, number, number][]; colour: Colour }
  | { kind: "text"; at: [number, number, number]; text: string; colour: Colour }
  | { kind: "agentText"; side: Side; number: number; text: string; colour: Colour };

/// An event: a goal, a foul, a change of play mode.
export interface GameEvent {
  time: number;
  kind: "goal" | "foul" | "mode";
  /// Display text: "Goal for Red", "foul: illegal defence of left 3".
  text: string;
  side?: Side;
}

/// A sound of the scene, or of the referee.
export interface Sound {
  /// Simulated time [s].
  time: number;
  name: string;
  /// 0..1.
  volume: number;
  /// Position [m]; null: it is heard everywhere.
  at: [number, number, number] | null;
}

/// Counters that increase with each change. A reader stores the last value and updates when it differs.
export interface Versions {
  /// Nodes, shapes, meshes, materials or robots changed: readers must rebuild.
  scene: number;
  /// Transforms or visibility changed.
  frame: number;
  environment: number;
  events: number;
  drawings: number;
}

export interface World {
  nodes: SceneNode[];
  /// Local matrices, 16 numbers per node (identity for nodes that are not transforms), relative to the parent
  /// transform. Interpolated for the current time.
  local: Float32Array;
  robots: Robot[];
  /// Index of the ball's transform; -1: no ball.
  ball: number;
  /// Simulated time that is shown [s].
  time: number;
  environment: Environment;
  events: GameEvent[];
  /// What is heard with this update, and in no other one.
  sounds: Sound[];
  drawings: Map<string, Drawing[]>;
  versions: Versions;
}

/// How long an agent thinks in simulated time, and its latencies [steps].
export interface Thinking {
  /// Its last thought, and the mean of its recent ones; null before the first.
  last: number | null;
  mean: number | null;
  /// From sensing to the arrival of the sensation, and from the end of a thought until its acts take effect.
  senseLatency: number;
  actLatency: number;
  /// Sensations that it did not get because it thought for too long.
  dropped: number;
}

/// An agent in the status of the host.
export interface AgentStatus {
  path: string;
  team: string;
  number: number;
  /// Wall time from its percepts to its answer [ms]; null if unknown.
  latency: number | null;
  /// null if it does not think in simulated time.
  thinking: Thinking | null;
}

/// Status of the host; live only, updated once a second.
export interface Status {
  realTimeFactor: number;
  /// Simulated time of a step [s]; NaN if unknown.
  step: number;
  cycle: number;
  spectators: number;
  agents: AgentStatus[];
  /// Status entries of the game other than mode, score and teams: name and value.
  facts: [string, string][];
}

/// A source of a World.
export interface Source {
  readonly world: World;
  readonly kind: "live" | "replay";
  /// Updates the world to this wall time [ms, as performance.now()]; called once per picture.
  update(now: number): void;
  close(): void;
}

/// What the timeline controls: a recording, or the last minutes of a running match.
export interface Playback {
  readonly world: World;
  /// Simulated time of the first and last frame [s].
  readonly start: number;
  readonly end: number;
  /// All events in chronological order. World.events contains those up to the current time.
  readonly timeline: readonly GameEvent[];
  /// The requested time, which World.time reaches as soon as it is loaded [s].
  readonly time: number;
  /// True while the newest instant of a running match is shown, and those that come.
  readonly following: boolean;
  playing: boolean;
  /// 0.1..10; negative: backwards.
  speed: number;
  seek(time: number): void;
  /// Moves one frame forward (1) or back (-1) and pauses.
  step(direction: 1 | -1): void;
}

/// The running match, over a WebSocket.
export interface LiveSource extends Source {
  readonly kind: "live";
  readonly connected: boolean;
  /// "lost": it was open, and reconnection attempts are being made.
  readonly state: "connecting" | "open" | "lost";
  readonly status: Status | null;
  /// Its last minutes; null: the host keeps none.
  readonly past: (Playback & { follow(): void }) | null;
  /// True if the host accepted the token.
  readonly referee: boolean;
  /// Sends a request to the host (of the control plugin: tree, get, set, call; also contacts, percepts, joints).
  /// Rejects with the host's error text.
  ask<T = unknown>(request: Record<string, unknown>): Promise<T>;
  /// Calls back with a property's current value and after every change, until the returned function is called.
  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void;
  /// Sends a trainer command, "(kickOff Left)". Rejects if this viewer is not a referee.
  command(text: string): Promise<void>;
  /// Sends the token printed by the host; resolves to false if it is wrong.
  login(token: string): Promise<boolean>;
  /// Requested frames per second, 1..50; detail "fine" or "coarse".
  setRate(rate: number, detail: "fine" | "coarse"): void;
  /// Switches updates of World.drawings on or off (then it is empty). Initially off.
  setDrawings(on: boolean): void;
  onchange: (() => void) | null;
}

/// A recorded match.
export interface ReplaySource extends Source, Playback {
  readonly kind: "replay";
  readonly world: World;
  readonly name: string;
  /// Number of damaged lines or parts that were skipped so far.
  readonly damaged: number;
  /// What is missing, in sentences for the user; null: nothing that is known.
  readonly lacks: string | null;
  /// Why the log can no longer be read (its file was changed or removed), or null.
  readonly error: string | null;
}
