import type { Robot, SceneNode, World } from "../src/model";

/// A synthetic world for tests: nodes with matrices, built top down.
export class SyntheticWorld {
  private readonly nodes: SceneNode[] = [];
  private readonly matrices: number[][] = [];
  private readonly robots: Robot[] = [];
  private ball = -1;

  transform(parent: number, position: [number, number, number] = [0, 0, 0], more: Partial<SceneNode> = {}): number {
    return this.add({ parent, kind: "transform", ...more }, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...position, 1]);
  }

  mesh(parent: number, load: string, more: Partial<SceneNode> = {}): number {
    return this.add({ parent, kind: "mesh", load, scale: [1, 1, 1], visible: true, ...more }, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
  }

  /// Adds a humanoid with a torso and a head.
  humanoid(side: "left" | "right", number: number, x: number, y: number): Robot {
    const node = this.transform(-1);
    const team = side === "left" ? "matLeft" : "matRight";
    const part = { rotation: [0, 0, 0, 1], position: [0, 0, 0] } as const;
    const torso = this.transform(node, [x, y, 0.38], { shapes: [{ ...part, kind: "box", size: [0.1, 0.1, 0.18] } as never] });
    this.mesh(this.transform(torso), "models/naobody0.obj", { scale: [0.1, 0.1, 0.1], materials: [`matNum${number}`, team, "naowhite"] });
    const head = this.transform(node, [x, y, 0.53], { shapes: [{ ...part, kind: "sphere", size: [0.065] } as never] });
    this.mesh(this.transform(head), "models/naohead.obj", { scale: [0.1, 0.1, 0.1], materials: [team, "naoblack", "naogrey", "naowhite"] });
    return this.robot({ key: `${side}:${number}`, side, number, node, torso, head });
  }

  robot(robot: Robot): Robot {
    this.robots.push(robot);
    return robot;
  }

  world(environment: [string, string | number][] = []): World {
    return {
      nodes: this.nodes, local: Float32Array.from(this.matrices.flat()), robots: this.robots, ball: this.ball, time: 0, environment: new Map(environment),
      events: [], sounds: [], drawings: new Map(), versions: { scene: 1, frame: 1, environment: 1, events: 0, drawings: 0 },
    };
  }

  private add(node: SceneNode, matrix: number[]): number {
    this.matrices.push(matrix);
    return this.nodes.push(node) - 1;
  }
}
