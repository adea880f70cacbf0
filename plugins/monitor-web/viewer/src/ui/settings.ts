/// The user's settings, stored in the browser.
import type { CameraMode, Lights, Quality, Theme } from "./app";

export interface Palette {
  name: string;
  /// #rrggbb
  left: string;
  right: string;
}

/// Colour pairs that are distinguishable with any kind of colour vision: they differ in lightness or along the
/// blue-yellow axis. With the first pair, teams that are named after colours get those colours: Red must not play in
/// blue.
export const kPalettes: readonly Palette[] = [
  { name: "Blue and orange", left: "#1f5fd6", right: "#ffa21a" },
  { name: "Blue and red", left: "#1f5fd6", right: "#f4593b" },
  { name: "Sky and vermilion", left: "#62bdf0", right: "#d9560b" },
  { name: "Violet and gold", left: "#8a6cf0", right: "#edc22e" },
  { name: "Green and pink", left: "#0b7a5b", right: "#f2a9d2" },
];

/// The chosen pair. If that is the first one and the teams are named after the colours of a pair, that pair in the
/// right order.
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
  lights: Lights;
  labels: boolean;
  /// Sounds are played.
  sound: boolean;
  view: CameraMode;
  /// Index in kPalettes.
  palette: number;
}

export const kDefaults: Settings = { theme: "system", quality: "flat", lights: "scene", labels: true, sound: false, view: "broadcast", palette: 0 };

const kKey = "spark-viewer";

/// Parses stored settings. Missing or invalid values are replaced by defaults.
export function settingsFrom(text: string | null): Settings {
  let kept: Record<string, unknown> = {};
  try {
    const parsed: unknown = JSON.parse(text ?? "{}");
    if (parsed && typeof parsed === "object") kept = parsed as Record<string, unknown>;
  } catch {
    // not valid JSON: use the defaults
  }
  const one = <T>(value: unknown, allowed: readonly T[], otherwise: T): T => (allowed.includes(value as T) ? (value as T) : otherwise);
  return {
    theme: one(kept.theme, ["system", "dark", "light"], kDefaults.theme),
    quality: one(kept.quality, ["flat", "quality"], kDefaults.quality),
    lights: one(kept.lights, ["scene", "plain"], kDefaults.lights),
    labels: one(kept.labels, [true, false], kDefaults.labels),
    sound: one(kept.sound, [true, false], kDefaults.sound),
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
    // without storage, the settings are lost when the page is closed
  }
}
