import { h, setAttribute, setHidden, setText } from "../ui/dom";
import type { Inspectable, NodeInfo, PropertyInfo } from "./inspectable";
import { reason } from "./poller";
import { componentsOf, editText, formatValue } from "./values";

const kInLine = 18;   // characters; longer values have a line of their own

export interface PlotAsker {
  /// True if any number of this property is plotted.
  has(path: string, property: string): boolean;
  toggle(path: string, property: PropertyInfo): void;
}

/// A property of the selected node. It is watched while it is visible.
class PropertyRow {
  readonly element: HTMLElement;
  private readonly value = h("output", { class: "insp-value", "data-testid": "property-value" });
  private readonly error = h("p", { class: "insp-error", role: "alert", hidden: true, "data-testid": "property-error" });
  private readonly plot = h("button", { type: "button", class: "insp-icon", "data-testid": "property-plot", "aria-pressed": "false" }, "∿");
  private readonly edit = h("button", { type: "button", class: "insp-icon", "data-testid": "property-edit" }, "✎");
  private readonly line: HTMLElement;
  private unwatch: (() => void) | null = null;
  private fresh = true;
  private field: HTMLElement | null = null;

  constructor(private readonly path: string, readonly info: PropertyInfo, private readonly source: Inspectable, private readonly plots: PlotAsker) {
    this.plot.addEventListener("click", () => plots.toggle(path, this.info));
    this.edit.addEventListener("click", () => this.beginEdit());
    for (const [button, what] of [[this.plot, "Plot"], [this.edit, "Change"]] as const) {
      button.title = `${what} ${info.name}`;
      button.setAttribute("aria-label", `${what} ${info.name}`);
    }
    const unit = h("span", { class: "insp-unit", "data-testid": "property-unit" }, info.unit);
    const quantity = h("span", { class: "insp-quantity" }, this.value, unit);
    this.line = h("div", { class: "insp-property-line" }, h("span", { class: "insp-property-name" }, info.name), quantity, this.edit, this.plot);
    this.element = h("div", { class: "insp-property", "data-testid": "property", "data-property": info.name, role: "listitem" }, this.line, h("p", { class: "insp-doc" }, docOf(info)), this.error);
  }

  see(seen: boolean): void {
    if (seen === (this.unwatch !== null)) return;
    this.unwatch?.();
    this.unwatch = seen ? this.source.watch(this.path, this.info.name, (value) => this.hear(value), (why) => this.tell(why)) : null;
  }

  update(): void {
    setHidden(this.edit, !this.source.editable || this.info.readOnly === true);
    setHidden(this.plot, componentsOf(this.info.value).length === 0);
    setAttribute(this.plot, "aria-pressed", String(this.plots.has(this.path, this.info.name)));
    if (!this.fresh) return;
    this.fresh = false;
    const lines = formatValue(this.info.value, this.info.type);
    setText(this.value, lines.join("\n"));
    this.line.classList.toggle("insp-tall", lines.length > 1 || lines[0]!.length > kInLine);
  }

  private hear(value: unknown): void {
    this.info.value = value;
    this.fresh = true;
  }

  private tell(why: string): void {
    setText(this.error, why);
    setHidden(this.error, why === "");
  }

  private beginEdit(): void {
    if (this.field) return this.endEdit();
    this.field = editorOf(this.info, (text) => this.change(text), () => this.endEdit());
    this.line.after(this.field);
    (this.field as HTMLInputElement).focus();
  }

  private endEdit(): void {
    this.field?.remove();
    this.field = null;
    this.tell("");
    this.edit.focus();
  }

  private change(text: string): void {
    this.source.set(this.path, this.info.name, text).then(
      (now) => {
        this.hear(now.value);
        this.endEdit();
        this.update();
      },
      (why: unknown) => this.tell(reason(why)),
    );
  }
}

function docOf(info: PropertyInfo): string {
  const range = info.min !== undefined || info.max !== undefined ? ` ${info.min ?? "−∞"} … ${info.max ?? "∞"}.` : "";
  return `${info.doc}${range}${info.readOnly ? " Read only." : ""}`;
}

function editorOf(info: PropertyInfo, commit: (text: string) => void, cancel: () => void): HTMLElement {
  const attributes = {
    class: "insp-editor", "aria-label": `New value of ${info.name}`, "data-testid": "property-input",
    onkeydown: (event: KeyboardEvent) => {
      event.stopPropagation();
      if (event.key === "Escape") cancel();
      if (event.key === "Enter") commit((event.target as HTMLInputElement).value);
    },
  };
  const choices = info.type === "bool" ? ["true", "false"] : info.choices;
  if (!choices || choices.length === 0) return h("input", { ...attributes, type: "text", value: editText(info.value) });
  const select = h("select", { ...attributes, onchange: (event: Event) => commit((event.target as HTMLSelectElement).value) }, ...choices.map((c) => h("option", { value: c }, c)));
  select.value = String(info.value);
  return select;
}

/// The selected node: class, documentation and current property values.
export class PropertyView {
  readonly element: HTMLElement;
  private readonly title = h("h3", { class: "insp-path", "data-testid": "inspector-selected" });
  private readonly about = h("p", { class: "insp-doc" });
  private readonly list = h("div", { role: "list", class: "insp-properties" });
  private readonly seen: IntersectionObserver;
  private rows = new Map<Element, PropertyRow>();
  private source: Inspectable | null = null;
  private path: string | null = null;
  private asked = 0;
  private awake = false;

  constructor(private readonly plots: PlotAsker) {
    this.element = h("section", { class: "insp-node", "aria-label": "Properties" }, this.title, this.about, this.list);
    this.seen = new IntersectionObserver((entries) => {
      for (const e of entries) this.rows.get(e.target)?.see(e.isIntersecting && this.awake);
    });
  }

  setSource(source: Inspectable | null): void {
    this.source = source;
    this.show(null, true);
  }

  /// Shows this node. `again`: rebuilds the view even if the node is already shown.
  show(path: string | null, again = false): void {
    if (path === this.path && !again) return;
    this.path = path;
    this.clear();
    setText(this.title, path ?? "");
    setText(this.about, path === null ? "Nothing is selected: choose a node of the tree, or click a robot in the picture." : "");
    const mine = ++this.asked;
    if (path === null || !this.source) return;
    this.source.node(path).then(
      (info) => mine === this.asked && this.fill(path, info),
      (why: unknown) => mine === this.asked && setText(this.about, reason(why)),
    );
  }

  /// While asleep it sends no requests.
  setAwake(awake: boolean): void {
    if (awake === this.awake) return;
    this.awake = awake;
    for (const [element, row] of this.rows) {
      if (!awake) row.see(false);
      this.seen.unobserve(element);
      if (awake) this.seen.observe(element);
    }
  }

  update(): void {
    for (const row of this.rows.values()) row.update();
  }

  close(): void {
    this.clear();
    this.seen.disconnect();
  }

  private fill(path: string, info: NodeInfo): void {
    setText(this.about, `${info.class}, ${info.properties.length} ${info.properties.length === 1 ? "property" : "properties"}`);
    for (const property of info.properties) {
      const row = new PropertyRow(path, property, this.source!, this.plots);
      this.rows.set(row.element, row);
      this.list.append(row.element);
      row.update();
      if (this.awake) this.seen.observe(row.element);
    }
  }

  private clear(): void {
    for (const row of this.rows.values()) row.see(false);
    this.seen.disconnect();
    this.rows.clear();
    this.list.replaceChildren();
  }
}
