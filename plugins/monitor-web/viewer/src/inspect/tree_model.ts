import type { TreeAnswer } from "./inspectable";
import { childPaths, isWithin, pathsAbove } from "./paths";

export interface TreeNode {
  path: string;
  name: string;
  class: string;
  doc: string;
  depth: number;
  parent: TreeNode | null;
  /// null: not requested yet.
  children: TreeNode[] | null;
  /// False: a leaf.
  inner: boolean;
  open: boolean;
  /// Index among its siblings, from 0.
  index: number;
}

/// The visible rows, in order. `version` is incremented whenever they may have changed.
///
/// Children are requested when their parent is expanded: `wanted` returns the next missing node, `fill` stores an
/// answer. An answer about a known node is merged, so that expanded nodes stay expanded while robots are added and
/// removed. With a filter the tree shows the matches and their ancestors as if all were expanded, and requests unknown
/// nodes one by one, breadth first, up to a limit.
export class TreeModel {
  version = 0;
  /// Path of the row with the keyboard focus.
  focus = "/";
  private readonly root: TreeNode;
  private readonly known = new Map<string, TreeNode>();
  private shown: TreeNode[] = [];
  private shownVersion = -1;
  private words: string[] = [];

  constructor(private readonly searchBound = 20000) {
    this.root = { path: "/", name: "/", class: "", doc: "", depth: 0, parent: null, children: null, inner: true, open: true, index: 0 };
    this.known.set("/", this.root);
  }

  node(path: string): TreeNode | undefined {
    return this.known.get(path);
  }

  get size(): number {
    return this.known.size;
  }

  get rows(): readonly TreeNode[] {
    if (this.shownVersion !== this.version) {
      this.shown = [];
      if (this.words.length > 0) this.collectMatches(this.root);
      else this.collectOpen(this.root);
      this.shownVersion = this.version;
    }
    return this.shown;
  }

  /// If the filter has several words, all must occur in the name or the class.
  set filter(text: string) {
    const words = text.toLowerCase().split(/\s+/).filter((w) => w !== "");
    if (words.join(" ") === this.words.join(" ")) return;
    this.words = words;
    ++this.version;
  }

  get filtering(): boolean {
    return this.words.length > 0;
  }

  matches(node: TreeNode): boolean {
    const text = `${node.name} ${node.class}`.toLowerCase();
    return this.words.every((w) => text.includes(w));
  }

  setOpen(path: string, open: boolean): void {
    const node = this.known.get(path);
    if (!node || !node.inner || node.open === open) return;
    node.open = open;
    ++this.version;
  }

  /// The next node whose children are needed for the visible rows; null: none is missing.
  wanted(): string | null {
    if (this.filtering) return this.known.size < this.searchBound ? this.firstUnknown() : null;
    for (const node of this.rows) if (node.open && node.inner && !node.children) return node.path;
    return null;
  }

  /// Expands the ancestors of a path as far as they are known. Returns the path that must be requested to continue, or
  /// null if the node is known or does not exist.
  reveal(path: string): string | null {
    for (const above of pathsAbove(path)) {
      const node = this.known.get(above);
      if (!node || !node.inner) return null;
      this.setOpen(above, true);
      if (!node.children) return above;
    }
    return null;
  }

  fill(path: string, answer: TreeAnswer): void {
    const node = this.known.get(path);
    if (!node) return;
    this.merge(node, answer);
    ++this.version;
  }

  /// The request failed. It is not repeated before the next fill of an ancestor.
  failed(path: string): void {
    const node = this.known.get(path);
    if (!node || node.children) return;
    node.children = [];
    ++this.version;
  }

  /// The requested node no longer exists.
  remove(path: string): void {
    const node = this.known.get(path);
    if (!node || !node.parent) return;
    node.parent.children = node.parent.children?.filter((c) => c !== node) ?? null;
    this.forget(node);
    ++this.version;
  }

  /// Paths whose children are known. They must be requested again after the tree changed.
  loaded(): string[] {
    return [...this.known.values()].filter((n) => n.children && (n.open || n === this.root)).map((n) => n.path);
  }

  /// Moves the focus, expands or collapses, as in the ARIA tree pattern. Returns true if it handles the key.
  key(key: string): boolean {
    const rows = this.rows;
    if (rows.length === 0) return false;
    const at = Math.max(0, rows.findIndex((r) => r.path === this.focus));
    const row = rows[at]!;
    const isOpen = row.inner && (row.open || (this.filtering && rows[at + 1]?.parent === row));
    if (key === "ArrowDown") this.focusOn(rows[Math.min(at + 1, rows.length - 1)]!);
    else if (key === "ArrowUp") this.focusOn(rows[Math.max(at - 1, 0)]!);
    else if (key === "Home") this.focusOn(rows[0]!);
    else if (key === "End") this.focusOn(rows[rows.length - 1]!);
    else if (key === "ArrowRight" && !isOpen) this.setOpen(row.path, true);
    else if (key === "ArrowRight" && rows[at + 1]?.parent === row) this.focusOn(rows[at + 1]!);
    else if (key === "ArrowLeft" && isOpen && !this.filtering) this.setOpen(row.path, false);
    else if (key === "ArrowLeft" && row.parent) this.focusOn(row.parent);
    else if (key === "*") for (const brother of row.parent?.children ?? [row]) this.setOpen(brother.path, true);
    else return key === "ArrowRight" || key === "ArrowLeft";
    return true;
  }

  private focusOn(node: TreeNode): void {
    this.focus = node.path;
  }

  private collectOpen(node: TreeNode): void {
    this.shown.push(node);
    if (node.open) for (const child of node.children ?? []) this.collectOpen(child);
  }

  private collectMatches(node: TreeNode): boolean {
    const at = this.shown.length;
    this.shown.push(node);
    let any = this.matches(node);
    for (const child of node.children ?? []) any = this.collectMatches(child) || any;
    if (!any) this.shown.length = at;
    return any;
  }

  private firstUnknown(): string | null {
    let level: TreeNode[] = [this.root];
    while (level.length > 0) {
      const next: TreeNode[] = [];
      for (const node of level) {
        if (node.inner && !node.children) return node.path;
        next.push(...(node.children ?? []));
      }
      level = next;
    }
    return null;
  }

  private merge(node: TreeNode, answer: TreeAnswer): void {
    node.class = answer.class;
    node.doc = answer.doc;
    node.inner = answer.children !== undefined;
    if (!node.inner) return this.replaceChildren(node, null);
    if (answer.more !== undefined && answer.more > 0) return;  // the answer omits the children
    const names = answer.children!.map((c) => c.name);
    const children = childPaths(node.path, names).map((path, index) => this.child(node, path, answer.children![index]!, index));
    this.replaceChildren(node, children);
  }

  private child(parent: TreeNode, path: string, answer: TreeAnswer, index: number): TreeNode {
    let node = this.known.get(path);
    if (node && node.class !== answer.class) {
      this.forget(node);
      node = undefined;
    }
    node ??= { path, name: answer.name, class: "", doc: "", depth: parent.depth + 1, parent, children: null, inner: false, open: false, index };
    node.index = index;
    node.name = path.slice(parent.path === "/" ? 1 : parent.path.length + 1);
    this.known.set(path, node);
    this.merge(node, answer);
    return node;
  }

  private replaceChildren(node: TreeNode, children: TreeNode[] | null): void {
    for (const old of node.children ?? []) if (!children?.includes(old)) this.forget(old);
    node.children = children;
  }

  private forget(node: TreeNode): void {
    if (this.known.get(node.path) === node) this.known.delete(node.path);
    if (isWithin(this.focus, node.path)) this.focus = node.parent?.path ?? "/";
    for (const child of node.children ?? []) this.forget(child);
  }
}
