/// Line icons on a 24 x 24 grid, drawn for this viewer.
const kPaths = {
  orbit: "M12 3v18 M3 12h18 M9.5 5.5L12 3l2.5 2.5 M9.5 18.5L12 21l2.5-2.5 M5.5 9.5L3 12l2.5 2.5 M18.5 9.5L21 12l-2.5 2.5",
  broadcast: "M3 8.5A1.5 1.5 0 0 1 4.5 7h9A1.5 1.5 0 0 1 15 8.5v7a1.5 1.5 0 0 1-1.5 1.5h-9A1.5 1.5 0 0 1 3 15.5z M15 11l6-3.5v9L15 13",
  head: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12z M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6",
  top: "M3 5h18v14H3z M12 5v14 M12 9.5a2.5 2.5 0 1 0 0 5 2.5 2.5 0 0 0 0-5",
  quality: "M12 3l1.8 5.2L19 10l-5.2 1.8L12 17l-1.8-5.2L5 10l5.2-1.8z M19 16v4 M17 18h4",
  lamp: "M9 18h6 M10 21h4 M9.5 15.5c-.3-1.4-.9-2-1.7-3a5.5 5.5 0 1 1 8.4 0c-.8 1-1.4 1.6-1.7 3z",
  labels: "M3 12V4h8l10 10-8 8z M7.5 8h.01",
  colours: "M9 7a5 5 0 1 0 0 10A5 5 0 0 0 9 7 M15 7a5 5 0 1 1 0 10 5 5 0 0 1 0-10",
  sound: "M4 9.5h3.5l5-4v13l-5-4H4z M15.5 9.5a3.5 3.5 0 0 1 0 5 M18 7a7 7 0 0 1 0 10",
  dark: "M20 14.5A8.5 8.5 0 0 1 9.5 4a8.5 8.5 0 1 0 10.5 10.5z",
  light: "M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8 M12 2v2 M12 20v2 M2 12h2 M20 12h2 M4.9 4.9l1.4 1.4 M17.7 17.7l1.4 1.4 M4.9 19.1l1.4-1.4 M17.7 6.3l1.4-1.4",
  open: "M3 6.5A1.5 1.5 0 0 1 4.5 5H9l2 2.5h8.5A1.5 1.5 0 0 1 21 9v9a1.5 1.5 0 0 1-1.5 1.5h-15A1.5 1.5 0 0 1 3 18z",
  help: "M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18 M9.5 9.5a2.5 2.5 0 1 1 3.5 2.3c-.7.3-1 .8-1 1.5v.4 M12 16.8h.01",
  players: "M9 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6 M3 19c0-3.3 2.7-5.5 6-5.5s6 2.2 6 5.5 M15.5 5.3a3 3 0 0 1 0 5.4 M17.5 14c2.1.8 3.5 2.6 3.5 5",
  events: "M5 6h.01 M5 12h.01 M5 18h.01 M9 6h11 M9 12h11 M9 18h11",
  inspect: "M5 4v5 M5 15v5 M3 12h4v3H3z M12 4v2 M12 12v8 M10 6h4v6h-4z M19 4v9 M19 19v1 M17 13h4v6h-4z",
  referee: "M4 9h11a5 5 0 1 1-5 5H4z M15 14h.01 M17 3l-1.5 3 M21 5l-2.5 2",
  host: "M3 4h18v6H3z M3 14h18v6H3z M7 7h.01 M7 17h.01",
  view: "M4 7h10 M18 7h2 M14 5v4 M4 17h2 M10 17h10 M10 15v4",
  play: "M8 5l11 7-11 7z",
  pause: "M8 5v14 M16 5v14",
  forward: "M7 6l8 6-8 6z M18 6v12",
  back: "M17 6l-8 6 8 6z M6 6v12",
  close: "M6 6l12 12 M18 6L6 18",
  live: "M12 10a2 2 0 1 0 0 4 2 2 0 0 0 0-4 M7.5 7.5a6.4 6.4 0 0 0 0 9 M16.5 7.5a6.4 6.4 0 0 1 0 9 M4.7 4.7a10.3 10.3 0 0 0 0 14.6 M19.3 4.7a10.3 10.3 0 0 1 0 14.6",
  target: "M12 5a7 7 0 1 0 0 14 7 7 0 0 0 0-14 M12 2v6 M12 16v6 M2 12h6 M16 12h6",
} as const;

export type IconName = keyof typeof kPaths;

export function icon(name: IconName): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("class", "icon");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", kPaths[name]);
  svg.append(path);
  return svg;
}

/// Replaces an icon.
export function changeIcon(svg: SVGSVGElement, name: IconName): void {
  const path = svg.firstElementChild!;
  if (path.getAttribute("d") !== kPaths[name]) path.setAttribute("d", kPaths[name]);
}
