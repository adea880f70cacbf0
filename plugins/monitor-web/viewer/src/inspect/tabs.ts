import { h, setText } from "../ui/dom";

export interface Tab {
  id: string;
  title: string;
  panel: HTMLElement;
}

/// A tab view: one panel is visible, selected by mouse or arrow keys.
export class Tabs {
  readonly element: HTMLElement;
  chosen: string;
  private readonly buttons: HTMLButtonElement[];

  constructor(private readonly tabs: readonly Tab[], private readonly changed: () => void) {
    this.chosen = tabs[0]!.id;
    this.buttons = tabs.map((tab) => {
      tab.panel.id = `insp-panel-${tab.id}`;
      tab.panel.setAttribute("role", "tabpanel");
      tab.panel.classList.add("insp-panel");
      return h("button", { type: "button", role: "tab", id: `insp-tab-${tab.id}`, "data-testid": `inspector-tab-${tab.id}`, "aria-controls": tab.panel.id, onclick: () => this.choose(tab.id) }, tab.title);
    });
    const strip = h("div", { role: "tablist", class: "insp-tabs", "aria-label": "Inspector", onkeydown: (event: KeyboardEvent) => this.keydown(event) }, ...this.buttons);
    this.element = h("div", { class: "insp", "data-testid": "inspector" }, strip, ...tabs.map((t) => t.panel));
    this.choose(this.chosen);
  }

  choose(id: string): void {
    this.chosen = id;
    this.tabs.forEach((tab, i) => {
      tab.panel.hidden = tab.id !== id;
      this.buttons[i]!.setAttribute("aria-selected", String(tab.id === id));
      this.buttons[i]!.tabIndex = tab.id === id ? 0 : -1;
    });
    this.changed();
  }

  /// A title with the number of its items: "Plots 3".
  count(id: string, n: number): void {
    const at = this.tabs.findIndex((t) => t.id === id);
    setText(this.buttons[at]!, n > 0 ? `${this.tabs[at]!.title} ${n}` : this.tabs[at]!.title);
  }

  private keydown(event: KeyboardEvent): void {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step === undefined) return;
    const at = this.tabs.findIndex((t) => t.id === this.chosen);
    const next = (at + step + this.tabs.length) % this.tabs.length;
    this.choose(this.tabs[next]!.id);
    this.buttons[next]!.focus();
    event.preventDefault();
    event.stopPropagation();
  }
}
