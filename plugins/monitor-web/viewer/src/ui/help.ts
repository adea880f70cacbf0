/// The help window, which lists all keys.
import { h } from "./dom";
import { icon } from "./icons";
import { capsOf, type Keyboard } from "./keyboard";

export class Help {
  private readonly columns = h("div", { class: "columns" });
  readonly element: HTMLDialogElement;

  constructor(private readonly keyboard: Keyboard) {
    const close = h("button", { type: "button", class: "button bare", "aria-label": "Close the help", onclick: () => this.element.close() }, icon("close"));
    this.element = h(
      "dialog",
      { class: "help scrolls", "data-testid": "help-dialog", "aria-labelledby": "help-title" },
      h("header", {}, h("h2", { id: "help-title" }, "Keys"), close),
      this.columns,
    );
    this.element.addEventListener("keydown", (event) => event.key === "?" && this.element.close());
    // a click beside the window closes it
    this.element.addEventListener("click", (event) => event.target === this.element && this.element.close());
  }

  toggle(): void {
    if (this.element.open) return this.element.close();
    this.columns.replaceChildren(...[...this.keyboard.groups()].map(([name, bindings]) => this.section(name, bindings)));
    this.element.showModal();
  }

  private section(name: string, bindings: { combo: string; title: string }[]): HTMLElement {
    const rows = bindings.flatMap(({ combo, title }) => [h("dt", {}, title), h("dd", {}, ...combo.split(" ").flatMap((c) => capsOf(c).map((cap) => (cap === "…" ? cap : h("kbd", {}, cap)))))]);
    return h("section", {}, h("h3", {}, name), h("dl", {}, ...rows));
  }
}
