import type { World } from "../model";
import { h, setHidden, setText } from "../ui/dom";
import { setRows, type SetRow, type SetSwitches } from "./switches";

interface Line {
  element: HTMLElement;
  box: HTMLInputElement;
  count: HTMLElement;
  row: SetRow;
}

/// The sets of drawings, each with a switch.
export class DrawingsPanel {
  readonly element: HTMLElement;
  readonly all: HTMLInputElement;
  private readonly list = h("div", { class: "insp-sets" });
  private readonly note = h("p", { class: "insp-note" });
  private lines = new Map<string, Line>();
  private drawn = "";

  constructor(private readonly switches: SetSwitches, switched: (on: boolean) => void) {
    this.all = h("input", { type: "checkbox", "data-testid": "overlay-switch", "data-overlay": "drawings", onchange: () => switched(this.all.checked) });
    const doc = "What agents drew through the drawing port or the drawing effector. Sets whose names begin alike can be switched together.";
    this.element = h("section", { "aria-label": "Drawings" },
      h("label", { class: "insp-switch" }, this.all, h("span", {}, "Drawings of agents"), h("kbd", {}, "⇧D")), h("p", { class: "insp-doc" }, doc), this.note, this.list);
  }

  update(world: World | null, on: boolean, replay: boolean): void {
    const wanted = `${world?.versions.drawings} ${this.switches.version} ${on} ${replay}`;
    if (!world || wanted === this.drawn) return;
    this.drawn = wanted;
    this.all.checked = on;
    const rows = setRows(world.drawings.keys());
    setText(this.note, rows.length > 0 ? "" : replay ? "This recording holds no drawings up to here." : "No agent has drawn anything. Agents draw with the drawing effector, or over UDP where the host opens a port for it (--set drawings=32769).");
    setHidden(this.note, rows.length > 0);
    this.show(rows, world);
  }

  private show(rows: readonly SetRow[], world: World): void {
    const lines = new Map<string, Line>();
    for (const row of rows) {
      const key = `${row.nested} ${row.prefix} ${row.names.length > 1}`;
      const line = this.lines.get(key) ?? this.make(row);
      line.row = row;
      lines.set(key, line);
      this.fill(line, world);
    }
    const elements = [...lines.values()].map((l) => l.element);
    if (elements.length !== this.list.children.length || elements.some((e, i) => this.list.children[i] !== e)) this.list.replaceChildren(...elements);
    this.lines = lines;
  }

  private make(row: SetRow): Line {
    const box = h("input", { type: "checkbox", "data-testid": "drawing-set", "data-set": row.prefix, onchange: () => this.switches.switch(row.prefix, box.checked) });
    const count = h("span", { class: "insp-kind" });
    const element = h("label", { class: row.nested ? "insp-set insp-nested" : "insp-set" }, box, h("span", { class: "insp-name" }, row.label), count);
    return { element, box, count, row };
  }

  private fill({ box, count, row }: Line, world: World): void {
    const on = row.names.filter((n) => this.switches.isOn(n)).length;
    box.checked = on > 0;
    box.indeterminate = on > 0 && on < row.names.length;
    const things = row.names.reduce((n, name) => n + (world.drawings.get(name)?.length ?? 0), 0);
    setText(count, row.names.length > 1 ? `${row.names.length} sets, ${things}` : String(things));
  }
}
