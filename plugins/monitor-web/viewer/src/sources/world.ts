import type { World } from "../model";
import type { Scene } from "./scene";

export function emptyWorld(): World {
  return {
    nodes: [],
    local: new Float32Array(),
    robots: [],
    ball: -1,
    time: 0,
    environment: new Map(),
    events: [],
    sounds: [],
    drawings: new Map(),
    versions: { scene: 0, frame: 0, environment: 0, events: 0, drawings: 0 },
  };
}

/// Replaces the scene of the world and places all nodes at the origin. Does nothing if the scene is the same.
export function showScene(world: World, scene: Scene): void {
  if (world.nodes === scene.nodes) return;
  world.nodes = scene.nodes;
  world.robots = scene.robots;
  world.ball = scene.ball;
  world.local = new Float32Array(16 * scene.nodes.length);
  for (let i = 0; i < world.local.length; i += 16) world.local[i] = world.local[i + 5] = world.local[i + 10] = world.local[i + 15] = 1;
  ++world.versions.scene;
}
