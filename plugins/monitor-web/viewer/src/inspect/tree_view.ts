import { h, setAttribute, setHidden, setText } from "../ui/dom";
import type { Inspectable } from "./inspectable";
import { TreeLoader } from "./tree_loader";
import { TreeModel, type TreeNode } from "./tree_model";

const kMostRows = 600;

interface Row {
  element: HTMLDivElement;
  name: HTMLSpanElement;
  kind: HTMLSpanElement;
}

/// The object tree: a filter above, rows below. Rows are reused by path, and only changes are written to the page.
export class TreeView {
  readonly element: HTMLElement;
  private readonly filter = h("input", {
    type: "search", class: "insp-filter", placeholder: "Filter by name or class", "aria-label": "Filter the tree", "data-testid": "inspector-filter", oninput: () => this.search(),
  });
  private readonly tree = h("div", {
    role: "tree", class: "insp-tree", "aria-label": "Objects", "data-testid": "inspector-tree",
    onclick: (event: MouseEvent) => this.click(event), onkeydown: (event: KeyboardEvent) => this.keydown(event), ondblclick: (event: MouseEvent) => this.toggle(this.pathOf(event)),
  });
  private readonly note = h("p", { class: "insp-note", role: "status", "data-testid": "tree-note" });
  private readonly rows = new Map<string, Row>();
  private model = new TreeModel();
  private loader: TreeLoader | null = null;
  private drawn = "";
  private selected: string | null = null;
  /// The node to select first; null once that is done.
  private opened: string | null = null;
  /// Path of the row to scroll into view as soon as it exists.
  private sought: string | null = null;

  /// `titled`: the display name of a node, if it has one.
  constructor(private readonly chosen: (path: string) => void, private readonly titled: (path: string) => string) {
    const again = h("button", { type: "button", class: "insp-icon", title: "Ask the host again", "aria-label": "Refresh the tree", onclick: () => this.loader?.refresh() }, "↻");
    this.element = h("section", { class: "insp-objects" }, h("div", { class: "insp-bar" }, this.filter, again), this.tree, this.note);
  }

  setSource(source: Inspectable | null): void {
    this.loader?.close();
    this.model = new TreeModel();
    this.model.filter = this.filter.value;
    this.loader = source && new TreeLoader(source, this.model);
    this.selected = null;
    this.drawn = "";
    this.sought = null;
    if (!source) return;
    this.loader!.reveal(source.first);
    this.model.focus = source.first;
    this.opened = source.first;
  }

  /// Selects this row and expands its ancestors.
  select(path: string | null): void {
    if (path === this.selected) return;
    this.selected = path;
    this.drawn = "";
    if (path === null) return;
    this.sought = path;
    this.loader?.reveal(path);
  }

  refresh(): void {
    this.loader?.refresh();
  }

  /// Updates the page. Call it while the view is visible.
  update(): void {
    this.loader?.pump();
    this.openFirst();
    const wanted = `${this.model.version} ${this.model.focus} ${this.loader?.error}`;
    if (wanted === this.drawn) return;
    this.drawn = wanted;
    this.draw(this.model.rows);
    this.seek();
  }

  private openFirst(): void {
    if (this.opened === null || !this.model.node(this.opened)) return;
    this.model.setOpen(this.opened, true);
    this.opened = null;
    this.loader?.pump();
  }

  private seek(): void {
    const row = this.sought !== null ? this.rows.get(this.sought) : undefined;
    if (!row) return;
    this.model.focus = this.sought!;
    this.sought = null;
    row.element.scrollIntoView({ block: "nearest" });
    this.drawRows(this.model.rows);
  }

  private draw(rows: readonly TreeNode[]): void {
    this.drawRows(rows);
    const hidden = rows.length - kMostRows;
    const searched = this.model.filtering ? `${rows.filter((r) => this.model.matches(r)).length} found among ${this.model.size} nodes${this.model.wanted() ? ", still looking…" : "."}` : "";
    const text = this.loader?.error || (hidden > 0 ? `${hidden} more rows: filter, or close some. ${searched}` : searched);
    setText(this.note, text);
    setHidden(this.note, text === "");
  }

  private drawRows(all: readonly TreeNode[]): void {
    const rows = all.slice(0, kMostRows);
    const focus = rows.some((r) => r.path === this.model.focus) ? this.model.focus : rows[0]?.path;
    const kept = new Set(rows.map((r) => r.path));
    for (const [path, row] of this.rows) {
      if (kept.has(path)) continue;
      row.element.remove();
      this.rows.delete(path);
    }
    let at: Element | null = this.tree.firstElementChild;
    rows.forEach((node, i) => {
      const row = this.rows.get(node.path) ?? this.make(node);
      if (row.element === at) at = at.nextElementSibling;
      else this.tree.insertBefore(row.element, at);
      this.fill(row, node, node.path === focus, rows[i + 1]?.parent === node);
    });
  }

  private make(node: TreeNode): Row {
    const name = h("span", { class: "insp-name" });
    const kind = h("span", { class: "insp-kind" });
    const element = h("div", { role: "treeitem", class: "insp-row", "data-testid": "tree-item", "data-path": node.path }, h("span", { class: "insp-twist", "aria-hidden": "true" }), name, kind);
    element.style.setProperty("--depth", String(node.depth));
    const row = { element, name, kind };
    this.rows.set(node.path, row);
    return row;
  }

  private fill(row: Row, node: TreeNode, focused: boolean, showsChildren: boolean): void {
    const { element } = row;
    setText(row.name, node.name);
    setText(row.kind, this.titled(node.path) || (node.class === node.name.replace(/\[\d+\]$/, "") ? "" : node.class));
    setAttribute(element, "title", node.doc ? `${node.class}: ${node.doc}` : node.class);
    setAttribute(element, "aria-level", String(node.depth + 1));
    setAttribute(element, "aria-posinset", String(node.index + 1));
    setAttribute(element, "aria-setsize", String(node.parent?.children?.length ?? 1));
    setAttribute(element, "aria-expanded", node.inner ? String(this.model.filtering ? showsChildren : node.open) : null);
    setAttribute(element, "aria-selected", String(node.path === this.selected));
    setAttribute(element, "tabindex", focused ? "0" : "-1");
  }

  private pathOf(event: Event): string | null {
    return (event.target as Element).closest<HTMLElement>("[data-path]")?.dataset.path ?? null;
  }

  private toggle(path: string | null): void {
    const node = path === null ? undefined : this.model.node(path);
    if (node) this.model.setOpen(node.path, !node.open);
    this.update();
  }

  private click(event: MouseEvent): void {
    const path = this.pathOf(event);
    if (path === null) return;
    this.model.focus = path;
    if ((event.target as Element).classList.contains("insp-twist")) this.toggle(path);
    else this.chosen(path);
    this.update();
    this.rows.get(path)?.element.focus({ preventScroll: true });
  }

  private keydown(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const choose = event.key === "Enter" || event.key === " ";
    if (choose) this.chosen(this.model.focus);
    else if (!this.model.key(event.key)) return;
    event.preventDefault();
    event.stopPropagation();
    this.update();
    const row = this.rows.get(this.model.focus);
    row?.element.focus({ preventScroll: true });
    row?.element.scrollIntoView({ block: "nearest" });
  }

  private search(): void {
    this.model.filter = this.filter.value;
    if (!this.model.filtering && this.selected !== null) this.sought = this.selected;
    this.update();
  }
}
