import { describe, expect, it } from "vitest";
import { compose, multiply, toLocal } from "../src/view/affine";
import { fieldLines, fieldSizes, stripes } from "../src/view/field_sizes";
import { barrel, roundedBox } from "../src/view/forms";
import { goalPieces, hasNetGoals, isInGoal } from "../src/view/goals";
import { levelFor, levels } from "../src/view/levels";
import { luminance, materialColour, surroundings, teamColour, usualTeams } from "../src/view/palette";
import { makePicture, pieceOf, standardShape } from "../src/view/pieces";
import { hitBox } from "../src/view/ray";
import { WorldMatrices } from "../src/view/world_matrices";
import { SyntheticWorld } from "./synthetic";

const quarterTurn: [number, number, number, number] = [0, 0, Math.SQRT1_2, Math.SQRT1_2];

describe("matrices", () => {
  it("rotate before they translate", () => {
    const a: number[] = [], b: number[] = [], c = new Array<number>(16).fill(0);
    compose(a, 0, [1, 2, 3], quarterTurn);
    compose(b, 0, [1, 0, 0], [0, 0, 0, 1]);
    multiply(c, 0, a, 0, b, 0);
    expect(c[12]).toBeCloseTo(1);
    expect(c[13]).toBeCloseTo(3);
    expect(c[14]).toBeCloseTo(3);
    const back: [number, number, number] = [0, 0, 0];
    toLocal(a, 0, [1, 3, 3], back);
    expect(back[0]).toBeCloseTo(1);
    expect(back[1]).toBeCloseTo(0);
  });

  it("in the world include the parents', and meshes use that of their transform", () => {
    const scene = new SyntheticWorld();
    const a = scene.transform(-1, [1, 0, 0]), b = scene.transform(a, [0, 2, 0]), mesh = scene.mesh(b, "StdUnitBox");
    const world = scene.world();
    const matrices = new WorldMatrices();
    matrices.rebuild(world.nodes);
    matrices.update(world.local);
    expect([...matrices.values.slice(16 * b + 12, 16 * b + 15)]).toEqual([1, 2, 0]);
    expect([...matrices.values.slice(16 * mesh + 12, 16 * mesh + 15)]).toEqual([1, 2, 0]);
    expect(matrices.values[16 * world.nodes.length]).toBe(1);
  });
});

describe("forms", () => {
  it.each([1, 2, 5])("a rounded box of %i segments is closed and faces outwards", segments => expectClosed(roundedBox(segments)));
  it.each([6, 13])("a barrel of %i sides is closed and faces outwards", sides => expectClosed(barrel(sides)));

  it("get finer with their size in the picture", () => {
    for (const form of ["block", "round", "barrel"] as const) {
      const counts = levels[form].map(level => level.make().index!.count);
      expect(counts).toEqual([...counts].sort((a, b) => a - b));
      expect(levelFor(form, 1)).toBe(0);
      expect(levelFor(form, 1e9)).toBe(levels[form].length - 1);
    }
  });
});

/// Every edge belongs to two triangles, once in each direction, and the volume is positive.
function expectClosed(geometry: ReturnType<typeof barrel>): void {
  const position = geometry.getAttribute("position"), index = geometry.index!.array;
  const edges = new Map<string, number>();
  let volume = 0;
  const point = (k: number) => [position.getX(k), position.getY(k), position.getZ(k)] as const;
  const name = (k: number) => point(k).map(x => Math.round(x * 1e4) + 0).join();
  for (let t = 0; t < index.length; t += 3) {
    const [a, b, c] = [index[t]!, index[t + 1]!, index[t + 2]!];
    for (const [p, q] of [[a, b], [b, c], [c, a]] as const) edges.set(`${name(p)} ${name(q)}`, (edges.get(`${name(p)} ${name(q)}`) ?? 0) + 1);
    const [[ax, ay, az], [bx, by, bz], [cx, cy, cz]] = [point(a), point(b), point(c)];
    volume += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6;
  }
  for (const edge of edges.keys()) expect(edges.get(edge.split(" ").reverse().join(" ")), edge).toBe(edges.get(edge));
  expect(volume).toBeGreaterThan(3);
  expect(volume).toBeLessThan(8);
}

describe("pieces", () => {
  it("scale forms to the shapes of the scene", () => {
    const shape = { position: [0, 0, 0], rotation: [0, 0, 0, 1] } as const;
    const grey = materialColour("matGrey");
    expect(pieceOf({ ...shape, kind: "capsule", size: [0.1, 0.4] } as never, 0, -1, grey)).toMatchObject({ form: "round", half: [0.1, 0.1, 0.30000000000000004], rounding: 0.1 });
    expect(pieceOf({ ...shape, kind: "box", size: [2, 4, 6] } as never, 0, -1, grey)).toMatchObject({ form: "block", half: [1, 2, 3] });
    expect(pieceOf({ ...shape, kind: "box", size: [0.01, 4, 6] } as never, 0, -1, grey, 0.5).rounding).toBe(0.005);
    expect(standardShape("StdCapsule", [0.02, 0.1], [1, 1, 2])).toMatchObject({ kind: "capsule", size: [0.02, 0.2] });
    expect(standardShape("models/x.obj", [], [1, 1, 1])).toBeNull();
  });

  it("give humanoids their team's color, with numbers in front and behind", () => {
    const scene = new SyntheticWorld();
    const other = scene.humanoid("left", 3, 0, 0), robot = scene.humanoid("right", 4, 1, 0);
    const picture = makePicture(scene.world());
    const colours = (torso: number) => new Set(picture.pieces.filter(piece => piece.node === torso).map(piece => piece.colour));
    expect(colours(robot.torso)).toContain(usualTeams.right);
    expect(colours(other.torso)).toContain(usualTeams.left);
    expect(colours(robot.torso)).not.toContain(usualTeams.left);
    expect(picture.decals.map(decal => decal.robot)).toEqual([0, 0, 1, 1]);
    expect(picture.robotOf[robot.head]).toBe(1);
  });

  it("omit ground, goals, ball and hidden shapes", () => {
    const scene = new SyntheticWorld();
    const at = scene.transform(-1, [0, 0, 0], { shapes: [{ kind: "box", size: [1, 1, 1], position: [0, 0, 0], rotation: [0, 0, 0, 1] }] });
    scene.mesh(scene.transform(-1), "models/naosoccerfield.obj");
    scene.mesh(scene.transform(at), "models/leftsoccergoal.obj");
    const ball = scene.transform(-1);
    scene.mesh(ball, "StdUnitSphere");
    const world = { ...scene.world(), ball };
    expect(makePicture(world).pieces).toEqual([]);
    expect(hasNetGoals(world)).toBe(true);
  });

  it("show selection markers as rings, unknown models as boxes", () => {
    const scene = new SyntheticWorld();
    scene.mesh(scene.transform(-1), "StdUnitCylinder 1 1", { scale: [0.2, 0.2, 0.02], materials: ["matSelect"], transparent: true });
    scene.mesh(scene.transform(-1), "models/rocket.obj", { scale: [0.5, 0.5, 2] });
    const picture = makePicture(scene.world());
    expect(picture.marks).toMatchObject([{ radius: 0.2 }]);
    expect(picture.pieces).toMatchObject([{ form: "block", half: [0.25, 0.25, 1] }]);
  });
});

describe("the field", () => {
  const environment: [string, number][] = [["FieldLength", 30], ["FieldWidth", 20], ["GoalWidth", 2.1], ["FreeKickDistance", 2], ["PenaltyAreaLength", 1.8], ["PenaltyAreaWidth", 6]];

  it("has the sizes of the environment", () => {
    expect(fieldSizes(new Map())).toBeNull();
    const field = fieldSizes(new Map(environment))!;
    const points = fieldLines(field).flat();
    expect(Math.max(...points.map(point => point[0]))).toBe(15);
    expect(points).toContainEqual([13.2, 3]);
    expect(points).toContainEqual([-13.2, -3]);
    expect(points.filter(([x, y]) => Math.abs(Math.hypot(x, y) - 2) < 1e-9)).toHaveLength(65);
  });

  it("has stripes from edge to edge without gaps", () => {
    const field = fieldSizes(new Map(environment))!;
    const rows = stripes(field);
    rows.slice(1).forEach((row, k) => expect(row.from).toBeCloseTo(rows[k]!.to));
    expect(rows.at(-1)!.to).toBeCloseTo(15 + field.margin);
  });

  it("has goal posts outside the goal mouths", () => {
    const field = fieldSizes(new Map(environment))!;
    expect([isInGoal(field, 15.2, 1), isInGoal(field, -15.2, -1), isInGoal(field, 14, 0), isInGoal(field, 15.2, 3), isInGoal(field, 25, 0)]).toEqual([true, true, false, false, false]);
    for (const { matrix, half } of goalPieces(field, 0)) {
      const isPost = half[2] > 0.3 && Math.abs(matrix[10]!) > 0.9 && Math.abs(Math.abs(matrix[12]!) - 15) < 0.2;
      if (isPost) expect(Math.abs(matrix[13]!) - half[0]).toBeGreaterThanOrEqual(1.05 - 1e-9);
    }
  });
});

describe("colors", () => {
  it("of the teams differ in brightness, and lines from the grass", () => {
    const contrast = (a: number, b: number) => (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    expect(contrast(luminance(teamColour("left")), luminance(teamColour("right")))).toBeGreaterThan(2.5);
    for (const { grass, line } of Object.values(surroundings)) expect(contrast(luminance(grass), luminance(line))).toBeGreaterThan(3);
  });

  it("of materials follow the team, and are equal for equal names", () => {
    const teams = { left: [1, 0, 0], right: [0, 1, 0] } as const;
    expect(materialColour("matLeft7", teams)).toBe(teams.left);
    expect(materialColour("somebody's")).toBe(materialColour("somebody's"));
  });
});

describe("rays", () => {
  const matrix = new Float32Array(16);
  compose(matrix, 0, [0, 0, 5], quarterTurn);

  it("hit boxes at their position and orientation", () => {
    expect(hitBox([0, 0, 0], [0, 0, 1], matrix, 0, [1, 2, 3], 0)).toBeCloseTo(2);
    expect(hitBox([1.5, 0, 0], [0, 0, 1], matrix, 0, [1, 2, 3], 0)).toBeCloseTo(2);
    expect(hitBox([0, 1.5, 0], [0, 0, 1], matrix, 0, [1, 2, 3], 0)).toBe(Infinity);
    expect(hitBox([0, 1.5, 0], [0, 0, 1], matrix, 0, [1, 2, 3], 0.6)).toBeCloseTo(1.4);
    expect(hitBox([0, 0, 20], [0, 0, 1], matrix, 0, [1, 2, 3], 0)).toBe(Infinity);
  });
});
