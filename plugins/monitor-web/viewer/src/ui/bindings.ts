/// Key bindings. Panels add their own; W A S D, Q E, R F, + and - move the camera.
import type { Application } from "./application";
import type { PanelName } from "./address";
import type { Binding } from "./keyboard";
import { neighbourOf } from "./players_panel";
import { neighbour } from "./timeline_maths";
import { kCameras } from "./tools";

const kPanelKeys: readonly [string, PanelName, string][] = [
  ["p", "players", "Players"],
  ["y", "events", "Events"],
  ["i", "inspect", "Inspect"],
  ["k", "referee", "Referee's console"],
  ["u", "host", "Host"],
];

export function bindKeys(app: Application): void {
  app.keyboard.bind(...looks(app), ...cameraHelp(), ...panels(app), ...robots(app), ...playback(app), ...referee(app));
}

function looks(app: Application): Binding[] {
  const group = "View";
  return [
    ...kCameras.map(({ mode, name, key }) => ({ combo: key, title: name, group, run: () => app.setCamera(mode) })),
    { combo: "backspace", title: "The whole field", group, run: () => app.stage.camera.home() },
    { combo: "g", title: "With or without shadows", group, run: () => app.switchQuality() },
    { combo: "z", title: "Lights of the scene, or plain light", group, run: () => app.switchLights() },
    { combo: "l", title: "Labels", group, run: () => app.switchLabels() },
    { combo: "shift+s", title: "Sounds", group, run: () => app.switchSound() },
    { combo: "c", title: "Team colours", group, run: () => app.switchColours() },
    { combo: "m", title: "Dark or light", group, run: () => app.appearance.switchTheme() },
  ];
}

/// Listed here for the help; the stage handles them.
function cameraHelp(): Binding[] {
  const line = (combo: string, title: string): Binding => ({ combo, title, group: "Move the camera" });
  return [line("w a s d", "Slide"), line("q e", "Turn"), line("r f", "Tilt"), line("+ -", "Closer, further")];
}

function panels(app: Application): Binding[] {
  const group = "Panels";
  return [
    ...kPanelKeys.map(([combo, name, title]) => ({ combo, title, group, run: () => app.side.toggle(name) })),
    { combo: "ctrl+o", title: "Open a log", group, run: () => app.openings.choose() },
    { combo: "?", title: "This help", group, run: () => app.help.toggle() },
    { combo: "esc", title: "Let go", group, run: () => letGo(app) },
  ];
}

/// Cancels one thing per call: picking, then the focus, then the selection, then the panel.
function letGo(app: Application): void {
  const focused = document.activeElement;
  if (app.picker.picking) app.picker.finish(null);
  else if (focused instanceof HTMLInputElement || focused instanceof HTMLSelectElement) focused.blur();
  else if (app.selection) app.select(null);
  else app.side.show(null);
}

function robots(app: Application): Binding[] {
  const group = "Robots";
  const go = (direction: 1 | -1) => {
    const robot = neighbourOf(app.world.robots, app.selection?.robot ?? null, direction);
    if (robot) app.selectRobot(robot);
  };
  const numbered = ["left", "right"].flatMap((side) =>
    [...Array(10).keys()].map((digit): Binding => ({
      combo: `${side === "right" ? "shift+" : ""}${digit}`,
      title: "",
      group,
      hidden: true,
      run: () => {
        const robot = app.world.robots.find((r) => r.side === side && r.number === (digit || 10));
        if (robot) app.selectRobot(robot);
      },
    })),
  );
  const told: Binding[] = [
    { combo: "1 … 0", title: "Left team's 1 to 10", group },
    { combo: "shift+1 … 0", title: "Right team's 1 to 10", group },
  ];
  return [
    { combo: "pagedown", title: "Next robot", group, run: () => go(1) },
    { combo: "pageup", title: "Previous robot", group, run: () => go(-1) },
    ...told,
    ...numbered,
  ];
}

function playback(app: Application): Binding[] {
  const { timeline } = app;
  const when = () => app.playback !== null;
  const line = (combo: string, title: string, run: () => void): Binding => ({ combo, title, group: "Timeline", run, when });
  const jump = (direction: 1 | -1) => {
    const event = app.playback && neighbour(app.playback.timeline, app.playback.time, direction);
    if (event) timeline.seek(event.time);
  };
  return [
    line("space", "Play, pause", () => timeline.togglePlaying()),
    line("left", "5 seconds back", () => timeline.seekBy(-5)),
    line("right", "5 seconds on", () => timeline.seekBy(5)),
    line("shift+left", "Previous goal or foul", () => jump(-1)),
    line("shift+right", "Next goal or foul", () => jump(1)),
    line(",", "One record back", () => timeline.step(-1)),
    line(".", "One record on", () => timeline.step(1)),
    line("[", "Slower", () => timeline.faster(-1)),
    line("]", "Faster", () => timeline.faster(1)),
    line("home", "To the start", () => timeline.seek(app.playback?.start ?? 0)),
    line("end", "To the end; of a running match: live", () => timeline.seek(app.playback?.end ?? 0)),
  ];
}

/// Active only while the console is open, to prevent an accidental kick-off.
function referee(app: Application): Binding[] {
  const when = () => (app.live?.referee ?? false) && app.side.open === "referee";
  const line = (combo: string, title: string, run: () => void): Binding => ({ combo, title, group: "Referee, with the console open", run, when });
  return [
    line("shift+l", "Kick-off for the left team", () => app.refereePanel.kickOff("left")),
    line("shift+r", "Kick-off for the right team", () => app.refereePanel.kickOff("right")),
    line("shift+b", "Drop ball", () => app.refereePanel.dropBall()),
  ];
}
