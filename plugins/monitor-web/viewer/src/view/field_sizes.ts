import type { Environment } from "../model";

/// Sizes of a soccer field [m]; the centre is the origin, the goals are at +-length/2.
export interface FieldSizes {
  length: number;
  width: number;
  goalWidth: number;
  goalDepth: number;
  goalHeight: number;
  circle: number;
  penaltyLength: number;
  penaltyWidth: number;
  /// Width of a line.
  lineWidth: number;
  /// Width of the grass beyond the lines.
  margin: number;
}

/// Sizes from the environment. Missing sizes are computed with the proportions of the 3D league. null: there is no
/// field.
export function fieldSizes(environment: Environment): FieldSizes | null {
  const number = (name: string) => {
    const value = environment.get(name);
    return typeof value === "number" && value > 0 ? value : undefined;
  };
  const length = number("FieldLength"), width = number("FieldWidth");
  if (length === undefined || width === undefined) return null;
  const goalWidth = number("GoalWidth") ?? 0.07 * length;
  return {
    length, width, goalWidth,
    goalDepth: number("GoalDepth") ?? 0.3 * goalWidth,
    goalHeight: number("GoalHeight") ?? 0.38 * goalWidth,
    circle: number("FreeKickDistance") ?? length / 15,
    penaltyLength: number("PenaltyAreaLength") ?? 0.06 * length,
    penaltyWidth: number("PenaltyAreaWidth") ?? goalWidth + 0.195 * width,
    lineWidth: Math.max(0.05, 0.0013 * length),
    margin: Math.max(1, 0.07 * length),
  };
}

export type Point = [number, number];

/// The lines of a field as polylines; that of the circle is closed.
export function fieldLines(f: FieldSizes): Point[][] {
  const [x, y] = [f.length / 2, f.width / 2];
  const lines: Point[][] = [
    [[-x, -y], [x, -y]], [[x, -y], [x, y]], [[x, y], [-x, y]], [[-x, y], [-x, -y]], [[0, -y], [0, y]],
    Array.from({ length: 65 }, (_, k) => [f.circle * Math.cos((k * Math.PI) / 32), f.circle * Math.sin((k * Math.PI) / 32)] as Point),
  ];
  for (const side of [-1, 1]) {
    const [front, half] = [side * (x - f.penaltyLength), f.penaltyWidth / 2];
    lines.push([[side * x, -half], [front, -half]], [[front, -half], [front, half]], [[front, half], [side * x, half]]);
  }
  return lines;
}

/// Twelve stripes between the goal lines; the outermost ones extend to the edge of the grass.
export function stripes(field: FieldSizes): { from: number; to: number; alternate: boolean }[] {
  const width = field.length / 12;
  return Array.from({ length: 12 }, (_, k) => ({
    from: -field.length / 2 + k * width - (k === 0 ? field.margin : 0),
    to: -field.length / 2 + (k + 1) * width + (k === 11 ? field.margin : 0),
    alternate: k % 2 === 1,
  }));
}
