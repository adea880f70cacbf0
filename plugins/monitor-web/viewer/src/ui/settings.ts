/// What this viewer's owner chose, kept in the browser.
import type { CameraMode, Quality, Theme } from "./app";

export interface Palette {
  name: string;
  /// #rrggbb
  left: string;
  right: string;
}

/// Pairs that people with any kind of colour vision can tell apart: they differ in lightness, or in blue against yellow.
/// The first one gives way to the teams' own names: Red is not to play in blue.
export const kPalettes: readonly Palette[] = [
  { name: "Blue and orange", left: "#1f5fd6", right: "#ffa21a" },
  { name: "Blue and red", left: "#1f5fd6", right: "#f4593b" },
  { name: "Sky and vermilion", left: "#62bdf0", right: "#d9560b" },
  { name: "Violet and gold", left: "#8a6cf0", right: "#edc22e" },
  { name: "Green and pink", left: "#0b7a5b", right: "#f2a9d2" },
];

/// The chosen pair; or, while that is the first one, the pair whose colours are the teams' names, the right way round.
export function paletteFor(chosen: number, leftTeam: string, rightTeam: string): Palette {
  const names = [leftTeam, rightTeam].map((team) => team.toLowerCase());
  for (const palette of chosen === 0 ? kPalettes : []) {
    const words = palette.name.toLowerCase().split(" and ");
    if (words[0] === names[0] && words[1] === names[1]) return palette;
    if (words[0] === names[1] && words[1] === names[0]) return { name: `${leftTeam} and ${rightTeam}`, left: palette.right, right: palette.left };
  }
  return kPalettes[chosen]!;
}

export interface Settings {
  theme: Theme | "system";
  quality: Quality;
  labels: boolean;
  view: CameraMode;
  /// Index in kPalettes.
  palette: number;
}

export const kDefaults: Settings = { theme: "system", quality: "flat", labels: true, view: "broadcast", palette: 0 };

const kKey = "spark-viewer";

/// What was kept, with defaults for what is missing or makes no sense.
export function settingsFrom(text: string | null): Settings {
  let kept: Record<string, unknown> = {};
  try {
    const parsed: unknown = JSON.parse(text ?? "{}");
    if (parsed && typeof parsed === "object") kept = parsed as Record<string, unknown>;
  } catch {
    // an older or foreign text: begin anew
  }
  const one = <T>(value: unknown, allowed: readonly T[], otherwise: T): T => (allowed.includes(value as T) ? (value as T) : otherwise);
  return {
    theme: one(kept.theme, ["system", "dark", "light"], kDefaults.theme),
    quality: one(kept.quality, ["flat", "quality"], kDefaults.quality),
    labels: one(kept.labels, [true, false], kDefaults.labels),
    view: one(kept.view, ["orbit", "broadcast", "head", "top"], kDefaults.view),
    palette: one(kept.palette, [...kPalettes.keys()], kDefaults.palette),
  };
}

export function loadSettings(): Settings {
  try {
    return settingsFrom(localStorage.getItem(kKey));
  } catch {
    return { ...kDefaults };   // no storage in private windows
  }
}

export function keepSettings(settings: Settings): void {
  try {
    localStorage.setItem(kKey, JSON.stringify(settings));
  } catch {
    // then it lasts as long as the page
  }
}
