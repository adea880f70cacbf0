import { describe, expect, it } from "vitest";
import type { SceneNode, World } from "../../src/model";
import { NodePaths } from "../../src/inspect/node_paths";
import { Recording, worldPosition } from "../../src/inspect/recording";

const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const at = (x: number, y: number, z: number) => [...kIdentity.slice(0, 12), x, y, z, 1];

function world(): World {
  const nodes: SceneNode[] = [
    { parent: -1, kind: "transform" },
    { parent: 0, kind: "transform" },
    { parent: 1, kind: "mesh", load: "models/naobody.obj", materials: ["matLeft"] },
    { parent: -1, kind: "transform" },
    { parent: 3, kind: "mesh", load: "models/soccerball.obj" },
    { parent: 3, kind: "mesh", load: "models/soccerball.obj" },
  ];
  const quarter = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 0, 1];  // a quarter turn about z, then (1 2 0)
  return {
    nodes, local: new Float32Array([...quarter, ...at(1, 0, 0.5), ...kIdentity, ...at(3, 0, 0.04), ...kIdentity, ...kIdentity]),
    robots: [{ key: "left:3", side: "left", number: 3, node: 0, torso: 1, head: 1 }], ball: 3, time: 4.5,
    environment: new Map([["play_mode", 3]]), events: [], sounds: [], drawings: new Map(), versions: { scene: 1, frame: 1, environment: 1, events: 1, drawings: 1 },
  };
}

describe("a recording", () => {
  it("shows its scene as a tree, with robots and ball by name", async () => {
    const tree = await new Recording(world()).tree("/", 3);
    expect(tree.children!.map((c) => c.name)).toEqual(["scene", "state"]);
    const scene = tree.children![0]!;
    expect(scene.children!.map((c) => c.name)).toEqual(["left 3", "ball"]);
    expect(scene.children![1]!.children!.map((c) => c.name)).toEqual(["soccerball", "soccerball"]);
    expect(scene.children![0]!.children![0]).toMatchObject({ name: "transform", class: "Transform", children: [], more: 1 });
  });

  it("gives positions of nodes", async () => {
    const w = world();
    expect(worldPosition(w, 1)).toEqual([1, 3, 0.5]);
    const info = await new Recording(w).node("/scene/left 3/transform");
    expect(info.properties.find((p) => p.name === "position")!.value).toEqual([1, 3, 0.5]);
    await expect(new Recording(w).node("/scene/nothing")).rejects.toThrow("no /scene/nothing");
    await expect(new Recording(w).set()).rejects.toThrow("cannot be changed");
  });

  it("reports changes and lost nodes to watchers", () => {
    const w = world();
    const recording = new Recording(w);
    const heard: unknown[] = [];
    const failed: string[] = [];
    recording.watch("/state", "play_mode", (v, t) => heard.push([v, t]), (why) => failed.push(why));
    const end = recording.watch("/scene/ball", "position", (v) => heard.push(v), (why) => failed.push(why));
    recording.update();
    expect(heard[0]).toEqual([3, 4.5]);
    expect((heard[1] as number[])[0]).toBe(3);
    end();
    recording.update();
    expect(heard.length).toBe(2);
    w.environment.clear();
    recording.update();
    expect(failed.length).toBe(1);
  });

  it("maps nodes to paths, also after the scene changed", () => {
    const w = world();
    const recording = new Recording(w);
    const paths = new NodePaths(w, () => recording.pathsOf());
    expect(paths.pathOf(5)).toBe("/scene/ball/soccerball[2]");
    expect(paths.nodeAt("/scene/ball/soccerball/nothing")).toBe(4);
    expect(paths.robotAt("/scene/left 3/transform")).toBe("left:3");
    expect(paths.robotAt("/scene/ball")).toBeNull();
    expect(paths.ofRobot("left:3")).toBe("/scene/left 3");
    w.nodes = w.nodes.slice(3).map((n) => ({ ...n, parent: n.parent < 0 ? -1 : 0 }));
    w.robots = [];
    w.ball = 0;
    ++w.versions.scene;
    expect(paths.pathOf(0)).toBe("/scene/ball");
    expect(paths.nodeAt("/scene/left 3")).toBe(-1);
  });
});
