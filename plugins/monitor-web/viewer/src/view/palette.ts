import type { Material, Side } from "../model";
import type { Theme } from "./stage";

/// A colour as it is written to the screen (sRGB), each 0..1.
export type Rgb = readonly [number, number, number];

export function rgb(hex: number): Rgb {
  return [((hex >> 16) & 255) / 255, ((hex >> 8) & 255) / 255, (hex & 255) / 255];
}

/// "#rrggbb"
export function css(colour: Rgb): string {
  return "#" + colour.map(c => Math.round(c * 255).toString(16).padStart(2, "0")).join("");
}

/// Relative luminance of a colour as in WCAG 2, 0..1.
export function luminance(colour: Rgb): number {
  const [r, g, b] = colour.map(c => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
}

/// Blue against orange: distinguishable with every kind of colour blindness and in greyscale, because one is dark and
/// the other bright.
export interface TeamColours {
  left: Rgb;
  right: Rgb;
}

export const usualTeams: TeamColours = { left: rgb(0x1f5fd6), right: rgb(0xffa21a) };

const noTeam = rgb(0x9aa3ad);

export function teamColour(side: Side | null, teams = usualTeams): Rgb {
  return side === null ? noTeam : teams[side];
}

/// The text colour for a background: black or white, whichever has more contrast.
export function inkOn(colour: Rgb): Rgb {
  return luminance(colour) > 0.18 ? rgb(0x14181d) : rgb(0xffffff);
}

/// Parts of robots without a team colour.
export const robot = { shell: rgb(0xf2f4f5), joint: rgb(0x3a4048), sole: rgb(0x555d66), visor: rgb(0x15181c), eye: rgb(0x7fe3ff) };

/// The colours of lua/materials.lua, for logs and recordings that do not contain those of their host.
export const usualMaterials: Record<string, Rgb> = {
  matYellow: [1, 1, 0], matOrange: [1, 0.03, 0], matRed: [1, 0, 0], matRedGlow: [1, 0, 0], matMagenta: [1, 0, 0.75], matBlue: [0, 0, 1], matLightBlue: [0, 0.75, 1],
  matGreen: [0.1, 0.6, 0.1], matSelect: [1, 0, 0], matWhite: [1, 1, 1], matGrey: [0.2, 0.2, 0.2], matDarkGrey: [0.05, 0.05, 0.05], matBall: [1, 1, 1], matTrack: [0.6, 0.3, 0.2],
  matGrass: [0.1, 0.5, 0.1], matTeam: [0.5, 0.5, 0.5], matNum: [0.9, 0.9, 0.9], naoblack: [0.1, 0.1, 0.1], naogrey: [0.5, 0.5, 0.5], naowhite: [1, 1, 1],
};

const nameless = rgb(0x8b939c);
const others = [0x6f8fb0, 0xb08f6f, 0x7fa37a, 0xa37a9c, 0x8d86c4, 0xbba35f].map(rgb);

/// True for materials in the colour of a team.
export function isOfTeam(material: string): boolean {
  return /^mat(Left|Right)/.test(material);
}

/// The colour of a material: that of the team, or what the host says. An unknown name is mapped to one of a few muted
/// colours, always to the same one.
export function materialColour(name: string | undefined, teams = usualTeams, look: Material | null = null): Rgb {
  if (name?.startsWith("matLeft")) return teams.left;
  if (name?.startsWith("matRight")) return teams.right;
  if (look) return [look.diffuse[0], look.diffuse[1], look.diffuse[2]];
  if (!name) return nameless;
  const known = usualMaterials[name];
  if (known) return known;
  const coded = /^rgb([0-9a-f]{6})$/.exec(name); // what importers make of a file's colours
  if (coded) return rgb(parseInt(coded[1]!, 16));
  if (name.startsWith("matNum")) return usualMaterials.matNum!;
  let hash = 0;
  for (const letter of name) hash = (hash * 31 + letter.charCodeAt(0)) >>> 0;
  return others[hash % others.length]!;
}

/// Colours of the surroundings.
export interface Surroundings {
  zenith: Rgb;
  horizon: Rgb;
  /// The ground beyond the grass.
  floor: Rgb;
  /// The same further away, where it is darker.
  floorFar: Rgb;
  floorLine: Rgb;
  grass: Rgb;
  /// Every second mown stripe.
  grassAlternate: Rgb;
  /// Walls around the ground.
  wall: Rgb;
  line: Rgb;
  net: Rgb;
  /// Strength of light from above, from below, and of the sun, in flat mode.
  above: number;
  below: number;
  sun: number;
}

export const surroundings: Record<Theme, Surroundings> = {
  dark: {
    zenith: rgb(0x0a101b), horizon: rgb(0x24344a), floor: rgb(0x34404e), floorFar: rgb(0x151b23), floorLine: rgb(0x465466), grass: rgb(0x2c7038), grassAlternate: rgb(0x327a3f),
    wall: rgb(0x3d4d63), line: rgb(0xf2f5f2), net: rgb(0xdfe6ec), above: 0.62, below: 0.34, sun: 0.46,
  },
  light: {
    zenith: rgb(0x77aede), horizon: rgb(0xe4eef5), floor: rgb(0xc9cfca), floorFar: rgb(0xb3bab6), floorLine: rgb(0xb0b8b3), grass: rgb(0x4a9a4e), grassAlternate: rgb(0x55a758),
    wall: rgb(0xa4b4bf), line: rgb(0xffffff), net: rgb(0xf5f8fa), above: 0.7, below: 0.42, sun: 0.45,
  },
};
