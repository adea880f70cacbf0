/// The toolbar for cameras, appearance, logs and help; on a phone it is in a sheet.
import type { CameraMode, Lights, Quality, Theme } from "./app";
import { h, setAttribute, setText } from "./dom";
import { changeIcon, icon, type IconName } from "./icons";

export const kCameras: readonly { mode: CameraMode; name: string; key: string }[] = [
  { mode: "orbit", name: "Free camera", key: "o" },
  { mode: "broadcast", name: "Broadcast camera", key: "b" },
  { mode: "head", name: "Robot's head", key: "h" },
  { mode: "top", name: "From above", key: "t" },
];

export interface ToolActions {
  camera(mode: CameraMode): void;
  quality(): void;
  lights(): void;
  labels(): void;
  sound(): void;
  colours(): void;
  theme(): void;
  open(): void;
  help(): void;
}

export interface ToolState {
  camera: CameraMode;
  quality: Quality;
  lights: Lights;
  labels: boolean;
  sound: boolean;
  colours: string;
  theme: Theme;
}

interface Tool {
  button: HTMLButtonElement;
  words: HTMLElement;
  picture: SVGSVGElement;
}

function tool(testid: string, name: string, key: string, picture: IconName, run: () => void): Tool {
  const words = h("span", { class: "words" }, name);
  const svg = icon(picture);
  const button = h("button", { type: "button", class: "button bare", "data-testid": testid, "aria-label": name, title: `${name} (${key.toUpperCase()})`, onclick: run }, svg, words);
  return { button, words, picture: svg };
}

export class Tools {
  private readonly cameras: Map<CameraMode, Tool>;
  private readonly quality: Tool;
  private readonly lights: Tool;
  private readonly labels: Tool;
  private readonly sound: Tool;
  private readonly colours: Tool;
  private readonly theme: Tool;
  readonly element: HTMLElement;

  constructor(actions: ToolActions) {
    this.cameras = new Map(kCameras.map(({ mode, name, key }) => [mode, tool(`camera-${mode}`, name, key, mode, () => actions.camera(mode))]));
    this.quality = tool("quality", "Shadows", "g", "quality", actions.quality);
    this.lights = tool("lights", "Lights of the scene", "z", "lamp", actions.lights);
    this.labels = tool("labels", "Labels", "l", "labels", actions.labels);
    this.sound = tool("sound", "Sounds", "Shift+S", "sound", actions.sound);
    this.colours = tool("colours", "Team colours", "c", "colours", actions.colours);
    this.theme = tool("theme", "Dark or light", "m", "dark", actions.theme);
    const open = tool("open-log", "Open a log", "Ctrl+O", "open", actions.open);
    const help = tool("help", "Help and keys", "?", "help", actions.help);
    const buttons = (...tools: Tool[]) => tools.map((t) => t.button);
    this.element = h(
      "div",
      { class: "tools card scrolls", role: "toolbar", "aria-label": "View", "aria-orientation": "vertical" },
      ...buttons(...this.cameras.values()),
      h("hr"),
      ...buttons(this.quality, this.lights, this.labels, this.sound, this.colours, this.theme),
      h("hr"),
      ...buttons(open, help),
    );
  }

  update(state: ToolState): void {
    for (const [mode, { button }] of this.cameras) setAttribute(button, "aria-pressed", String(mode === state.camera));
    setAttribute(this.quality.button, "aria-pressed", String(state.quality === "quality"));
    setAttribute(this.lights.button, "aria-pressed", String(state.lights === "scene"));
    setAttribute(this.labels.button, "aria-pressed", String(state.labels));
    setAttribute(this.sound.button, "aria-pressed", String(state.sound));
    this.rename(this.colours, `Team colours: ${state.colours}`, "C");
    this.rename(this.theme, state.theme === "dark" ? "Light colours" : "Dark colours", "M");
    changeIcon(this.theme.picture, state.theme === "dark" ? "light" : "dark");
  }

  private rename({ button, words }: Tool, name: string, key: string): void {
    setAttribute(button, "aria-label", name);
    setAttribute(button, "title", `${name} (${key})`);
    setText(words, name);
  }
}
