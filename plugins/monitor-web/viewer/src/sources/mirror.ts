import type { Versions, World } from "../model";

/// Shows one of several worlds as another one, whose readers see the changes by its versions.
export class Mirror {
  private from: World | null = null;
  private seen: Versions = { scene: 0, frame: 0, environment: 0, events: 0, drawings: 0 };

  constructor(private readonly to: World) {}

  show(from: World): void {
    const { to, seen } = this;
    const other = this.from !== null && this.from !== from;
    const sameScene = to.nodes === from.nodes && to.robots === from.robots;
    this.from = from;
    for (const key of Object.keys(seen) as (keyof Versions)[]) {
      if (other ? key !== "scene" || !sameScene : from.versions[key] !== seen[key]) ++to.versions[key];
      seen[key] = from.versions[key];
    }
    to.nodes = from.nodes;
    to.local = from.local;
    to.robots = from.robots;
    to.ball = from.ball;
    to.time = from.time;
    to.environment = from.environment;
    to.events = from.events;
    to.sounds = from.sounds;
    to.drawings = from.drawings;
  }
}
