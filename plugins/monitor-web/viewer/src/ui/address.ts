/// Parameters in the page's address.
import type { CameraMode, Quality, Theme } from "./app";

export const kPanels = ["players", "events", "inspect", "referee", "host", "view"] as const;
export type PanelName = (typeof kPanels)[number];

export interface Wishes {
  /// A log to open; null: the live match.
  file: string | null;
  /// Start time in the log [s].
  at: number | null;
  paused: boolean;
  view: CameraMode | null;
  quality: Quality | null;
  theme: Theme | null;
  /// null: not given.
  panel: PanelName | "none" | null;
  token: string | null;
}

function oneOf<T extends string>(value: string | null, allowed: readonly T[]): T | null {
  return allowed.find((a) => a === value) ?? null;
}

export function wishesOf(address: string): Wishes {
  const url = new URL(address);
  const query = url.searchParams;
  const at = query.get("at");
  return {
    file: query.get("file") || null,
    at: at !== null && at !== "" && Number.isFinite(Number(at)) ? Number(at) : null,
    paused: query.has("paused"),
    view: oneOf(query.get("view"), ["orbit", "broadcast", "head", "top"]),
    quality: oneOf(query.get("quality"), ["flat", "quality"]),
    theme: oneOf(query.get("theme"), ["dark", "light"]),
    panel: oneOf(query.get("panel"), [...kPanels, "none"]),
    token: new URLSearchParams(url.hash.slice(1)).get("token") || null,
  };
}

/// The address without the token, for display and copying.
export function withoutToken(address: string): string {
  const url = new URL(address);
  const rest = new URLSearchParams(url.hash.slice(1));
  rest.delete("token");
  url.hash = rest.toString();
  return url.href.replace(/#$/, "");
}

/// The address of the live match: without the log and the start time.
export function withoutLog(address: string): string {
  const url = new URL(address);
  for (const name of ["file", "at", "paused"]) url.searchParams.delete(name);
  return url.href;
}

/// The stream address of the page's own host.
export function streamOf(address: string): string {
  const url = new URL("stream", address);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  url.search = url.hash = "";
  return url.href;
}

/// The last component of a log's address, for display.
export function fileNameOf(address: string): string {
  const path = address.split(/[?#]/, 1)[0] ?? address;
  const name = path.split("/").filter(Boolean).at(-1) ?? address;
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}
