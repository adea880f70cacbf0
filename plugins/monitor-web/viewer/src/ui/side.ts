/// The rail of tabs and the panel beside (on a phone: below) the picture.
import { kPanels, type PanelName } from "./address";
import { h, setAttribute, setHidden, setText } from "./dom";
import { icon } from "./icons";

const kTitles: Record<PanelName, { short: string; title: string; key: string }> = {
  players: { short: "Players", title: "Players", key: "P" },
  events: { short: "Events", title: "What happened", key: "Y" },
  inspect: { short: "Inspect", title: "Inspect", key: "I" },
  referee: { short: "Referee", title: "Referee", key: "K" },
  host: { short: "Host", title: "Host", key: "U" },
  view: { short: "View", title: "View", key: "" },
};

export class Side {
  readonly panels = new Map<PanelName, HTMLElement>();
  private readonly tabs = new Map<PanelName, HTMLButtonElement>();
  private readonly title = h("h2", { id: "side-title" });
  readonly rail = h("nav", { class: "rail", role: "tablist", "aria-label": "Panels" });
  readonly element: HTMLElement;
  private chosen: PanelName | null = null;

  constructor(private readonly changed: () => void) {
    const close = h("button", { type: "button", class: "button bare", "data-testid": "panel-close", "aria-label": "Close the panel", onclick: () => this.leave() }, icon("close"));
    this.element = h("aside", { class: "side", hidden: true, "aria-labelledby": "side-title" }, h("div", { class: "side-head" }, this.title, close));
    for (const name of kPanels) this.add(name);
    this.rail.addEventListener("keydown", (event) => this.roam(event));
    this.place(null);
  }

  get open(): PanelName | null {
    return this.chosen;
  }

  panel(name: PanelName): HTMLElement {
    return this.panels.get(name)!;
  }

  show(name: PanelName | null): void {
    this.place(name);
    this.changed();
  }

  toggle(name: PanelName): void {
    this.show(this.chosen === name ? null : name);
  }

  private place(name: PanelName | null): void {
    this.chosen = name;
    for (const [other, tab] of this.tabs) {
      setAttribute(tab, "aria-selected", String(other === name));
      setAttribute(tab, "tabindex", other === (name ?? kPanels[0]) ? "0" : "-1");
      setHidden(this.panel(other), other !== name);
    }
    setText(this.title, name ? kTitles[name].title : "");
    setHidden(this.element, name === null);
  }

  /// Closes the panel and returns the focus to the tab.
  private leave(): void {
    const tab = this.chosen && this.tabs.get(this.chosen);
    this.show(null);
    if (tab) tab.focus();
  }

  private add(name: PanelName): void {
    const { short, title, key } = kTitles[name];
    const tab = h(
      "button",
      {
        type: "button",
        class: "tab",
        role: "tab",
        id: `tab-${name}`,
        "data-for": name,
        "data-testid": `tab-${name}`,
        "aria-controls": `panel-${name}`,
        title: key ? `${title} (${key})` : title,
        onclick: () => this.toggle(name),
      },
      icon(name),
      short,
    );
    const panel = h("div", { class: "panel scrolls", role: "tabpanel", id: `panel-${name}`, "data-testid": `panel-${name}`, "aria-labelledby": `tab-${name}`, hidden: true });
    this.tabs.set(name, tab);
    this.panels.set(name, panel);
    this.rail.append(tab);
    this.element.append(panel);
  }

  private roam(event: KeyboardEvent): void {
    const way = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
    const tabs = [...this.tabs.values()].filter((tab) => tab.offsetParent !== null);
    const from = tabs.indexOf(document.activeElement as HTMLButtonElement);
    if (!way || from < 0) return;
    event.preventDefault();
    tabs[(from + way + tabs.length) % tabs.length]!.focus();
  }
}
