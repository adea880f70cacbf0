/// Creates logs for tests in both formats: a ball, a humanoid's torso with head, a sphere robot.

export type List = (string | number | List)[];

export const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

export function at(x: number, y: number, z: number, yaw = 0): number[] {
  const c = Math.cos(yaw), s = Math.sin(yaw);
  return [c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x, y, z, 1];
}

export const transform = (matrix: number[], ...children: List[]): List => ["nd", "TRF", ["SLT", ...matrix], ...children];
export const mesh = (load: string, scale: number[], ...materials: string[]): List => ["nd", "StaticMesh", ["setVisible", 1], ["load", load], ["sSc", ...scale], ["resetMaterials", ...materials]];
export const simple = (load: string, scale: number[], material: string): List => ["nd", "SMN", ["setVisible", 1], ["load", ...load.split(" ")], ["sSc", ...scale], ["sMat", material]];

export const kModes: List = ["play_modes", "BeforeKickOff", "KickOff_Left", "KickOff_Right", "PlayOn", "KickIn_Left", "Goal_Left"];

/// Nodes 0, 1: the ball; 2..7: left 3, a humanoid (torso 3, head 6); 8..10: a sphere (torso 9).
export function scene(ballX: number, robotX: number, yaw = 0, team = "matLeft", number = "matNum3"): List[] {
  return [
    transform(at(ballX, 0, 0.04), mesh("models/soccerball.obj", [0.042, 0.042, 0.042], "soccerball_rcs-soccerball.png")),
    transform(
      kIdentity,
      transform(at(robotX, 1, 0.4, yaw), transform(kIdentity, mesh("models/naobody0.obj", [0.1, 0.1, 0.1], number, team, "naowhite"))),
      transform(at(robotX, 1, 0.6), transform(kIdentity, mesh("models/naohead.obj", [0.1, 0.1, 0.1], team, "naowhite"))),
    ),
    transform(kIdentity, transform(at(5, 5, 0.2), simple("StdUnitSphere", [0.22, 0.22, 0.22], "matRight"))),
  ];
}

/// The nodes of a partial message for scene(); null means unchanged.
export function changes(ball: number[] | null, torso: number[] | null, visible: number | null = null): List[] {
  const moved = (matrix: number[] | null, ...children: List[]): List => ["nd", ...(matrix ? [["SLT", ...matrix]] : []), ...children];
  const shown: List[] = visible === null ? [] : [["setVisible", visible]];
  return [
    moved(ball, ["nd", "StaticMesh", ...shown]),
    ["nd", moved(torso, ["nd", ["nd", "StaticMesh"]]), ["nd", ["nd", ["nd", "StaticMesh"]]]],
    ["nd", ["nd", ["nd", "SMN"]]],
  ];
}

const words = (list: List): string => `(${list.map((e) => (Array.isArray(e) ? words(e) : String(e))).join(" ")})`;

export function sexp(full: boolean, environment: List[], nodes: List[]): string {
  return `${words(environment)}(${full ? "RSG" : "RDS"} 0 1)${words(nodes)}`;
}

export function json(full: boolean, environment: List[], nodes: List[]): string {
  return JSON.stringify([environment, [full ? "RSG" : "RDS", 0, 1], nodes]);
}

export const log = (...lines: string[]): Blob => new Blob([lines.map((line) => line + "\n").join("")]);
