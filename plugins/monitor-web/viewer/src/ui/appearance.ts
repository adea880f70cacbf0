/// Applies the chosen theme, team colours and quality to the page and the stage, and keeps the choices.
import { css, inkOn, type Rgb, rgb } from "../view/palette";
import type { CameraMode, Lights, Quality, Stage, Theme } from "./app";
import { keepSettings, kPalettes, type Palette, paletteFor, type Settings } from "./settings";

const rgbOf = (hex: string): Rgb => rgb(parseInt(hex.slice(1), 16));

export class Appearance {
  private readonly system = window.matchMedia("(prefers-color-scheme: light)");
  private readonly still = window.matchMedia("(prefers-reduced-motion: reduce)");

  private teams: [string, string] = ["", ""];

  constructor(private readonly stage: Stage, readonly settings: Settings, private readonly changed: (what: "theme" | "colours") => void) {
    this.system.addEventListener("change", () => this.themeChanged());
    this.still.addEventListener("change", () => (stage.reducedMotion = this.still.matches));
    stage.reducedMotion = this.still.matches;
    stage.quality = settings.quality;
    stage.lights = settings.lights;
    stage.labels = settings.labels;
    stage.camera.mode = settings.view;
    this.showTheme();
    this.showColours();
  }

  get theme(): Theme {
    const { theme } = this.settings;
    return theme !== "system" ? theme : this.system.matches ? "light" : "dark";
  }

  get palette(): Palette {
    return paletteFor(this.settings.palette, ...this.teams);
  }

  /// Call it periodically: team colours depend on the teams' names.
  setTeams(left: string, right: string): void {
    if (this.teams[0] === left && this.teams[1] === right) return;
    this.teams = [left, right];
    this.coloursChanged();
  }

  /// Switches between dark and light. If the result is the system's theme, the setting becomes "system" again.
  switchTheme(): void {
    const other: Theme = this.theme === "dark" ? "light" : "dark";
    this.settings.theme = (other === "light") === this.system.matches ? "system" : other;
    this.themeChanged();
    keepSettings(this.settings);
  }

  switchColours(): void {
    this.settings.palette = (this.settings.palette + 1) % kPalettes.length;
    this.coloursChanged();
    keepSettings(this.settings);
  }

  switchQuality(): Quality {
    this.settings.quality = this.stage.quality = this.stage.quality === "flat" ? "quality" : "flat";
    keepSettings(this.settings);
    return this.settings.quality;
  }

  switchLights(): Lights {
    this.settings.lights = this.stage.lights = this.stage.lights === "scene" ? "plain" : "scene";
    keepSettings(this.settings);
    return this.settings.lights;
  }

  switchLabels(): boolean {
    this.settings.labels = this.stage.labels = !this.stage.labels;
    keepSettings(this.settings);
    return this.settings.labels;
  }

  switchSound(): boolean {
    this.settings.sound = !this.settings.sound;
    keepSettings(this.settings);
    return this.settings.sound;
  }

  keepView(view: CameraMode): void {
    this.settings.view = view;
    keepSettings(this.settings);
  }

  private themeChanged(): void {
    this.showTheme();
    this.changed("theme");
  }

  private coloursChanged(): void {
    this.showColours();
    this.changed("colours");
  }

  private showTheme(): void {
    document.documentElement.dataset.theme = this.theme;
    this.stage.theme = this.theme;
  }

  private showColours(): void {
    const { style } = document.documentElement;
    const [left, right] = [rgbOf(this.palette.left), rgbOf(this.palette.right)];
    for (const [name, colour] of [["--left", left], ["--right", right]] as const) {
      style.setProperty(name, css(colour));
      style.setProperty(`${name}-ink`, css(inkOn(colour)));
    }
    this.stage.teamColours = { left, right };
  }
}
