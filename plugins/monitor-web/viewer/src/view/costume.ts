import type { Robot, Shape } from "../model";
import { compose } from "./affine";
import { materialColour, robot as colours, teamColour, type Rgb, type TeamColours } from "./palette";

/// Decorative shapes of a robot's part, around the shapes in the scene. A robot looks towards +y; +x is its right.
export interface Dress {
  parts: { shape: Shape; colour: Rgb; rounding?: number }[];
  decals: { matrix: number[]; size: number }[];
}

type Part = "body" | "head" | "upperarm" | "lowerarm" | "thigh" | "shank" | "foot";

/// Meshes of objects that the view draws itself: ground, sky, goals, ball.
export function isSceneryMesh(name: string): boolean {
  return /soccerfield|skybox|soccergoal|soccerball/.test(name);
}

/// "models/naobody3.obj" is a body, "models/rlowerarm.obj" a lower arm.
function partOf(name: string): Part | null {
  const match = /^models\/(?:nao|[lr])(body|head|upperarm|lowerarm|thigh|shank|foot)\d?\.obj$/.exec(name);
  return match ? (match[1] as Part) : null;
}

/// The decoration of a robot's part; null if it has none.
export function dress(name: string, shapes: readonly Shape[], robot: Robot, materials: readonly string[], teams: TeamColours): Dress | null {
  const part = partOf(name);
  const core = shapes[0];
  if (!part || !core) return null;
  return new Tailor(core, robot.side ? teamColour(robot.side, teams) : teamOf(materials, teams)).make(part);
}

function teamOf(materials: readonly string[], teams: TeamColours): Rgb {
  return materialColour(materials.find(name => /^mat(Left|Right|Team)/.test(name)) ?? "matTeam", teams);
}

/// Scales the decoration of a part to the size of its shape.
class Tailor {
  private readonly dress: Dress = { parts: [], decals: [] };

  constructor(private readonly core: Shape, private readonly team: Rgb) {}

  make(part: Part): Dress {
    this[part]();
    return this.dress;
  }

  private body(): void {
    const [x, y, z] = this.box();
    this.block([1.5 * x, 1.06 * y, 0.66 * z], [0, 0, 0.17 * z], this.team, 0.032);
    this.block([1.06 * x, 0.9 * y, 0.5 * z], [0, -0.02 * y, -0.3 * z], colours.joint, 0.025);
    this.block([1.14 * x, 0.98 * y, 0.2 * z], [0, 0, -0.42 * z], colours.shell, 0.017);
    this.number([0, 0.54 * y, 0.19 * z], 0.52 * z, false);
    this.number([0, -0.54 * y, 0.19 * z], 0.52 * z, true);
  }

  private head(): void {
    const r = this.core.kind === "sphere" ? this.core.size[0]! : Math.min(...this.box()) / 2;
    this.part({ kind: "sphere", size: [r] }, [0, 0, 0], colours.shell);
    this.block([1.42 * r, 0.6 * r, 0.62 * r], [0, 0.72 * r, 0.02 * r], colours.visor, 0.28 * r);
    for (const side of [1, -1]) {
      this.part({ kind: "sphere", size: [0.13 * r] }, [side * 0.36 * r, 0.97 * r, 0.05 * r], colours.eye);
      this.part({ kind: "cylinder", size: [0.44 * r, 0.3 * r] }, [side * 0.96 * r, 0, 0.05 * r], this.team, [0, Math.SQRT1_2, 0, Math.SQRT1_2]);
    }
  }

  private upperarm(): void {
    const [x, y, z] = this.box();
    this.block([0.92 * x, 1.1 * y, 1.05 * z], [0, 0, 0], colours.shell, 0.024);
  }

  private lowerarm(): void {
    const [x, y, z] = this.box();
    this.block([x, 0.8 * y, z], [0, -0.06 * y, 0], this.team, 0.018);
    this.part({ kind: "sphere", size: [0.52 * x] }, [0, 0.4 * y, 0], colours.joint);
  }

  private thigh(): void {
    const [x, y, z] = this.box();
    this.block([0.98 * x, 1.02 * y, 0.98 * z], [0, 0, 0], colours.shell, 0.026);
  }

  private shank(): void {
    const [x, y, z] = this.box();
    this.block([0.9 * x, 0.98 * y, 1.04 * z], [0, 0, 0], this.team, 0.024);
  }

  private foot(): void {
    const [x, y, z] = this.box();
    this.block([1.02 * x, 1.02 * y, 0.8 * z], [0, 0, -0.1 * z], colours.sole, 0.007);
    this.block([0.92 * x, 0.92 * y, 1.9 * z], [0, 0, 0.75 * z], colours.shell, 0.016);
  }

  private box(): [number, number, number] {
    const [a = 0.1, b = a, c = a] = this.core.size;
    return this.core.kind === "box" ? [a, b, c] : [2 * a, 2 * a, 2 * a];
  }

  private block(size: number[], position: number[], colour: Rgb, rounding: number): void {
    this.part({ kind: "box", size }, position, colour, undefined, rounding);
  }

  private part(form: Pick<Shape, "kind" | "size">, offset: number[], colour: Rgb, rotation: Shape["rotation"] = [0, 0, 0, 1], rounding?: number): void {
    const position = offset.map((x, axis) => x + this.core.position[axis]!) as Shape["position"];
    this.dress.parts.push({ shape: { ...form, position, rotation }, colour, ...(rounding === undefined ? {} : { rounding }) });
  }

  private number(offset: number[], size: number, behind: boolean): void {
    const matrix = new Array<number>(16);
    compose(matrix, 0, offset.map((x, axis) => x + this.core.position[axis]!), behind ? [0, 0, 0, 1] : [0, 0, 1, 0]);
    this.dress.decals.push({ matrix, size });
  }
}
