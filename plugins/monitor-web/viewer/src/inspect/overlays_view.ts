import { h, setHidden, setText } from "../ui/dom";
import type { Listing, Overlay } from "./overlays/overlay";
import { SeenOverlay } from "./overlays/percepts";

/// A table whose cells are updated in place.
class Table {
  readonly element = h("table", { class: "insp-table" });
  private readonly head = this.element.createTHead();
  private readonly body = this.element.createTBody();

  show(listing: Listing | null): void {
    setHidden(this.element, !listing || listing.rows.length === 0);
    if (!listing) return;
    fillRows(this.head, [listing.head], "th");
    fillRows(this.body, listing.rows, "td");
  }
}

function fillRows(section: HTMLTableSectionElement, rows: readonly string[][], cell: "th" | "td"): void {
  while (section.rows.length > rows.length) section.deleteRow(-1);
  rows.forEach((cells, r) => {
    const row = section.rows[r] ?? section.insertRow();
    while (row.cells.length > cells.length) row.deleteCell(-1);
    while (row.cells.length < cells.length) row.append(document.createElement(cell));
    cells.forEach((text, c) => setText(row.cells[c]!, text));
  });
}

/// A switch, and the note and table of the overlay, which are shown below all switches while it is on.
class OverlayItem {
  readonly label: HTMLElement;
  readonly details: HTMLElement;
  private readonly box = h("input", { type: "checkbox", "data-testid": "overlay-switch", onchange: () => this.switched(this.overlay, this.box.checked) });
  private readonly note = h("p", { class: "insp-note" });
  private readonly table = new Table();
  private readonly text = h("pre", { class: "insp-told" });
  private readonly told = h("details", { hidden: true }, h("summary", {}, "What it was told"), this.text);
  private version = -1;

  constructor(readonly overlay: Overlay, private readonly switched: (overlay: Overlay, on: boolean) => void) {
    this.box.dataset.overlay = overlay.id;
    const key = h("kbd", {}, overlay.key.replace("shift+", "⇧").replace(/[a-z]$/, (c) => c.toUpperCase()));
    this.label = h("label", { class: "insp-switch", title: overlay.doc }, this.box, h("span", {}, overlay.title), key);
    const below = h("div", { class: "insp-below" }, this.note, this.table.element, this.told);
    this.details = h("section", { class: "insp-overlay", "data-testid": "overlay-list", "data-overlay": overlay.id, hidden: true }, h("h3", {}, overlay.title), h("p", { class: "insp-doc" }, overlay.doc), below);
  }

  /// `missing`: unavailable for recordings.
  update(missing: boolean): void {
    this.box.checked = this.overlay.on && !missing;
    this.box.disabled = missing;
    setHidden(this.details, !this.overlay.on || missing);
    if (this.version === this.overlay.version) return;
    this.version = this.overlay.version;
    setText(this.note, this.overlay.note);
    setHidden(this.note, this.overlay.note === "");
    this.table.show(this.overlay.listing);
    if (!(this.overlay instanceof SeenOverlay)) return;
    setHidden(this.told, this.overlay.told === "");
    if (this.told.open) setText(this.text, this.overlay.told);
  }
}

/// The switches of all overlays.
export class OverlaysView {
  readonly element: HTMLElement;
  private readonly items: OverlayItem[];
  private readonly missing = h("p", { class: "insp-note", hidden: true, "data-testid": "overlays-missing" },
    "A recording holds what monitors are told: bodies and the state of the game, but no contacts, joints, perceptors or percepts. Those can be seen while a match runs.");

  constructor(overlays: readonly Overlay[], switched: (overlay: Overlay, on: boolean) => void) {
    this.items = overlays.map((o) => new OverlayItem(o, switched));
    this.element = h("section", { class: "insp-overlays", "aria-label": "Overlays" }, ...this.items.map((i) => i.label), this.missing, ...this.items.map((i) => i.details));
  }

  update(replay: boolean): void {
    setHidden(this.missing, !replay);
    for (const item of this.items) item.update(replay && item.overlay.missing !== null);
  }
}
