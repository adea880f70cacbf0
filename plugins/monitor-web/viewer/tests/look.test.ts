import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import type { Material, SceneNode } from "../src/model";
import { readScene } from "../src/sources/scene_message";
import { makeScene, sameNodes } from "../src/sources/scene";
import { baseOf, Lamps } from "../src/view/lamps";
import { readMeshFile } from "../src/view/mesh_file";
import { materialColour, usualMaterials, usualTeams } from "../src/view/palette";
import { makePicture } from "../src/view/pieces";
import { TexturedSolids } from "../src/view/textured_solids";
import { SyntheticWorld } from "./synthetic";

const red: Material = { name: "red", diffuse: [0.8, 0.1, 0.1, 0.5], ambient: [0.3, 0.2, 0.1, 1], specular: [0, 0, 0, 1], emission: [0, 0, 0.1, 1], shininess: 20 };

/// A scene message with a light and a mesh, as the host writes it.
function message(more: Record<string, unknown> = {}, node: Record<string, unknown> = {}): Record<string, unknown> {
  return {
    type: "scene", shape: 1, local: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1],
    nodes: [
      { parent: -1, kind: "transform" },
      { parent: 0, kind: "light", colors: [[1, 0.5, 0, 1], [0.5, 0.5, 0.5, 1], [1, 1, 1, 1]] },
      { parent: 0, kind: "mesh", load: "models/a.obj", file: "mesh/0af3/0", scale: [1, 2, 3], materials: ["red", "blue"], visible: true, ...node },
    ],
    materials: [red], ...more,
  };
}

/// A mesh file with one triangle of each material, as the host sends it.
function meshFile(materials: string[], head: Record<string, unknown> = {}): ArrayBuffer {
  const text = JSON.stringify({ parts: materials.map(material => ({ material, corners: 3 })), materials: [{ ...red, name: "own" }], ...head });
  const padded = text.padEnd(Math.ceil(text.length / 4) * 4, " ");
  const bytes = new ArrayBuffer(4 + padded.length + materials.length * 96);
  new DataView(bytes).setUint32(0, padded.length, true);
  new Uint8Array(bytes).set(new TextEncoder().encode(padded), 4);
  const floats = new Float32Array(bytes, 4 + padded.length);
  for (let k = 0; k < 3 * materials.length; k++) floats.set([k % 3 === 1 ? 2 : 0, k % 3 === 2 ? 4 : 0, 0, 0, 0, 1, 0, 0], 8 * k);
  return bytes;
}

describe("scene messages", () => {
  it("have the colours of lights and of the materials that the host knows", () => {
    const { nodes } = readScene(message())!;
    expect(nodes[1]!.colors![0]).toEqual([1, 0.5, 0, 1]);
    expect(nodes[2]!.looks).toEqual([red, null]);
    expect(nodes[2]!.file).toBe("mesh/0af3/0");
  });

  it("have the host's default for other materials, if it has one", () => {
    const usual = { ...red, name: "default" };
    expect(readScene(message({ materials: [red, usual] }))!.nodes[2]!.looks).toEqual([red, usual]);
  });

  it("of older recordings have none, and are shown", () => {
    const { nodes } = readScene(message({ materials: undefined }, { file: undefined }))!;
    expect(nodes[2]!.looks).toBeUndefined();
    expect(nodes[2]!.file).toBeUndefined();
  });

  it.each(["https://elsewhere.example/mesh/0/1", "//elsewhere.example/0", "mesh/0/1/../../logs/x", "/mesh/0/1", "logs/x", 7])("do not make the page fetch %s", file => {
    expect(readScene(message({ materials: [{ ...red, picture: file }] }, { file }))!.nodes[2]).toMatchObject({ looks: [red, null] });
    expect(readScene(message({}, { file }))!.nodes[2]!.file).toBeUndefined();
  });

  it("without a colour of a material leave that material out", () => {
    expect(readScene(message({ materials: [{ ...red, ambient: [1, 2] }, 7] }))!.nodes[2]!.looks).toBeUndefined();
  });

  it("differ if a colour does", () => {
    const of = (materials: unknown[]) => makeScene(readScene(message({ materials }))!.nodes).nodes;
    expect(sameNodes(of([red]), of([red]))).toBe(true);
    expect(sameNodes(of([red]), of([{ ...red, shininess: 21 }]))).toBe(false);
  });
});

describe("materials", () => {
  it("have the host's colour, except those of teams", () => {
    expect(materialColour("matGreen", usualTeams, red)).toEqual([0.8, 0.1, 0.1]);
    expect(materialColour("matLeft3", usualTeams, red)).toBe(usualTeams.left);
  });

  it("of logs have the colours of lua/materials.lua", () => {
    // The build tree has a copy of the tests, but not of the rest.
    const sources = process.env.SPARK_SOURCES ?? fileURLToPath(new URL("../../../..", import.meta.url));
    const lua = readFileSync(`${sources}/lua/materials.lua`, "utf8");
    const entry = /(?:\["([^"]+)"\]|\b(\w+)) *= *\{ *([\d.]+), *([\d.]+), *([\d.]+)(?:, *[\d.]+)? *\}/g;
    const said = new Map([...lua.matchAll(entry)].map(([, quoted, plain, r, g, b]) => [quoted ?? plain!, [Number(r), Number(g), Number(b)]]));
    expect(said.size).toBeGreaterThan(20);
    for (const [name, colour] of Object.entries(usualMaterials)) expect(colour, name).toEqual(said.get(name));
    for (const name of said.keys()) if (/^mat(?!Left|Right|Type)/.test(name)) expect(usualMaterials, name).toHaveProperty(name);
  });
});

describe("mesh files", () => {
  const file = readMeshFile(meshFile(["blue", "own"]));

  it("have parts, bounds and materials", () => {
    expect(file.parts.map(({ material, geometry }) => [material, geometry.getAttribute("position").count])).toEqual([["blue", 3], ["own", 3]]);
    expect(file.bounds.max.toArray()).toEqual([2, 4, 0]);
    expect(file.materials.get("own")!.shininess).toBe(20);
  });

  it("that are cut off or damaged are errors", () => {
    const whole = meshFile(["blue"]);
    for (const size of [0, 3, 10, whole.byteLength - 1]) expect(() => readMeshFile(whole.slice(0, size))).toThrow();
    expect(() => readMeshFile(meshFile(["blue"], { parts: [{ material: "x", corners: -3 }] }))).toThrow();
    expect(() => readMeshFile(meshFile(["blue"], { parts: [{ material: "x", corners: 1e9 }] }))).toThrow();
  });

  it("are shown in the place of shapes once they are loaded, and shared", () => {
    const scene = new SyntheticWorld();
    const load = (more: Partial<SceneNode>) => scene.mesh(scene.transform(-1), "models/a.obj", { file: "mesh/0/1", scale: [2, 1, 1], materials: ["blue"], ...more });
    const [a] = [load({ looks: [red] }), load({ single: true, transparent: true, looks: [red] })];
    const world = scene.world();
    expect(makePicture(world).models).toEqual([]);
    expect(makePicture(world).pieces).toHaveLength(2);
    const { pieces, models } = makePicture(world, usualTeams, { mesh: () => file, solid: () => null });
    expect(pieces).toEqual([]);
    expect(models.map(model => model.file)).toEqual([file, file]);
    expect(models[0]).toMatchObject({ mesh: a, centre: [2, 2, 0], half: [2, 2, 0] });
    expect(models[0]!.dresses.map(({ look, opacity }) => [look?.name, opacity])).toEqual([["red", 1], ["own", 1]]);
    expect(models[1]!.dresses.map(({ look, opacity }) => [look?.name, opacity])).toEqual([["red", 0.5], ["red", 0.5]]);
  });

  it("solids with a texture have triangles along z, equal ones the same", () => {
    const scene = new SyntheticWorld(), solids = new TexturedSolids();
    for (let n = 0; n < 2; n++) scene.mesh(scene.transform(-1), "StdUnitCylinder 0.1 2", { materials: ["red"], looks: [{ ...red, picture: "texture/0/1" }] });
    const { models } = makePicture(scene.world(), usualTeams, { mesh: () => null, solid: shape => solids.of(shape) });
    expect(models[0]!.file).toBe(models[1]!.file);
    expect(models[0]!.half[2]).toBeCloseTo(1);
  });
});

describe("lights", () => {
  const world = (...lights: SceneNode["colors"][]) => {
    const scene = new SyntheticWorld();
    const lamp = scene.transform(-1, [1, 2, 3]);
    const { nodes, ...rest } = scene.world();
    return { ...rest, nodes: [...nodes, ...lights.map((colors): SceneNode => ({ parent: lamp, kind: "light", colors }))] };
  };
  const dark: SceneNode["colors"] = [[0, 0, 0, 1], [0, 0, 0, 1], [1, 1, 1, 1]];

  it("that light nothing are none", () => {
    expect(Lamps.of(world(), "flat")).toBeNull();
    expect(Lamps.of(world(dark, undefined), "flat")).toBeNull();
  });

  it("shine from their places: direct light of eight, ambient light of all", () => {
    const lamps = Lamps.of(world(dark, ...Array.from({ length: 9 }, (): SceneNode["colors"] => [[1, 0, 0, 1], [0.1, 0, 0, 1], [0, 0, 0, 1]])), "flat")!;
    expect(lamps.uniforms.lamps.value).toHaveLength(8);
    const worlds = new Float32Array(16 * 11);
    worlds.set([1, 2, 3], 16 * 2 + 12);
    lamps.update(worlds);
    expect(lamps.uniforms.lamps.value[0]!.toArray()).toEqual([1, 2, 3]);
    expect(lamps.base([1, 1, 1], red)[0]).toBeCloseTo(0.9 * 0.3);
    expect(lamps.base([1, 1, 1], red)[2]).toBeCloseTo(0.1);
  });

  it("do not matter in plain light, emission does", () => expect(baseOf(null, [1, 1, 1], red)).toEqual([0, 0, 0.1]));
});
