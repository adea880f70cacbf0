/// The whole page: connects the stage, the panels and the source, and runs the main loop.
import { mountInspector } from "../inspect";
import type { LiveSource, Playback, ReplaySource, Robot, Source, World } from "../model";
import { withoutLog, withoutToken, wishesOf, type Wishes } from "./address";
import { Stage } from "../view/stage";
import type { App, AppEvent, CameraMode, Panel, Selection, Theme, Tone } from "./app";
import { Appearance } from "./appearance";
import { bindKeys } from "./bindings";
import { h, Pace } from "./dom";
import { EventsPanel } from "./events_panel";
import { FieldPicker } from "./field_picker";
import { FrameRate } from "./frame_rate";
import { teamTitle } from "./format";
import { Help } from "./help";
import { HostPanel } from "./host_panel";
import { Keyboard } from "./keyboard";
import { Login } from "./login";
import { Notice } from "./notice";
import { noticeOf } from "./notices";
import { Openings } from "./openings";
import { PlayersPanel } from "./players_panel";
import { RefereePanel } from "./referee_panel";
import { Scoreboard } from "./scoreboard";
import { loadSettings } from "./settings";
import { Showing } from "./showing";
import { Side } from "./side";
import { Sounds } from "./sounds";
import { connectionOf, kConnectionWords, StatusLine } from "./status_line";
import { tellWish } from "./stream_wish";
import { Timeline } from "./timeline";
import { passed } from "./timeline_maths";
import { Toasts } from "./toasts";
import { Tools } from "./tools";

/// Minimum interval between two updates of numbers, and of lists [ms].
const kNumbers = 100;
const kLists = 300;

export class Application implements App {
  readonly stage: Stage;
  readonly appearance: Appearance;
  readonly keyboard = new Keyboard();
  readonly showing: Showing;
  readonly side = new Side(() => this.panelChanged());
  readonly timeline = new Timeline(() => this.backToLive());
  readonly help = new Help(this.keyboard);
  readonly openings = new Openings((file) => void this.showing.openLog(file));
  readonly picker: FieldPicker;
  readonly refereePanel: RefereePanel;
  readonly sounds = new Sounds();
  /// Number of pictures drawn since the start.
  frames = 0;

  private readonly inspector: Panel;
  private readonly players: PlayersPanel;
  private readonly events: EventsPanel;
  private readonly host: HostPanel;
  private readonly scoreboard = new Scoreboard();
  private readonly statusLine = new StatusLine();
  private readonly toasts = new Toasts();
  private readonly notice = new Notice();
  private readonly frameRate = new FrameRate();
  private readonly login = new Login(() => this.toast("The referee's token kept here is no longer good", "bad"));
  private readonly tools = new Tools({
    camera: (mode) => this.setCamera(mode),
    quality: () => this.switchQuality(),
    lights: () => this.switchLights(),
    labels: () => this.switchLabels(),
    sound: () => this.switchSound(),
    colours: () => this.switchColours(),
    theme: () => this.appearance.switchTheme(),
    open: () => this.openings.choose(),
    help: () => this.help.toggle(),
  });
  private readonly surface = h("div", { class: "stage", tabindex: "0", role: "application", "data-testid": "stage", "aria-label": "The field" });
  private readonly area = h("main", { class: "area" }, this.surface);
  private readonly heard = new Map<AppEvent, Set<() => void>>();
  private readonly numbers = new Pace(kNumbers);
  private readonly lists = new Pace(kLists);
  private chosen: Selection | null = null;
  private sceneSeen = -1;
  private environmentSeen = -1;
  private eventTime = NaN;
  private wasReferee = false;
  /// When the current source was first shown [ms].
  private since = 0;

  constructor(root: HTMLElement, address: string) {
    const wishes = wishesOf(address);
    this.showing = new Showing(address);
    root.classList.add("app");
    root.append(this.area, this.side.element, this.side.rail, this.help.element, this.toasts.announcer, ...this.openings.elements);
    this.stage = new Stage(this.surface);
    this.picker = new FieldPicker(this.area, this.surface, () => this.stage.eye);
    this.area.append(
      h("div", { class: "top" }, this.statusLine.element, this.scoreboard.element),
      this.tools.element,
      this.toasts.element,
      this.notice.element,
      h("div", { class: "below" }, this.picker.banner, this.timeline.element),
    );
    this.appearance = this.makeAppearance(wishes);
    this.sounds.restore(this.appearance.settings.sound, window);
    this.players = new PlayersPanel(this.side.panel("players"), this, {
      select: (robot) => this.selectRobot(robot),
      headCamera: () => this.setCamera("head"),
      inspect: () => this.side.show("inspect"),
    });
    this.events = new EventsPanel(this.side.panel("events"), this, (event) => this.timeline.seek(event.time));
    this.host = new HostPanel(this.side.panel("host"), this);
    this.refereePanel = new RefereePanel(this.side.panel("referee"), this, {
      login: (token) => (this.live ? this.login.login(this.live, token) : Promise.resolve(false)),
      pick: (what) => this.picker.pick(what),
    });
    bindKeys(this);
    this.inspector = mountInspector(this.side.panel("inspect"), this);
    this.placeTools();
    this.hearStage();
    this.keyboard.listen(window, this.stage.camera);
    this.begin(wishes);
  }

  get source(): Source {
    return this.showing.source;
  }

  get live(): LiveSource | null {
    return this.showing.live;
  }

  get replay(): ReplaySource | null {
    return this.showing.replay;
  }

  get playback(): Playback | null {
    return this.replay ?? this.live?.past ?? null;
  }

  get inPast(): boolean {
    return this.replay !== null || this.live?.past?.following === false;
  }

  get world(): World {
    return this.showing.source.world;
  }

  get selection(): Selection | null {
    return this.chosen;
  }

  get theme(): Theme {
    return this.appearance.theme;
  }

  get inspecting(): boolean {
    return this.side.open === "inspect";
  }

  select(what: Selection | null): void {
    this.chosen = what;
    this.stage.select(what ? (what.robot ?? (what.node >= 0 ? what.node : null)) : null);
    this.lists.hurry();
    this.emit("selection");
  }

  selectRobot(robot: Robot): void {
    this.select({ robot: robot.key, node: robot.node, path: robot.path });
  }

  on(event: AppEvent, heard: () => void): () => void {
    const all = this.heard.get(event) ?? new Set();
    this.heard.set(event, all.add(heard));
    return () => all.delete(heard);
  }

  key(combo: string, title: string, run: () => void): void {
    this.keyboard.bind({ combo, title, run, group: "Inspect" });
  }

  toast(text: string, tone: Tone = "plain"): void {
    this.toasts.show(text, tone);
  }

  /// Shows the running match, or its newest instant.
  backToLive(): void {
    if (this.live) this.live.past?.follow();
    else this.showing.watchLive();
  }

  setCamera(mode: CameraMode): void {
    this.stage.camera.mode = mode;
    this.appearance.keepView(mode);
    this.showTools();
  }

  switchQuality(): void {
    this.toast(this.appearance.switchQuality() === "quality" ? "With shadows" : "Flat and fast");
    this.showTools();
  }

  switchLights(): void {
    this.toast(this.appearance.switchLights() === "scene" ? "Lights of the scene, if it has any" : "Plain light");
    this.showTools();
  }

  switchLabels(): void {
    this.appearance.switchLabels();
    this.showTools();
  }

  switchSound(): void {
    const on = this.appearance.switchSound();
    this.sounds.switch(on);
    this.toast(on ? "Sounds are on" : "Sounds are off");
    this.showTools();
  }

  switchColours(): void {
    this.appearance.switchColours();
    this.toast(`Team colours: ${this.appearance.palette.name}`);
  }

  /// Updates and draws one picture.
  frame(now: number): void {
    this.timeline.seekWanted();
    this.inspector.update(now);
    if (this.stage.render(now)) {
      ++this.frames;
      this.frameRate.drawn();
    }
    this.sounds.play(this.world.sounds, this.stage.eye.matrixWorld.elements, now);
    if (this.numbers.due(now)) this.refresh(now);
  }

  /// Updates texts and numbers.
  private refresh(now: number): void {
    this.showNotice(now);
    this.scoreboard.update(this.world);
    this.followTeams();
    this.statusLine.update(this);
    this.timeline.setPlayback(this.playback);
    this.timeline.update();
    this.tellEvents();
    this.followScene();
    this.followReferee();
    this.refereePanel.follow(now);
    this.frameRate.update(now);
    if (this.lists.due(now)) this.refreshPanel();
  }

  private refreshPanel(): void {
    const { open } = this.side;
    if (open === "players") this.players.update();
    if (open === "events") this.events.update();
    if (open === "referee") this.refereePanel.update();
    if (open === "host") this.host.update(kConnectionWords[connectionOf(this)], this.frameRate.value);
  }

  private begin(wishes: Wishes): void {
    this.showing.onchange = () => this.sourceChanged();
    this.takeToken(wishes);
    document.addEventListener("visibilitychange", () => tellWish(this.live));
    window.addEventListener("hashchange", () => this.takeToken(wishesOf(location.href)));
    this.side.show(wishes.panel === "none" ? null : wishes.panel);
    if (wishes.file) void this.showing.openLog(wishes.file, wishes);
    else this.showing.watchLive();
  }

  /// Removes the token from the address bar, where it would be copied with the link.
  private takeToken({ token }: Wishes): void {
    if (!token) return;
    this.login.keep(token);
    history.replaceState(null, "", withoutToken(location.href));
  }

  private makeAppearance(wishes: Wishes): Appearance {
    const settings = loadSettings();
    settings.theme = wishes.theme ?? settings.theme;
    settings.quality = wishes.quality ?? settings.quality;
    settings.view = wishes.view ?? settings.view;
    return new Appearance(this.stage, settings, (what) => {
      this.emit(what);
      this.showTools();
    });
  }

  private sourceChanged(): void {
    this.since = performance.now();
    this.sceneSeen = this.environmentSeen = -1;
    this.eventTime = NaN;
    this.picker.finish(null);
    this.stage.setSource(this.source);
    tellWish(this.live);
    // so that reloading shows it again
    if (this.live) history.replaceState(null, "", withoutLog(location.href));
    this.timeline.setPlayback(this.playback);
    if (this.replay?.lacks) this.toast(this.replay.lacks, "bad");
    this.select(null);
    this.emit("source");
  }

  private emit(event: AppEvent): void {
    for (const heard of this.heard.get(event) ?? []) heard();
  }

  private panelChanged(): void {
    this.lists.hurry();
    this.emit("visible");
  }

  private showTools(): void {
    const { stage, appearance } = this, { settings } = appearance;
    this.tools.update({ camera: stage.camera.mode, quality: stage.quality, lights: stage.lights, labels: stage.labels, sound: settings.sound, colours: appearance.palette.name, theme: appearance.theme });
  }

  /// The panels are beside the picture, or in a sheet of their own on a phone.
  private placeTools(): void {
    const narrow = window.matchMedia("(max-width: 720px)");
    const sheet = this.side.panel("view");
    sheet.classList.add("padded");
    const place = () => {
      if (narrow.matches) sheet.append(this.tools.element);
      else this.surface.after(this.tools.element);
      if (!narrow.matches && this.side.open === "view") this.side.show(null);
    };
    narrow.addEventListener("change", place);
    place();
    this.showTools();
  }

  private hearStage(): void {
    this.stage.camera.onmode = () => this.showTools();
    this.stage.onpick = (pick) => {
      if (this.picker.picking) return;
      if (pick?.robot) this.selectRobot(pick.robot);
      else this.select(pick ? { robot: null, node: pick.node, path: this.world.nodes[pick.node]?.path } : null);
    };
  }

  private showNotice(now: number): void {
    const notice = noticeOf(this.showing, now - this.since, location.host, this.openings);
    if (notice) this.notice.show(notice.title, notice.words, notice.share, notice.actions);
    else this.notice.hide();
  }

  /// Shows a toast for each event (goal, foul) that the shown time has passed since the last call.
  private tellEvents(): void {
    const { time, events } = this.world;
    for (const event of passed(events, this.eventTime, time)) this.toasts.event(event);
    this.eventTime = time;
  }

  /// Updates the selection after a change of scene: a selected robot is found again by its key, because its node may
  /// have another index; a robot that no longer exists is deselected.
  private followScene(): void {
    const { world, chosen } = this;
    if (world.versions.scene === this.sceneSeen) return;
    this.sceneSeen = world.versions.scene;
    this.surface.setAttribute("aria-label", `The field with ${world.robots.length} robots; press ? for the keys`);
    if (!chosen) return;
    const robot = world.robots.find((r) => r.key === chosen.robot);
    if (robot) this.selectRobot(robot);
    else if (chosen.robot !== null || chosen.path === undefined) this.select(null);
    else this.select({ ...chosen, node: world.nodes.findIndex((n) => n.path === chosen.path) });
  }

  private followTeams(): void {
    const { environment, versions } = this.world;
    if (versions.environment === this.environmentSeen) return;
    this.environmentSeen = versions.environment;
    this.appearance.setTeams(teamTitle(environment, "left"), teamTitle(environment, "right"));
  }

  private followReferee(): void {
    this.login.update(this.live);
    const referee = this.live?.referee ?? false;
    if (referee === this.wasReferee) return;
    this.wasReferee = referee;
    if (referee) this.toast("You are the referee", "good");
    this.lists.hurry();
    this.emit("referee");
  }
}
