import type { World } from "../model";
import { isWithin, parentPath } from "./paths";

/// Maps tree paths to nodes of the picture, and is updated with the scene.
export class NodePaths {
  private version = -1;
  private readonly indices = new Map<string, number>();
  private paths: readonly (string | undefined)[] = [];

  constructor(private readonly world: World, private readonly pathsOf: (world: World) => readonly (string | undefined)[]) {}

  pathOf(node: number): string | undefined {
    this.refresh();
    return this.paths[node];
  }

  /// The node at this path, or its nearest ancestor that is in the picture; -1: none.
  nodeAt(path: string): number {
    this.refresh();
    for (let up: string | null = path; up !== null; up = parentPath(up)) {
      const node = this.indices.get(up);
      if (node !== undefined) return node;
    }
    return -1;
  }

  /// The key of the robot that contains this path.
  robotAt(path: string): string | null {
    const robot = this.world.robots.find((r) => {
      const top = r.path ?? this.pathOf(r.node);
      return top !== undefined && isWithin(path, top);
    });
    return robot?.key ?? null;
  }

  /// Path of the robot's topmost node.
  ofRobot(key: string | null): string | undefined {
    const robot = this.world.robots.find((r) => r.key === key);
    return robot && (robot.path ?? this.pathOf(robot.node));
  }

  /// "left 3" for the topmost node of a robot; empty for other nodes and if the path already contains it.
  titleOf(path: string): string {
    const robot = this.world.robots.find((r) => r.path === path);
    return robot?.side ? `${robot.side} ${robot.number}` : "";
  }

  private refresh(): void {
    if (this.version === this.world.versions.scene) return;
    this.version = this.world.versions.scene;
    this.paths = this.pathsOf(this.world);
    this.indices.clear();
    this.paths.forEach((path, node) => {
      if (path !== undefined && !this.indices.has(path)) this.indices.set(path, node);
    });
  }
}
