import "./inspect.css";
import { DrawingsLayer } from "../drawings/layer";
import { DrawingsPanel } from "../drawings/panel";
import { SetSwitches } from "../drawings/switches";
import { h, Pace } from "../ui/dom";
import type { App, Panel } from "../ui/app";
import { Host } from "./host";
import type { Inspectable, PropertyInfo } from "./inspectable";
import { NodePaths } from "./node_paths";
import { OverlaySet } from "./overlay_set";
import type { Overlay, Surroundings } from "./overlays/overlay";
import { OverlaysView } from "./overlays_view";
import { kMostPlotted, PlotList } from "./plot_list";
import { PlotView } from "./plot_view";
import { PropertyView } from "./property_view";
import { Recording } from "./recording";
import { Tabs } from "./tabs";
import { TreeView } from "./tree_view";

/// Mounts the inspector: object tree, properties, plots, overlays and drawings.
export function mountInspector(container: HTMLElement, app: App): Panel {
  return new Inspector(container, app);
}

const kPeriod = 100;          // [ms] between two updates of the page
const kTreePeriod = 1000;     // [ms] between two refreshes of the tree while the scene changes

class Inspector implements Panel {
  private readonly tabs: Tabs;
  private readonly tree = new TreeView((path) => this.choose(path), (path) => this.paths?.titleOf(path) ?? "");
  private readonly properties = new PropertyView({ has: (path, name) => this.plots?.has(path, name) ?? false, toggle: (path, info) => this.togglePlot(path, info) });
  private readonly plotView = new PlotView();
  private readonly overlays: OverlaySet;
  private readonly overlaysView: OverlaysView;
  private readonly switches = new SetSwitches();
  private readonly drawings: DrawingsLayer;
  private readonly drawingsPanel: DrawingsPanel;
  private readonly unhear: (() => void)[];
  private readonly pace = new Pace(kPeriod);
  private readonly treePace = new Pace(kTreePeriod);
  private inspectable: Inspectable | null = null;
  private paths: NodePaths | null = null;
  private plots: PlotList | null = null;
  private scene = -1;
  private ready = false;
  private readonly around: Surroundings;

  constructor(container: HTMLElement, private readonly app: App) {
    this.around = aroundOf(app);
    this.overlays = new OverlaySet(app.stage.overlay);
    this.overlaysView = new OverlaysView(this.overlays.overlays, (overlay, on) => this.switchOverlay(overlay, on));
    this.drawings = new DrawingsLayer(app.stage, this.switches);
    this.drawingsPanel = new DrawingsPanel(this.switches, (on) => this.switchDrawings(on));
    const objects = h("div", {}, this.tree.element, this.properties.element);
    this.tabs = new Tabs([
      { id: "tree", title: "Objects", panel: objects },
      { id: "plots", title: "Plots", panel: h("div", {}, this.plotView.element) },
      { id: "overlays", title: "Overlays", panel: h("div", {}, this.overlaysView.element) },
      { id: "drawings", title: "Drawings", panel: h("div", {}, this.drawingsPanel.element) },
    ], () => this.wake());
    container.append(this.tabs.element);
    for (const overlay of this.overlays.overlays) app.key(overlay.key, `Show or hide: ${overlay.title.toLowerCase()}`, () => this.switchOverlay(overlay, !overlay.on, true));
    app.key("shift+d", "Show or hide: drawings of agents", () => this.switchDrawings(!this.drawings.visible, true));
    this.unhear = [
      app.on("source", () => this.openSource()), app.on("selection", () => this.showSelection()), app.on("visible", () => this.wake()),
      app.on("theme", () => this.plotView.restyle()), app.on("referee", () => this.properties.update()),
    ];
    this.openSource();
  }

  update(now: number): void {
    // Overlays show what the host knows now.
    if (this.app.live && this.app.inPast) this.hideOverlays();
    this.overlays.update(now, this.around);
    this.drawings.update();
    if (!this.pace.due(now)) return;
    this.inspectable?.update();
    this.followScene(now);
    this.followHost();
    if (this.app.inspecting) this.updatePage();
  }

  close(): void {
    for (const unhear of this.unhear) unhear();
    this.plots?.clear();
    this.plotView.close();
    this.properties.close();
    this.overlays.dispose();
    this.drawings.dispose();
    this.tabs.element.remove();
  }

  private updatePage(): void {
    const replay = this.app.inPast;
    if (this.tabs.chosen === "tree") {
      this.tree.update();
      this.properties.update();
    } else if (this.tabs.chosen === "plots") {
      this.plotView.update(this.app.world.time);
    } else if (this.tabs.chosen === "overlays") {
      this.overlaysView.update(replay);
    } else {
      this.drawingsPanel.update(this.app.world, this.drawings.visible, replay);
    }
    this.tabs.count("plots", this.plots?.items.length ?? 0);
  }

  private openSource(): void {
    const { live, world } = this.app;
    this.plots?.clear();
    const recording = live ? null : new Recording(world);
    this.inspectable = live ? new Host(live) : recording;
    this.paths = new NodePaths(world, recording ? () => recording.pathsOf() : (w) => w.nodes.map((n) => n.path));
    this.plots = new PlotList(this.inspectable!);
    this.plotView.setList(this.plots);
    this.tree.setSource(this.inspectable);
    this.properties.setSource(this.inspectable);
    this.drawings.setWorld(world);
    live?.setDrawings(this.drawings.visible);
    this.scene = world.versions.scene;
    this.ready = this.inspectable!.ready;
    this.wake();
    this.showSelection();
  }

  /// Requests the tree again, because robots may have been added or removed.
  private followScene(now: number): void {
    const version = this.app.world.versions.scene;
    if (version === this.scene || !this.treePace.due(now)) return;
    this.scene = version;
    this.tree.refresh();
  }

  /// The connection is restored: repeats requests that were not answered.
  private followHost(): void {
    const ready = this.inspectable?.ready ?? false;
    if (ready === this.ready) return;
    this.ready = ready;
    if (!ready) return;
    this.tree.refresh();
    this.showSelection(true);
  }

  private wake(): void {
    this.properties?.setAwake(this.app.inspecting && this.tabs?.chosen === "tree");
    if (this.tabs && this.app.inspecting && this.inspectable) this.updatePage();
  }

  /// A node of the tree was selected.
  private choose(path: string): void {
    this.app.select({ robot: this.paths!.robotAt(path), node: this.paths!.nodeAt(path), path });
  }

  private showSelection(again = false): void {
    const selection = this.app.selection;
    const path = selection && (selection.path ?? this.paths!.ofRobot(selection.robot) ?? this.paths!.pathOf(selection.node) ?? null);
    this.tree.select(path);
    this.properties.show(path, again);
  }

  private togglePlot(path: string, info: PropertyInfo): void {
    if (this.plots!.has(path, info.name)) this.plots!.removeProperty(path, info.name);
    else if (this.plots!.add(path, info)) this.app.toast(`Plotting ${info.name}: see Plots`);
    else this.app.toast(`No room: at most ${kMostPlotted} lines are plotted at once`, "bad");
  }

  private switchOverlay(overlay: Overlay, on: boolean, tell = false): void {
    const missing = this.app.inPast ? overlay.missing : null;
    if (missing !== null) return this.app.toast(missing, "bad");
    overlay.on = on;
    if (tell) this.app.toast(`${overlay.title} ${on ? "shown" : "hidden"}`);
  }

  private hideOverlays(): void {
    for (const overlay of this.overlays.overlays) if (overlay.missing !== null) overlay.on = false;
  }

  private switchDrawings(on: boolean, tell = false): void {
    this.drawings.visible = on;
    this.app.live?.setDrawings(on);
    if (tell) this.app.toast(`Drawings ${on ? "shown" : "hidden"}`);
  }
}

/// Updated with each picture, without allocation.
function aroundOf(app: App): Surroundings {
  return {
    canvas: app.stage,
    get world() {
      return app.world;
    },
    get live() {
      return app.live;
    },
    get robot() {
      const key = app.selection?.robot;
      if (key != null) for (const robot of app.world.robots) if (robot.key === key) return robot;
      return null;
    },
  };
}
