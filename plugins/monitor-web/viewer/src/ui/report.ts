/// The state of the page for tests and debugging: `spark.state()` in the browser's console.
import { Vector3 } from "three";
import { modeName } from "../sources";
import type { Application } from "./application";
import { numberOf } from "./format";
import { placeOf, type Point } from "./places";
import { type Connection, connectionOf } from "./status_line";

/// Returns a new plain object on every call.
export interface Report {
  source: "live" | "replay";
  connection: Connection;
  referee: boolean;
  /// Robot.key of each.
  robots: string[];
  selected: string | null;
  /// Path of the selection, if known.
  path: string | null;
  ball: Point | null;
  time: number;
  /// Time range of the timeline; 0 and 0 without one.
  start: number;
  end: number;
  playing: boolean;
  /// The newest instant of a running match is shown.
  following: boolean;
  speed: number;
  /// Number of pictures drawn since the page was opened.
  frames: number;
  camera: string;
  quality: string;
  /// "scene" or "plain": what lights the picture.
  lights: string;
  /// Mesh files and textures of the host that are shown.
  meshes: number;
  textures: number;
  score: [number, number];
  /// The protocol name of the mode.
  playMode: string;
  events: number;
  /// Sounds played while they were switched on, also if the browser has no audio.
  sounds: number;
}

export interface Spark {
  app: Application;
  state(): Report;
  /// Position of a robot's torso on the page; null if it is behind the camera.
  where(key: string): { x: number; y: number } | null;
}

export function reportOf(app: Application): Report {
  const { world, playback } = app;
  return {
    source: app.source.kind,
    connection: connectionOf(app),
    referee: app.live?.referee ?? false,
    robots: world.robots.map((r) => r.key),
    selected: app.selection?.robot ?? null,
    path: app.selection?.path ?? null,
    ball: world.ball >= 0 ? placeOf(world, world.ball) : null,
    time: world.time,
    start: playback?.start ?? 0,
    end: playback?.end ?? 0,
    playing: playback?.playing ?? false,
    following: !app.inPast,
    speed: playback?.speed ?? 1,
    frames: app.frames,
    camera: app.stage.camera.mode,
    quality: app.stage.quality,
    lights: app.stage.litBy,
    ...app.stage.loaded,
    score: [numberOf(world.environment, "score_left", 0), numberOf(world.environment, "score_right", 0)],
    playMode: modeName(world.environment),
    events: world.events.length,
    sounds: app.sounds.played,
  };
}

function whereIs(app: Application, key: string): { x: number; y: number } | null {
  const robot = app.world.robots.find((r) => r.key === key);
  const out = { x: 0, y: 0 };
  if (!robot || !app.stage.project(new Vector3(...placeOf(app.world, robot.torso)), out)) return null;
  const box = app.stage.canvas.getBoundingClientRect();
  return { x: box.left + out.x, y: box.top + out.y };
}

declare global {
  interface Window {
    spark: Spark;
  }
}

export function offer(app: Application): void {
  window.spark = { app, state: () => reportOf(app), where: (key) => whereIs(app, key) };
}
